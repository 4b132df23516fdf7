//! What the text protocol's thread does with each message: into the session, and out of it to whoever waits.

use super::config::DroneConfig;
use super::engine::{Answer, Engine};
use super::recorder::Recorder;
use crate::command::Command;
use crate::record::Channel;
use crate::safety::{Finding, preflight};
use crate::session::{
    Counters, Event, Input, Motors, Origin, Outcome, Output, RequestError, RequestId, Session,
    Sticks,
};
use crate::telemetry::Telemetry;
use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::ToString;
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::time::Duration;

pub(super) enum Message {
    Reply(SocketAddr, Vec<u8>),
    State(SocketAddr, Vec<u8>),
    Request(Command, Answer<Result<Outcome, RequestError>>),
    Sticks(Sticks, Answer<Result<(), RequestError>>),
    ReleaseSticks,
    Position([f64; 3]),
    Acknowledge,
    Preflight(Answer<Vec<Finding>>),
    Status(Answer<Status>),
    /// Asks to be told of the first state line.
    AwaitState(Answer<()>),
    /// Land if flying, then end.
    Close,
}

/// A copy of what the session knows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Status {
    pub(super) telemetry: Telemetry,
    pub(super) motors: Motors,
    pub(super) may_be_flying: bool,
    pub(super) counters: Counters,
    pub(super) age: Duration,
}

/// The engine of the text protocol.
pub(super) struct Pilot {
    config: DroneConfig,
    session: Session,
    publish: Box<dyn FnMut(Event) + Send>,
    waiting: BTreeMap<RequestId, Answer<Result<Outcome, RequestError>>>,
    awaiting: Vec<Answer<()>>,
    closing: Option<Duration>,
    recorder: Recorder,
}

impl Engine for Pilot {
    type Message = Message;

    fn handle(&mut self, now: Duration, message: Message) {
        self.take(now, message);
        if self.session.first_state().is_some() {
            self.awaiting.drain(..).for_each(|answer| answer(()));
        }
    }

    fn tick(&mut self, now: Duration) {
        self.session.handle_input(Input::Tick(now));
    }

    fn drain(&mut self, now: Duration, send: &mut dyn FnMut(&[u8])) -> Duration {
        loop {
            match self.session.poll_output() {
                Output::WaitUntil(deadline) => return deadline,
                Output::Send(bytes) => {
                    self.recorder.write(now, Channel::Sent, &bytes);
                    send(&bytes);
                }
                Output::Event(event) => self.publish(event),
            }
        }
    }

    fn close(&mut self, now: Duration) {
        self.closing = self.closing.or(Some(now));
        if self.session.may_be_flying() {
            self.recorder.write(now, Channel::Request, b"land");
            let _ = self.session.request(now, Command::Land);
        }
    }

    fn is_over(&self, now: Duration) -> bool {
        let Some(since) = self.closing else {
            return false;
        };
        let landed = !self.session.may_be_flying() && self.session.is_idle();
        landed || now.saturating_sub(since) >= self.config.landing_timeout
    }
}

impl Pilot {
    /// Events go to `publish`.
    pub(super) fn new(
        config: DroneConfig,
        session: Session,
        recorder: Recorder,
        publish: Box<dyn FnMut(Event) + Send>,
    ) -> Self {
        Self {
            config,
            session,
            publish,
            waiting: BTreeMap::new(),
            awaiting: Vec::new(),
            closing: None,
            recorder,
        }
    }

    fn take(&mut self, now: Duration, message: Message) {
        match message {
            Message::Reply(from, bytes) => {
                self.recorder.write(now, Channel::Reply, &bytes);
                let origin = self.origin(from, true);
                self.session.handle_input(Input::Reply {
                    at: now,
                    origin,
                    bytes: &bytes,
                });
            }
            Message::State(from, bytes) => {
                self.recorder.write(now, Channel::State, &bytes);
                let origin = self.origin(from, false);
                self.session.handle_input(Input::State {
                    at: now,
                    origin,
                    bytes: &bytes,
                });
            }
            Message::Request(command, answer) => self.request(now, command, answer),
            Message::Sticks(sticks, answer) => {
                let text = sticks.command().to_string();
                self.recorder.write(now, Channel::Sticks, text.as_bytes());
                answer(self.session.set_sticks(now, sticks));
            }
            Message::ReleaseSticks => {
                self.recorder.write(now, Channel::ReleaseSticks, &[]);
                self.session.release_sticks(now);
            }
            Message::Position(position) => self.session.report_position(now, position),
            Message::Acknowledge => self.session.acknowledge_alarm(),
            Message::Preflight(answer) => {
                let first = self.session.first_state();
                let telemetry = self.session.telemetry();
                answer(preflight(&self.config.preflight, telemetry, first, now));
            }
            Message::Status(answer) => answer(self.status(now)),
            Message::AwaitState(answer) => self.awaiting.push(answer),
            Message::Close => self.close(now),
        }
    }

    fn request(
        &mut self,
        now: Duration,
        command: Command,
        answer: Answer<Result<Outcome, RequestError>>,
    ) {
        self.recorder
            .write(now, Channel::Request, command.to_string().as_bytes());
        match self.session.request(now, command) {
            Ok(id) => drop(self.waiting.insert(id, answer)),
            Err(error) => answer(Err(error)),
        }
    }

    fn status(&self, now: Duration) -> Status {
        let telemetry = *self.session.telemetry();
        Status {
            telemetry,
            motors: self.session.motors(),
            may_be_flying: self.session.may_be_flying(),
            counters: self.session.counters(),
            age: telemetry.attitude.map_or(now, |reading| reading.age(now)),
        }
    }

    fn origin(&self, from: SocketAddr, port_matters: bool) -> Origin {
        if from.ip() != self.config.drone.ip() {
            Origin::Stranger
        } else if port_matters && from.port() != self.config.drone.port() {
            Origin::OtherPort
        } else {
            Origin::Drone
        }
    }

    fn publish(&mut self, event: Event) {
        if let Event::Finished { id, outcome, .. } = &event
            && let Some(answer) = self.waiting.remove(id)
        {
            answer(Ok(outcome.clone()));
        }
        (self.publish)(event);
    }
}
