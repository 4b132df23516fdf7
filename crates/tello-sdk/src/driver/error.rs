//! What can go wrong while connecting and while flying.

use crate::reply::{Refusal, Reply};
use crate::safety::Finding;
use crate::session::{ConfigError, Outcome, RequestError, Verdict};
use crate::units::Battery;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::net::SocketAddr;
use std::path::PathBuf;

/// Why there is no connection.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConnectError {
    /// A local socket cannot be bound.
    #[error("cannot bind the local socket {address}: {source}; another program may hold the port")]
    Bind {
        /// Which.
        address: SocketAddr,
        /// Why.
        source: std::io::Error,
    },
    /// The recording cannot be written.
    #[error("cannot write the recording {}: {source}", path.display())]
    Record {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A thread cannot be started.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
    /// The configuration is refused.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The drone did not answer `command`.
    #[error(
        "the drone at {drone} did not answer: check that this machine is in the drone's network and that the drone is on; after a session of the phone app it has to be switched off and on"
    )]
    NoAnswer {
        /// The drone's address.
        drone: SocketAddr,
    },
    /// The drone answered but sent no state line.
    #[error(
        "no state line came on {bind}: check that no firewall blocks the port and no other program holds it"
    )]
    NoState {
        /// The local state socket.
        bind: SocketAddr,
    },
}

/// Why a command was not carried out, or what is not known about it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DriveError {
    /// Not accepted, nothing was sent.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// Something speaks against taking off; nothing was sent.
    #[error("not taking off: {}", list(.0))]
    Preflight(Vec<Finding>),
    /// The drone refused.
    #[error("the drone refused: {refusal} (`{raw}`)")]
    Refused {
        /// Why.
        refusal: Refusal,
        /// Its words.
        raw: String,
    },
    /// No reply came; by the telemetry the command was not carried out, or that cannot be told. It was not sent again.
    #[error("no reply to the command ({attempts} sent); by the telemetry it is {verdict:?}")]
    Unknown {
        /// What the telemetry says.
        verdict: Verdict,
        /// How often it was sent.
        attempts: u32,
    },
    /// Something more urgent came first, or the link was down; nothing was sent.
    #[error("not sent: something more urgent came first or the link is down")]
    NotSent,
    /// The answer is not what the query asks for.
    #[error("the answer `{raw}` is not a value of the query")]
    NotAValue {
        /// The answer.
        raw: String,
    },
    /// The connection's thread has ended.
    #[error("the connection is closed")]
    Closed,
}

/// A positive end as a reply, anything else as an error.
pub(super) fn settle(outcome: Outcome) -> Result<Reply, DriveError> {
    match outcome {
        Outcome::Answered(reply) => Ok(reply),
        Outcome::Confirmed
        | Outcome::Unknown {
            verdict: Verdict::Done,
            ..
        } => Ok(Reply::parse(b"")),
        Outcome::Refused { refusal, reply } => Err(DriveError::Refused {
            refusal,
            raw: reply.raw,
        }),
        Outcome::Unknown { verdict, attempts } => Err(DriveError::Unknown { verdict, attempts }),
        Outcome::NotSent => Err(DriveError::NotSent),
    }
}

/// The answer to the question for the battery.
pub(super) fn percentage(reply: Reply) -> Result<Battery, DriveError> {
    let percent = reply
        .number()
        .and_then(|n| Battery::from_percent(n as i64).ok());
    percent.ok_or(DriveError::NotAValue { raw: reply.raw })
}

fn list(findings: &[Finding]) -> String {
    let texts: Vec<String> = findings.iter().map(ToString::to_string).collect();
    texts.join("; ")
}
