//! One frame: 0xCC, length times 8, CRC-8, type, message, sequence, payload, CRC-16; all little-endian.

use super::checksum::{crc8, crc16};
use alloc::vec::Vec;

/// A frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// The type byte: 0x48 asks, 0x50 answers or sends data, 0x60 needs no answer, 0x68 and 0x70 command.
    pub kind: u8,
    /// The message's number, see [`Message`](super::Message).
    pub message: u16,
    /// Chosen by the sender and echoed in the acknowledgement.
    pub sequence: u16,
    /// The content.
    pub payload: &'a [u8],
}

/// Why bytes are not a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameError {
    /// Fewer than 11 bytes.
    #[error("{length} bytes are too few for a frame: 11 are needed")]
    Short {
        /// Bytes given.
        length: usize,
    },
    /// The first byte is not 0xCC.
    #[error("the first byte is {first:#04x}, not 0xCC")]
    Start {
        /// The first byte.
        first: u8,
    },
    /// The length in the header is not that of the datagram.
    #[error("the header says {said} bytes, the datagram has {length}")]
    Length {
        /// Said by the header.
        said: usize,
        /// Bytes given.
        length: usize,
    },
    /// A checksum is wrong.
    #[error("the checksum of the {part} is wrong")]
    Checksum {
        /// "header" or "frame".
        part: &'static str,
    },
}

/// Bytes of a frame without payload.
const EMPTY: usize = 11;
/// The length field has 13 bits.
const LONGEST: usize = 8191;

impl<'a> Frame<'a> {
    /// Reads a datagram that is one frame.
    ///
    /// # Errors
    /// Too short, another protocol, a wrong length or a wrong checksum.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, FrameError> {
        let length = bytes.len();
        let [start, l0, l1, header_sum, kind, m0, m1, s0, s1, rest @ ..] = bytes else {
            return Err(FrameError::Short { length });
        };
        if *start != 0xCC {
            return Err(FrameError::Start { first: *start });
        }
        let said = usize::from(u16::from_le_bytes([*l0, *l1]) >> 3);
        let Some((payload, sum)) = rest.split_last_chunk::<2>() else {
            return Err(FrameError::Short { length });
        };
        if said != length {
            return Err(FrameError::Length { said, length });
        }
        if crc8(&[*start, *l0, *l1]) != *header_sum {
            return Err(FrameError::Checksum { part: "header" });
        }
        if crc16(bytes.split_at(length - 2).0) != u16::from_le_bytes(*sum) {
            return Err(FrameError::Checksum { part: "frame" });
        }
        let message = u16::from_le_bytes([*m0, *m1]);
        let sequence = u16::from_le_bytes([*s0, *s1]);
        Ok(Self {
            kind: *kind,
            message,
            sequence,
            payload,
        })
    }

    /// Writes the frame; a payload beyond 8180 bytes is cut (no datagram is that long).
    #[must_use]
    pub fn encode(&self) -> Vec<u8> {
        let payload = self.payload.get(..LONGEST - EMPTY).unwrap_or(self.payload);
        let length = (payload.len() + EMPTY) as u16;
        let [l0, l1] = (length << 3).to_le_bytes();
        let mut bytes = Vec::with_capacity(payload.len() + EMPTY);
        bytes.extend_from_slice(&[0xCC, l0, l1, crc8(&[0xCC, l0, l1]), self.kind]);
        bytes.extend_from_slice(&self.message.to_le_bytes());
        bytes.extend_from_slice(&self.sequence.to_le_bytes());
        bytes.extend_from_slice(payload);
        let sum = crc16(&bytes);
        bytes.extend_from_slice(&sum.to_le_bytes());
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_published_take_off_frame() {
        // The take-off command as published in several places: sequence 0x01e4.
        let frame = Frame {
            kind: 0x68,
            message: 0x54,
            sequence: 0x01e4,
            payload: &[],
        };
        assert_eq!(
            frame.encode(),
            [
                0xcc, 0x58, 0x00, 0x7c, 0x68, 0x54, 0x00, 0xe4, 0x01, 0xc2, 0x16
            ]
        );
    }

    #[test]
    fn frames_above_255_bytes_keep_their_length() {
        let payload = [7; 1000];
        let frame = Frame {
            kind: 0x50,
            message: 0x1051,
            sequence: 0,
            payload: &payload,
        };
        let bytes = frame.encode();
        assert_eq!(Frame::parse(&bytes), Ok(frame));
    }

    #[test]
    fn every_flipped_bit_is_noticed() {
        let bytes = Frame {
            kind: 0x50,
            message: 0x56,
            sequence: 9,
            payload: b"abc",
        }
        .encode();
        for bit in 0..bytes.len() * 8 {
            let mut wrong = bytes.clone();
            wrong[bit / 8] ^= 1 << (bit % 8);
            assert!(Frame::parse(&wrong).is_err(), "bit {bit}");
        }
    }

    proptest! {
        #[test]
        fn what_is_written_is_read(kind: u8, message: u16, sequence: u16, payload in proptest::collection::vec(any::<u8>(), 0..600)) {
            let frame = Frame { kind, message, sequence, payload: &payload };
            let bytes = frame.encode();
            prop_assert_eq!(Frame::parse(&bytes), Ok(frame));
        }

        #[test]
        fn any_bytes_are_taken(bytes in proptest::collection::vec(any::<u8>(), 0..80)) {
            let _ = Frame::parse(&bytes);
        }
    }
}
