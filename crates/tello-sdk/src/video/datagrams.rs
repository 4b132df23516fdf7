//! How the drone cuts an access unit: parameter sets alone, the picture in pieces of 1460 bytes.

use super::annex_b::{NalKind, leading_header, start_code};
use alloc::vec::Vec;

/// Bytes of a full datagram; a shorter one ends an access unit.
pub const PAYLOAD: usize = 1460;

/// Cuts an access unit as the drone does: each leading parameter set in a datagram of its own, the rest in pieces of
/// [`PAYLOAD`] bytes, the last one shorter unless the length is an exact multiple.
pub fn datagrams(unit: &[u8]) -> impl Iterator<Item = &[u8]> {
    pieces(unit, PAYLOAD)
}

fn pieces(unit: &[u8], longest: usize) -> impl Iterator<Item = &[u8]> {
    let mut rest = unit;
    core::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let length = parameter_set_length(rest)
            .unwrap_or(longest)
            .min(rest.len())
            .min(longest);
        let (piece, after) = rest.split_at(length);
        rest = after;
        Some(piece)
    })
}

/// Cuts an access unit as the drone does in the binary protocol: two bytes of header, the frame's number and the
/// datagram's with 0x80 on the last, then as many bytes as fill [`PAYLOAD`]; each leading parameter set in a datagram of
/// its own. A unit of more than 128 datagrams cannot be numbered and gives none.
pub fn numbered_datagrams(unit: &[u8], frame: u8) -> impl Iterator<Item = Vec<u8>> {
    let pieces = || pieces(unit, PAYLOAD - 2);
    let count = pieces().count();
    let numbered = (0_u8..).zip(pieces()).map(move |(number, piece)| {
        let last = if usize::from(number) + 1 == count {
            0x80
        } else {
            0
        };
        [&[frame, number | last], piece].concat()
    });
    numbered.take(if count > 128 { 0 } else { count })
}

/// Whether a datagram begins with a sequence or picture parameter set.
pub(crate) fn is_parameter_set(datagram: &[u8]) -> bool {
    let kind = leading_header(datagram).and_then(NalKind::from_header);
    matches!(kind, Some(NalKind::Sps | NalKind::Pps))
}

fn parameter_set_length(bytes: &[u8]) -> Option<usize> {
    if !is_parameter_set(bytes) {
        return None;
    }
    let (_, after) = start_code(bytes)?;
    let (next, _) = start_code(bytes.get(after..)?)?;
    Some(after + next)
}
