//! How the drone cuts an access unit: parameter sets alone, the picture in pieces of 1460 bytes.

use super::annex_b::{NalKind, leading_header, start_code};

/// Bytes of a full datagram; a shorter one ends an access unit.
pub const PAYLOAD: usize = 1460;

/// Cuts an access unit as the drone does: each leading parameter set in a datagram of its own, the rest in pieces of
/// [`PAYLOAD`] bytes, the last one shorter unless the length is an exact multiple.
pub fn datagrams(unit: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = unit;
    core::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let length = parameter_set_length(rest)
            .unwrap_or(PAYLOAD)
            .min(rest.len())
            .min(PAYLOAD);
        let (piece, after) = rest.split_at(length);
        rest = after;
        Some(piece)
    })
}

/// Whether a datagram begins with a sequence or picture parameter set.
pub(crate) fn begins_with_parameter_set(datagram: &[u8]) -> bool {
    let kind = leading_header(datagram).and_then(NalKind::from_header);
    matches!(kind, Some(NalKind::Sps | NalKind::Pps))
}

fn parameter_set_length(bytes: &[u8]) -> Option<usize> {
    if !begins_with_parameter_set(bytes) {
        return None;
    }
    let (_, after) = start_code(bytes)?;
    let (next, _) = start_code(bytes.get(after..)?)?;
    Some(after + next)
}
