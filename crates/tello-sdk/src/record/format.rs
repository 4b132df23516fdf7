//! One record: encoding and reading.

use super::crc32::crc32;
use alloc::vec::Vec;
use core::time::Duration;

/// What a record holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Channel {
    /// A command datagram sent to the drone.
    Sent,
    /// A datagram received on the command socket.
    Reply,
    /// A datagram received on the state socket.
    State,
    /// A datagram received on the video socket.
    Video,
    /// A request of the user, as wire text.
    Request,
    /// A stick set-point of the user, as wire text.
    Sticks,
    /// The sticks were released.
    ReleaseSticks,
}

impl Channel {
    const ALL: [Self; 7] = [
        Self::Sent,
        Self::Reply,
        Self::State,
        Self::Video,
        Self::Request,
        Self::Sticks,
        Self::ReleaseSticks,
    ];
}

/// One record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record<'a> {
    /// Since the session's start.
    pub at: Duration,
    /// What it is.
    pub channel: Channel,
    /// Its bytes.
    pub bytes: &'a [u8],
}

const MAGIC: u8 = 0xA5;
const HEADER: usize = 14;
/// A datagram has at most this many bytes.
const LONGEST: usize = 65_535;

/// Appends a record to a buffer; bytes beyond 65,535 are cut (no datagram has them).
pub fn encode(record: &Record<'_>, buffer: &mut Vec<u8>) {
    let bytes = record.bytes.get(..LONGEST).unwrap_or(record.bytes);
    let mut header = [0_u8; HEADER];
    header[0] = MAGIC;
    header[1] = record.channel as u8;
    header[2..6].copy_from_slice(&(bytes.len() as u32).to_le_bytes());
    let nanos = u64::try_from(record.at.as_nanos()).unwrap_or(u64::MAX);
    header[6..].copy_from_slice(&nanos.to_le_bytes());
    buffer.extend_from_slice(&header);
    buffer.extend_from_slice(bytes);
    buffer.extend_from_slice(&crc32(&[&header, bytes]).to_le_bytes());
}

/// The records of a byte stream, up to the first that is torn or damaged.
#[derive(Debug, Clone)]
pub struct Records<'a> {
    rest: &'a [u8],
}

impl<'a> Records<'a> {
    /// Reads from the front.
    #[must_use]
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// Bytes behind the last whole record: zero unless the tail is torn.
    #[must_use]
    pub fn torn_bytes(&self) -> usize {
        self.rest.len()
    }
}

impl<'a> Iterator for Records<'a> {
    type Item = Record<'a>;

    fn next(&mut self) -> Option<Record<'a>> {
        let (header, rest) = self.rest.split_at_checked(HEADER)?;
        let [magic, channel, l0, l1, l2, l3, time @ ..] = header else {
            return None;
        };
        let length = u32::from_le_bytes([*l0, *l1, *l2, *l3]) as usize;
        if *magic != MAGIC || length > LONGEST {
            return None;
        }
        let channel = *Channel::ALL.get(usize::from(*channel))?;
        let (bytes, rest) = rest.split_at_checked(length)?;
        let (sum, rest) = rest.split_at_checked(4)?;
        if sum != crc32(&[header, bytes]).to_le_bytes() {
            return None;
        }
        self.rest = rest;
        let nanos = u64::from_le_bytes(time.try_into().ok()?);
        Some(Record {
            at: Duration::from_nanos(nanos),
            channel,
            bytes,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn two() -> Vec<u8> {
        let mut buffer = Vec::new();
        let at = Duration::from_millis(1500);
        encode(
            &Record {
                at,
                channel: Channel::Sent,
                bytes: b"takeoff",
            },
            &mut buffer,
        );
        encode(
            &Record {
                at,
                channel: Channel::Video,
                bytes: &[],
            },
            &mut buffer,
        );
        buffer
    }

    #[test]
    fn a_torn_tail_is_left_out_at_every_length() {
        let whole = two();
        let first = HEADER + 7 + 4;
        for length in 0..=whole.len() {
            let mut records = Records::new(&whole[..length]);
            let count = records.by_ref().count();
            let expected = usize::from(length >= first) + usize::from(length == whole.len());
            assert_eq!(count, expected, "{length}");
        }
        let mut records = Records::new(&whole);
        assert_eq!(records.next().unwrap().bytes, b"takeoff");
        records.next();
        assert_eq!(records.torn_bytes(), 0);
    }

    #[test]
    fn a_flipped_bit_ends_the_reading() {
        for bit in 0..two().len() * 8 {
            let mut bytes = two();
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(Records::new(&bytes).count() < 2, "bit {bit}");
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_read(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
            let mut prefixed = two();
            prefixed.extend(&bytes);
            prop_assert!(Records::new(&prefixed).count() >= 2);
            let _ = Records::new(&bytes).count();
        }
    }
}
