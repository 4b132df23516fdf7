//! The thread that owns the session: datagrams, requests and time go in through one channel.

use super::config::DroneConfig;
use super::recorder::Recorder;
use crate::command::Command;
use crate::record::Channel;
use crate::safety::{Finding, preflight};
use crate::session::{
    Counters, Event, Input, Motors, Origin, Outcome, Output, RequestError, RequestId, Session,
    Sticks,
};
use crate::telemetry::Telemetry;
use alloc::collections::BTreeMap;
use alloc::string::ToString;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender};
use std::time::Instant;

/// Where the answer to a call goes.
pub(super) type Answer<T> = SyncSender<T>;

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
    pub(super) first_state: Option<Duration>,
}

pub(super) struct Worker {
    pub(super) config: DroneConfig,
    pub(super) session: Session,
    pub(super) socket: UdpSocket,
    pub(super) inbox: Receiver<Message>,
    pub(super) events: SyncSender<Event>,
    pub(super) stop: Arc<AtomicBool>,
    pub(super) start: Instant,
    pub(super) waiting: BTreeMap<RequestId, Answer<Result<Outcome, RequestError>>>,
    pub(super) closing: Option<Duration>,
    pub(super) recorder: Recorder,
}

impl Worker {
    pub(super) fn run(mut self) {
        loop {
            let deadline = self.drain();
            if self.is_over() {
                break;
            }
            let wait = deadline
                .saturating_sub(self.now())
                .min(Duration::from_millis(100));
            match self.inbox.recv_timeout(wait) {
                Ok(message) => self.handle(message),
                Err(RecvTimeoutError::Timeout) => {
                    self.session.handle_input(Input::Tick(self.now()));
                }
                // The owner is gone without a word.
                Err(RecvTimeoutError::Disconnected) if self.closing.is_none() => self.close(),
                Err(RecvTimeoutError::Disconnected) => {
                    self.session.handle_input(Input::Tick(self.now()));
                }
            }
        }
        self.stop.store(true, Ordering::Relaxed);
    }

    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    fn handle(&mut self, message: Message) {
        let now = self.now();
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
                let _ = answer.try_send(self.session.set_sticks(now, sticks));
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
                let _ = answer.try_send(preflight(&self.config.preflight, telemetry, first, now));
            }
            Message::Status(answer) => drop(answer.try_send(self.status(now))),
            Message::Close => self.close(),
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
            Err(error) => drop(answer.try_send(Err(error))),
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
            first_state: self.session.first_state(),
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

    /// Lands a drone that may be flying.
    fn close(&mut self) {
        let now = self.now();
        self.closing = Some(now);
        if self.session.may_be_flying() {
            self.recorder.write(now, Channel::Request, b"land");
            let _ = self.session.request(now, Command::Land);
        }
    }

    fn is_over(&self) -> bool {
        let Some(since) = self.closing else {
            return false;
        };
        let landed = !self.session.may_be_flying() && self.session.is_idle();
        landed || self.now().saturating_sub(since) >= self.config.landing_timeout
    }

    /// Carries out what the session wants; returns its next deadline.
    fn drain(&mut self) -> Duration {
        loop {
            match self.session.poll_output() {
                Output::WaitUntil(deadline) => return deadline,
                Output::Send(bytes) => {
                    self.recorder
                        .write(self.start.elapsed(), Channel::Sent, &bytes);
                    // A dead network is the same as a lost datagram: the session finds out by the silence.
                    let _ = self.socket.send_to(&bytes, self.config.drone);
                }
                Output::Event(event) => self.publish(event),
            }
        }
    }

    fn publish(&mut self, event: Event) {
        if let Event::Finished { id, outcome, .. } = &event
            && let Some(answer) = self.waiting.remove(id)
        {
            let _ = answer.try_send(Ok(outcome.clone()));
        }
        // Nobody has to listen; when the queue is full the newest event is dropped.
        let _ = self.events.try_send(event);
    }
}

/// Reads a socket until told to stop.
pub(super) fn read(
    socket: &UdpSocket,
    stop: &AtomicBool,
    outbox: &Sender<Message>,
    message: fn(SocketAddr, Vec<u8>) -> Message,
) {
    let mut buffer = [0_u8; 2048];
    let _ = socket.set_read_timeout(Some(Duration::from_millis(100)));
    while !stop.load(Ordering::Relaxed) {
        if let Ok((length, from)) = socket.recv_from(&mut buffer) {
            let bytes = buffer.get(..length).unwrap_or_default().to_vec();
            if outbox.send(message(from, bytes)).is_err() {
                return;
            }
        }
    }
}
