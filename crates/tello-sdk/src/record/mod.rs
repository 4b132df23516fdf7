//! Recording: every datagram in both directions and every request, with its time, in one crash-safe byte stream.
//!
//! Each record: magic byte 0xA5, channel (u8), length (u32), nanoseconds since the session's start (u64), the bytes,
//! and a CRC-32 (IEEE 802.3) of everything before it; all little-endian. A torn tail is recognised and left out.

mod crc32;
mod format;
mod replay;

pub use format::{Channel, Record, Records, encode};
pub use replay::{Replay, replay};
