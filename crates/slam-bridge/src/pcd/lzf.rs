//! LZF decompression: literal runs and back references, nothing else.
//!
//! ```text
//! 000LLLLL                     copy the next L + 1 bytes
//! LLLooooo oooooooo            copy L + 2 bytes from o + 1 bytes back (L = 1..6)
//! 111ooooo LLLLLLLL oooooooo   the same with L = 7 + the second byte
//! ```

/// Longest output of one input byte, bounds what a header may promise: 3 bytes give 264 at most.
pub(super) const MAX_EXPANSION: u64 = 88;

/// Unpacks to exactly `size` bytes; `None` when the data say otherwise.
pub(super) fn decompress(packed: &[u8], size: usize) -> Option<Vec<u8>> {
    let mut unpacked = Vec::with_capacity(size.min(packed.len() * MAX_EXPANSION as usize));
    let mut input = packed.iter().copied();
    while let Some(control) = input.next() {
        if control < 0x20 {
            let literal = usize::from(control) + 1;
            let before = unpacked.len();
            unpacked.extend(input.by_ref().take(literal));
            if unpacked.len() != before + literal {
                return None;
            }
        } else {
            let mut length = usize::from(control >> 5) + 2;
            if length == 9 {
                length += usize::from(input.next()?);
            }
            let back = (usize::from(control & 0x1f) << 8) + usize::from(input.next()?) + 1;
            let from = unpacked.len().checked_sub(back)?;
            for index in from..from + length {
                let byte = *unpacked.get(index)?;
                unpacked.push(byte);
            }
        }
        if unpacked.len() > size {
            return None;
        }
    }
    (unpacked.len() == size).then_some(unpacked)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_references() {
        // "abc", then 9 bytes from 3 back, then 12 bytes from 1 back.
        let packed = [2, b'a', b'b', b'c', 0xe0, 0, 2, 0xe0, 3, 0];
        let text = decompress(&packed, 24).expect("good data");
        assert_eq!(text, b"abcabcabcabccccccccccccc"[..24].to_vec());
    }

    #[test]
    fn damage_is_noticed() {
        assert_eq!(decompress(&[5, b'a'], 6), None);
        assert_eq!(decompress(&[0x20, 9], 3), None);
        assert_eq!(decompress(&[0, b'a'], 2), None);
        assert_eq!(decompress(&[0, b'a', 0, b'b'], 1), None);
    }
}
