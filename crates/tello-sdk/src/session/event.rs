//! What goes into a session and what comes out of it.

use crate::command::{Command, SdkVersion};
use crate::reply::{Refusal, Reply};
use crate::safety::Alarm;

use alloc::vec::Vec;
use core::time::Duration;

/// Names a request; never reused within a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RequestId(pub(super) u64);

/// Where a datagram came from, as the driver saw it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Origin {
    /// The drone's address and the expected port.
    Drone,
    /// The drone's address, another port.
    OtherPort,
    /// Another address.
    Stranger,
}

/// Something that happened outside. Times are since the session's start and must not go back (a time that does is
/// taken as the latest one seen).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input<'a> {
    /// Time has passed.
    Tick(Duration),
    /// A datagram on the command socket.
    Reply {
        /// When.
        at: Duration,
        /// From where.
        origin: Origin,
        /// Its bytes.
        bytes: &'a [u8],
    },
    /// A datagram on the state socket.
    State {
        /// When.
        at: Duration,
        /// From where.
        origin: Origin,
        /// Its bytes.
        bytes: &'a [u8],
    },
}

/// What the caller has to do next.
#[derive(Debug, Clone, PartialEq)]
pub enum Output {
    /// Send these bytes to the drone's command port.
    Send(Vec<u8>),
    /// Something to know.
    Event(Event),
    /// Nothing more until this time or the next datagram.
    WaitUntil(Duration),
}

/// Something to know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// A request has ended.
    Finished {
        /// Which.
        id: RequestId,
        /// Its command.
        command: Command,
        /// How it ended.
        outcome: Outcome,
    },
    /// A state line was read: [`Session::telemetry`](crate::Session::telemetry) has new values.
    Telemetry,
    /// A reply that belongs to no waiting command: late, doubled, or ambiguous.
    Stale(Reply),
    /// The drone said `forced stop` by itself.
    ForcedStop,
    /// No set-point came in time: the sticks were centred.
    SticksCentered,
    /// Nothing was heard from the drone for the link timeout.
    LinkLost,
    /// The drone is heard again.
    LinkRestored,
    /// The session lands by itself.
    Alarm(Alarm),
}

/// How a request ended.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Outcome {
    /// The drone answered; for a query the reply holds the value.
    Answered(Reply),
    /// The drone refused.
    Refused {
        /// Why.
        refusal: Refusal,
        /// The reply.
        reply: Reply,
    },
    /// The telemetry confirms it (land, stop, emergency).
    Confirmed,
    /// No reply came that can be attributed. The command may have been carried out: it was not sent again unless it is
    /// a query or a setting.
    Unknown {
        /// What the telemetry says about it.
        verdict: Verdict,
        /// How often it was sent.
        attempts: u32,
    },
    /// It was never sent: something more urgent came, or the link was down.
    NotSent,
}

impl Outcome {
    /// Whether it was carried out, as far as replies and telemetry tell.
    #[must_use]
    pub fn is_done(&self) -> bool {
        matches!(
            self,
            Self::Answered(_)
                | Self::Confirmed
                | Self::Unknown {
                    verdict: Verdict::Done,
                    ..
                }
        )
    }
}

/// What the telemetry says about a motion whose reply did not come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// The drone moved as asked and is still.
    Done,
    /// The drone did not move.
    NotStarted,
    /// The drone moves.
    InProgress,
    /// The telemetry does not tell.
    Unknown,
}

/// Counts of what was not attributed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Datagrams sent.
    pub sent: u64,
    /// Replies attributed to a command.
    pub attributed: u64,
    /// Replies that came late or twice, or fit no waiting command.
    pub stale: u64,
    /// Packets of the binary protocol on the text ports.
    pub binary: u64,
    /// Datagrams of other addresses or ports that were dropped.
    pub foreign: u64,
    /// State lines read.
    pub states: u64,
    /// Datagrams on the state port that were no state line.
    pub bad_states: u64,
}

/// Why a request is not accepted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RequestError {
    /// The drone's SDK does not have the command.
    #[error("the command needs SDK {needs:?}, the drone speaks {has:?}")]
    Unsupported {
        /// First SDK with the command.
        needs: SdkVersion,
        /// The session's SDK.
        has: SdkVersion,
    },
    /// Too many requests wait.
    #[error("{waiting} requests are waiting already: wait for one to finish")]
    QueueFull {
        /// How many.
        waiting: usize,
    },
    /// `rc` is not requested, it is set with `set_sticks`.
    #[error("stick positions are not a request: use `set_sticks`")]
    Sticks,
    /// A motion while sticks are set would be refused by the drone.
    #[error("the sticks are in use: centre and release them before a motion")]
    SticksInUse,
    /// Sticks while a motion or a landing runs would be refused by the drone.
    #[error("a motion or a landing is running: wait until it has finished")]
    MotionRunning,
    /// The session lands or has landed on an alarm: only land, stop and emergency are accepted until acknowledged.
    #[error("the session is landing on an alarm ({0}): acknowledge it first")]
    Alarmed(Alarm),
}
