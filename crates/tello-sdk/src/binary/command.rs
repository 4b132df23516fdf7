//! What can be asked for in the binary protocol, and what a session says about it.

use super::message::Message;
use crate::safety::Alarm;
use alloc::vec::Vec;
use core::time::Duration;

/// A command with an acknowledgement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BinaryCommand {
    /// Take off.
    TakeOff,
    /// Land; repeated until confirmed.
    Land,
    /// Take off when thrown.
    ThrowAndGo,
    /// Land on a palm.
    PalmLand,
    /// Flip: 0 forward, 1 left, 2 back, 3 right, 4 to 7 diagonally.
    Flip(u8),
    /// Bit rate of the video: 0 automatic, 1 to 5.
    EncoderRate(u8),
}

impl BinaryCommand {
    /// Message, type byte and content.
    pub(super) fn frame(self) -> (Message, u8, Vec<u8>) {
        match self {
            Self::TakeOff => (Message::TakeOff, 0x68, Vec::new()),
            Self::Land => (Message::Land, 0x68, [0].into()),
            Self::ThrowAndGo => (Message::ThrowAndGo, 0x48, [0].into()),
            Self::PalmLand => (Message::PalmLand, 0x68, [0].into()),
            Self::Flip(direction) => (Message::Flip, 0x70, [direction.min(7)].into()),
            Self::EncoderRate(rate) => (Message::EncoderRate, 0x68, [rate.min(5)].into()),
        }
    }
}

/// Names a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CommandId(pub(super) u64);

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ending {
    /// The drone acknowledged it (it may still refuse to carry it out: look at the telemetry).
    Acknowledged,
    /// The flight data confirm it (land).
    Confirmed,
    /// No acknowledgement came; it was not sent again.
    Unknown,
}

/// Something to know.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum BinaryEvent {
    /// The handshake is done.
    Connected,
    /// Nothing was heard for the link timeout; the handshake begins anew.
    Disconnected,
    /// A command ended.
    Finished {
        /// Which.
        id: CommandId,
        /// The command.
        command: BinaryCommand,
        /// How.
        ending: Ending,
    },
    /// [`BinarySession::telemetry`](super::BinarySession::telemetry) has new values.
    Telemetry,
    /// The sticks were centred by the watchdog.
    SticksCentered,
    /// The session lands by itself.
    Alarm(Alarm),
}

/// What the caller has to do.
#[derive(Debug, Clone, PartialEq)]
pub enum BinaryOutput {
    /// Send to the drone's command port.
    Send(Vec<u8>),
    /// Something to know.
    Event(BinaryEvent),
    /// Nothing until this time or the next datagram.
    WaitUntil(Duration),
}
