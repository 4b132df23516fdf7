//! Annex B byte stream: NAL units between start codes (ITU-T H.264, Annex B).

/// What a NAL unit holds (ITU-T H.264, table 7-1), as far as assembly needs to know.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NalKind {
    /// A slice of a picture that needs earlier ones (type 1).
    Slice,
    /// A slice of a picture that needs none (type 5).
    IdrSlice,
    /// Sequence parameter set (type 7).
    Sps,
    /// Picture parameter set (type 8).
    Pps,
    /// Anything else.
    Other(u8),
}

impl NalKind {
    /// From the first byte after the start code; `None` if its forbidden bit is set.
    #[must_use]
    pub fn from_header(header: u8) -> Option<Self> {
        if header & 0x80 != 0 {
            return None;
        }
        Some(match header & 0x1F {
            1 => Self::Slice,
            5 => Self::IdrSlice,
            7 => Self::Sps,
            8 => Self::Pps,
            other => Self::Other(other),
        })
    }

    /// Whether it holds part of a picture.
    #[must_use]
    pub fn is_picture(self) -> bool {
        matches!(self, Self::Slice | Self::IdrSlice)
    }
}

/// The NAL units of a byte stream, each without its start code. Bytes before the first start code are skipped.
#[must_use]
pub fn nal_units(stream: &[u8]) -> NalUnits<'_> {
    let rest = start_code(stream).map(|(_, end)| stream.get(end..).unwrap_or_default());
    NalUnits { rest }
}

/// Iterator of [`nal_units`].
#[derive(Debug, Clone)]
pub struct NalUnits<'a> {
    rest: Option<&'a [u8]>,
}

impl<'a> Iterator for NalUnits<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        let (unit, next) = match start_code(rest) {
            Some((begin, end)) => (rest.get(..begin)?, rest.get(end..)),
            None => (rest, None),
        };
        self.rest = next;
        if unit.is_empty() {
            self.next_after_empty()
        } else {
            Some(unit)
        }
    }
}

impl<'a> NalUnits<'a> {
    /// Two start codes in a row: goes on without recursion.
    fn next_after_empty(&mut self) -> Option<&'a [u8]> {
        loop {
            let rest = self.rest?;
            let (unit, next) = match start_code(rest) {
                Some((begin, end)) => (rest.get(..begin)?, rest.get(end..)),
                None => (rest, None),
            };
            self.rest = next;
            if !unit.is_empty() {
                return Some(unit);
            }
        }
    }
}

/// The first start code (three or four bytes): where it begins and where it ends.
pub(crate) fn start_code(bytes: &[u8]) -> Option<(usize, usize)> {
    let at = bytes.windows(3).position(|three| three == [0, 0, 1])?;
    let begin = if at > 0 && bytes.get(at - 1) == Some(&0) {
        at - 1
    } else {
        at
    };
    Some((begin, at + 3))
}

/// Whether the bytes begin with a start code; gives the header byte after it.
pub(crate) fn leading_header(bytes: &[u8]) -> Option<u8> {
    match bytes {
        [0, 0, 0, 1, header, ..] | [0, 0, 1, header, ..] => Some(*header),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    #[test]
    fn both_start_codes_and_empty_units() {
        let stream = [
            9, 0, 0, 0, 1, 0x67, 1, 0, 0, 1, 0, 0, 1, 0x68, 2, 0, 0, 0, 1, 0x65, 3,
        ];
        let units: Vec<_> = nal_units(&stream).collect();
        assert_eq!(units, [&[0x67, 1][..], &[0x68, 2], &[0x65, 3]]);
        assert_eq!(nal_units(&[1, 2, 3]).count(), 0);
        assert_eq!(nal_units(&[]).count(), 0);
    }

    proptest! {
        #[test]
        fn any_bytes_are_split(bytes in proptest::collection::vec(0..3u8, 0..200)) {
            let total: usize = nal_units(&bytes).map(<[u8]>::len).sum();
            prop_assert!(total <= bytes.len());
        }
    }
}
