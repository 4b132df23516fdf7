//! A drone behind blocking calls. The threads keep it alive and watch it, whatever the caller does.

use super::config::DroneConfig;
use super::error::{ConnectError, DriveError};
use super::hub::StateHub;
use super::recorder::Recorder;
use super::worker::{Message, Status, Worker, read};
use crate::command::{Command, Query};
use crate::reply::Reply;
use crate::session::{Counters, Event, Motors, Outcome, Session, Sticks, Verdict};
use crate::telemetry::Telemetry;
use crate::units::{Battery, Distance, Turn};
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::net::UdpSocket;
use std::sync::mpsc::{Receiver, Sender, channel, sync_channel};
use std::thread::{Builder, JoinHandle};
use std::time::Instant;

/// Events that wait for [`Drone::next_event`] at most.
const EVENTS: usize = 1024;

/// A connected drone.
///
/// Dropping it (also while a panic unwinds) lands a drone that may be flying: land is repeated until the telemetry
/// confirms it or [`DroneConfig::landing_timeout`] has passed.
#[derive(Debug)]
pub struct Drone {
    inbox: Sender<Message>,
    events: Receiver<Event>,
    worker: Option<JoinHandle<()>>,
    readers: Vec<JoinHandle<()>>,
}

impl Drone {
    /// Binds the sockets, enters the text protocol and waits for the first state line.
    ///
    /// # Errors
    /// A port is in use, the drone does not answer, or sends no state.
    pub fn connect(config: DroneConfig) -> Result<Self, ConnectError> {
        Self::connect_by(config, None)
    }

    /// Like [`Drone::connect`], with the state from a hub that several drones share
    /// ([`DroneConfig::state_bind`] is not used then).
    ///
    /// # Errors
    /// As [`Drone::connect`].
    pub fn connect_through(hub: &StateHub, config: DroneConfig) -> Result<Self, ConnectError> {
        Self::connect_by(config, Some(hub))
    }

    fn connect_by(config: DroneConfig, hub: Option<&StateHub>) -> Result<Self, ConnectError> {
        let (timeout, address) = (config.connect_timeout, config.drone);
        let drone = Self::start(&config, hub)?;
        let start = Instant::now();
        let answered = drone.execute(Command::EnterSdk);
        if answered.is_err() {
            return Err(ConnectError::NoAnswer { drone: address });
        }
        while drone
            .status()
            .is_ok_and(|status| status.first_state.is_none())
        {
            if start.elapsed() > timeout {
                return Err(ConnectError::NoState {
                    bind: config.state_bind,
                });
            }
            // Replies and state lines arrive as events.
            let _ = drone.next_event(Duration::from_millis(50));
        }
        Ok(drone)
    }

    fn start(config: &DroneConfig, hub: Option<&StateHub>) -> Result<Self, ConnectError> {
        let command = bind(config.command_bind)?;
        let socket = command.try_clone().map_err(ConnectError::Thread)?;
        let (inbox, messages) = channel();
        let (publish, events) = sync_channel(EVENTS);
        let stop = Arc::new(AtomicBool::new(false));
        let worker = Worker {
            config: config.clone(),
            session: Session::new(config.session.clone())?,
            socket,
            inbox: messages,
            events: publish,
            stop: Arc::clone(&stop),
            start: Instant::now(),
            waiting: BTreeMap::new(),
            closing: None,
            recorder: Recorder::create(config.record.as_deref())?,
        };
        let started = (|| {
            let mut readers = Vec::from([reader(command, &stop, &inbox, Message::Reply)?]);
            match hub {
                Some(hub) => hub.register(config.drone.ip(), inbox.clone()),
                None => {
                    let state = bind(config.state_bind)?;
                    readers.push(reader(state, &stop, &inbox, Message::State)?);
                }
            }
            Ok((readers, spawn("tello-session", move || worker.run())?))
        })();
        let (readers, worker) =
            started.inspect_err(|_: &ConnectError| stop.store(true, Ordering::Relaxed))?;
        let worker = Some(worker);
        Ok(Self {
            inbox,
            events,
            worker,
            readers,
        })
    }

    /// Sends a command and waits for its end.
    ///
    /// # Errors
    /// Everything but a positive end: see [`DriveError`]. A motion whose reply is missing but which the telemetry shows
    /// as done is a positive end without text.
    pub fn execute(&self, command: Command) -> Result<Reply, DriveError> {
        let outcome = self.ask(|answer| Message::Request(command, answer))??;
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
            Outcome::Unknown { verdict, attempts } => {
                Err(DriveError::Unknown { verdict, attempts })
            }
            Outcome::NotSent => Err(DriveError::NotSent),
        }
    }

    /// Checks battery, temperature, state and attitude, then takes off.
    ///
    /// # Errors
    /// A finding of the preflight, or the take-off failed.
    pub fn take_off(&self) -> Result<(), DriveError> {
        let findings = self.ask(Message::Preflight)?;
        if !findings.is_empty() {
            return Err(DriveError::Preflight(findings));
        }
        self.execute(Command::TakeOff).map(drop)
    }

    /// Lands: repeated until a reply or the telemetry confirms it.
    ///
    /// # Errors
    /// Nothing confirmed it within [`SessionConfig::safety_give_up`](crate::SessionConfig::safety_give_up).
    pub fn land(&self) -> Result<(), DriveError> {
        self.execute(Command::Land).map(drop)
    }

    /// Flies forward.
    ///
    /// # Errors
    /// As [`Drone::execute`].
    pub fn forward(&self, distance: Distance) -> Result<(), DriveError> {
        self.execute(Command::Forward(distance)).map(drop)
    }

    /// Turns clockwise.
    ///
    /// # Errors
    /// As [`Drone::execute`].
    pub fn clockwise(&self, turn: Turn) -> Result<(), DriveError> {
        self.execute(Command::Clockwise(turn)).map(drop)
    }

    /// Asks for the battery's charge.
    ///
    /// # Errors
    /// As [`Drone::execute`], or the answer is no percentage.
    pub fn battery(&self) -> Result<Battery, DriveError> {
        let reply = self.execute(Command::Query(Query::Battery))?;
        let percent = reply
            .number()
            .and_then(|n| Battery::from_percent(n as i64).ok());
        percent.ok_or(DriveError::NotAValue { raw: reply.raw })
    }

    /// Asks a question and gives the answer's text.
    ///
    /// # Errors
    /// As [`Drone::execute`].
    pub fn query(&self, query: Query) -> Result<String, DriveError> {
        self.execute(Command::Query(query)).map(|reply| reply.raw)
    }

    /// Sets the sticks; to be repeated within the watchdog's time.
    ///
    /// # Errors
    /// A motion or landing runs, or an alarm is latched.
    pub fn set_sticks(&self, sticks: Sticks) -> Result<(), DriveError> {
        Ok(self.ask(|answer| Message::Sticks(sticks, answer))??)
    }

    /// Centres the sticks and releases them.
    pub fn release_sticks(&self) {
        let _ = self.inbox.send(Message::ReleaseSticks);
    }

    /// Reports a position for the fence, metres.
    pub fn report_position(&self, position: [f64; 3]) {
        let _ = self.inbox.send(Message::Position(position));
    }

    /// Accepts commands again after an alarm.
    pub fn acknowledge_alarm(&self) {
        let _ = self.inbox.send(Message::Acknowledge);
    }

    /// The newest telemetry and how old its attitude is.
    ///
    /// # Errors
    /// The connection is closed.
    pub fn telemetry(&self) -> Result<(Telemetry, Duration), DriveError> {
        self.status().map(|status| (status.telemetry, status.age))
    }

    /// Whether the motors turn.
    ///
    /// # Errors
    /// The connection is closed.
    pub fn motors(&self) -> Result<Motors, DriveError> {
        self.status().map(|status| status.motors)
    }

    /// Whether the drone is taken to be in the air.
    ///
    /// # Errors
    /// The connection is closed.
    pub fn may_be_flying(&self) -> Result<bool, DriveError> {
        self.status().map(|status| status.may_be_flying)
    }

    /// What was and was not attributed.
    ///
    /// # Errors
    /// The connection is closed.
    pub fn counters(&self) -> Result<Counters, DriveError> {
        self.status().map(|status| status.counters)
    }

    /// Waits for the next event; `None` after the timeout. At most 1024 wait, newer ones are dropped.
    pub fn next_event(&self, timeout: Duration) -> Option<Event> {
        self.events.recv_timeout(timeout).ok()
    }

    fn status(&self) -> Result<Status, DriveError> {
        self.ask(Message::Status)
    }

    fn ask<T>(
        &self,
        message: impl FnOnce(super::worker::Answer<T>) -> Message,
    ) -> Result<T, DriveError> {
        let (answer, result) = sync_channel(1);
        self.inbox
            .send(message(answer))
            .map_err(|_| DriveError::Closed)?;
        result.recv().map_err(|_| DriveError::Closed)
    }
}

impl Drop for Drone {
    fn drop(&mut self) {
        let _ = self.inbox.send(Message::Close);
        for thread in self.worker.take().into_iter().chain(self.readers.drain(..)) {
            let _ = thread.join();
        }
    }
}

fn bind(address: SocketAddr) -> Result<UdpSocket, ConnectError> {
    UdpSocket::bind(address).map_err(|source| ConnectError::Bind { address, source })
}

fn reader(
    socket: UdpSocket,
    stop: &Arc<AtomicBool>,
    inbox: &Sender<Message>,
    message: fn(SocketAddr, Vec<u8>) -> Message,
) -> Result<JoinHandle<()>, ConnectError> {
    let (stop, outbox) = (Arc::clone(stop), inbox.clone());
    spawn("tello-read", move || read(&socket, &stop, &outbox, message))
}

fn spawn(name: &str, run: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, ConnectError> {
    Builder::new()
        .name(name.into())
        .spawn(run)
        .map_err(ConnectError::Thread)
}
