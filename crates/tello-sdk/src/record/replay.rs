//! A recorded session run again: the same inputs at the same times through a fresh session.

use super::format::{Channel, Record, Records};
use crate::command::Command;
use crate::session::{ConfigError, Event, Input, Origin, Output, Session, SessionConfig, Sticks};
use alloc::string::String;
use alloc::vec::Vec;
use core::time::Duration;

/// What came out of a recorded session when run again.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// What the session sent this time.
    pub sent: Vec<(Duration, String)>,
    /// What the recording says was sent.
    pub recorded: Vec<(Duration, String)>,
    /// The session's events.
    pub events: Vec<(Duration, Event)>,
    /// Records that are no input (unreadable requests).
    pub skipped: usize,
}

impl Replay {
    /// Whether the same texts were sent in the same order.
    #[must_use]
    pub fn is_identical(&self) -> bool {
        let texts =
            |list: &[(Duration, String)]| list.iter().map(|(_, t)| t.clone()).collect::<Vec<_>>();
        texts(&self.sent) == texts(&self.recorded)
    }
}

/// Runs a recording through a session with the given configuration, in virtual time.
///
/// # Errors
/// The configuration is refused.
pub fn replay(bytes: &[u8], config: SessionConfig) -> Result<Replay, ConfigError> {
    let mut run = Run {
        session: Session::new(config)?,
        now: Duration::ZERO,
        replay: Replay {
            sent: Vec::new(),
            recorded: Vec::new(),
            events: Vec::new(),
            skipped: 0,
        },
    };
    for record in Records::new(bytes) {
        run.reach(record.at);
        run.apply(&record);
    }
    run.drain();
    Ok(run.replay)
}

struct Run {
    session: Session,
    now: Duration,
    replay: Replay,
}

impl Run {
    /// Lets the session do what is due before `end`.
    fn reach(&mut self, end: Duration) {
        loop {
            let due = self.drain();
            if due >= end {
                self.now = self.now.max(end);
                return;
            }
            self.now = self.now.max(due);
            self.session.handle_input(Input::Tick(self.now));
        }
    }

    fn drain(&mut self) -> Duration {
        loop {
            match self.session.poll_output() {
                Output::WaitUntil(at) => return at,
                Output::Event(event) => self.replay.events.push((self.now, event)),
                Output::Send(bytes) => {
                    let text = String::from_utf8_lossy(&bytes).into_owned();
                    self.replay.sent.push((self.now, text));
                }
            }
        }
    }

    fn apply(&mut self, record: &Record<'_>) {
        let (at, bytes, origin) = (record.at, record.bytes, Origin::Drone);
        let text = String::from_utf8_lossy(bytes);
        match record.channel {
            Channel::Sent => self.replay.recorded.push((at, text.into_owned())),
            Channel::Reply => self
                .session
                .handle_input(Input::Reply { at, origin, bytes }),
            Channel::State => self
                .session
                .handle_input(Input::State { at, origin, bytes }),
            Channel::Video => {}
            Channel::ReleaseSticks => self.session.release_sticks(at),
            Channel::Request | Channel::Sticks => match Command::parse(&text) {
                Ok(Command::Rc {
                    roll,
                    pitch,
                    throttle,
                    yaw,
                }) => {
                    let _ = self.session.set_sticks(
                        at,
                        Sticks {
                            roll,
                            pitch,
                            throttle,
                            yaw,
                        },
                    );
                }
                Ok(command) => drop(self.session.request(at, command)),
                Err(_) => self.replay.skipped += 1,
            },
        }
    }
}
