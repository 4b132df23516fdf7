//! A drone in the binary protocol behind blocking calls: the same safety, the same telemetry, more of it.

use super::connect::{ask, bind};
use super::engine::{Answer, Connection, Engine};
use super::error::{ConnectError, DriveError};
use crate::binary::{
    BinaryCommand, BinaryConfig, BinaryEvent, BinaryOutput, BinarySession, CommandId, Ending,
};
use crate::safety::{Alarm, Finding, PreflightConfig, preflight};
use crate::session::{Sticks, Verdict};
use crate::telemetry::Telemetry;
use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;
use core::net::{Ipv4Addr, SocketAddr};
use core::time::Duration;
use std::sync::mpsc::{Receiver, channel, sync_channel};

/// Settings of a connection in the binary protocol.
#[derive(Debug, Clone, PartialEq)]
pub struct BinaryDroneConfig {
    /// The drone's command address. Default 192.168.10.1:8889.
    pub drone: SocketAddr,
    /// Local command socket. Default any address, port chosen by the system.
    pub bind: SocketAddr,
    /// Network interface that the socket is bound to, by name (Linux). Default any.
    pub interface: Option<String>,
    /// The session's settings; the port for video is among them.
    pub session: BinaryConfig,
    /// What must hold before [`BinaryDrone::take_off`].
    pub preflight: PreflightConfig,
    /// How long connecting waits for the first attitude. Default 5 s.
    pub connect_timeout: Duration,
    /// How long a dropped connection of a flying drone tries to land it. Default 20 s.
    pub landing_timeout: Duration,
}

impl Default for BinaryDroneConfig {
    fn default() -> Self {
        Self {
            drone: SocketAddr::from(([192, 168, 10, 1], 8889)),
            bind: SocketAddr::from((Ipv4Addr::UNSPECIFIED, 0)),
            interface: None,
            session: BinaryConfig::default(),
            preflight: PreflightConfig::default(),
            connect_timeout: Duration::from_secs(5),
            landing_timeout: Duration::from_secs(20),
        }
    }
}

impl BinaryDroneConfig {
    /// A drone at another address, everything else by default.
    #[must_use]
    pub fn at(drone: SocketAddr) -> Self {
        Self {
            drone,
            ..Self::default()
        }
    }
}

/// A connected drone. There are no moves by distance in this protocol: it is flown by sticks.
///
/// Dropping it (also while a panic unwinds) lands a drone that may be flying. For video open a
/// [`VideoStream`](super::VideoStream) with [`Framing::Binary`](crate::video::Framing::Binary) on the session's port.
#[derive(Debug)]
pub struct BinaryDrone {
    connection: Connection<Message>,
    events: Receiver<BinaryEvent>,
}

/// Events that wait at most.
const EVENTS: usize = 1024;

impl BinaryDrone {
    /// Connects and waits for the first log record with an attitude.
    ///
    /// # Errors
    /// The socket cannot be bound, the drone does not answer, or sends no log.
    pub fn connect(config: BinaryDroneConfig) -> Result<Self, ConnectError> {
        let (timeout, drone, local) = (config.connect_timeout, config.drone, config.bind);
        let socket = bind(local, config.interface.as_ref())?;
        let replies = socket.try_clone().map_err(ConnectError::Thread)?;
        let (publish, events) = sync_channel(EVENTS);
        let pilot = Pilot {
            session: BinarySession::new(config.session),
            config,
            publish: Box::new(move |event| {
                let _ = publish.try_send(event);
            }),
            waiting: BTreeMap::new(),
            awaiting: Vec::new(),
            closing: None,
        };
        let mut connection = Connection::start(pilot, socket, drone, || Message::Close)?;
        connection.read(replies, Message::Datagram)?;
        let (first, told) = channel();
        let answer: Answer<()> = Box::new(move |()| {
            let _ = first.send(());
        });
        let _ = connection.inbox.send(Message::AwaitAttitude(answer));
        if told.recv_timeout(timeout).is_ok() {
            return Ok(Self { connection, events });
        }
        let heard = ask(&connection, Message::Status).is_ok_and(|status| status.heard);
        Err(if heard {
            ConnectError::NoState { bind: local }
        } else {
            ConnectError::NoAnswer { drone }
        })
    }

    /// Checks battery, attitude and temperature, then takes off; returns when the drone has acknowledged it.
    ///
    /// # Errors
    /// A finding of the preflight, or no acknowledgement.
    pub fn take_off(&self) -> Result<(), DriveError> {
        let findings = ask(&self.connection, Message::Preflight)?;
        if !findings.is_empty() {
            return Err(DriveError::Preflight(findings));
        }
        self.command(BinaryCommand::TakeOff)
    }

    /// Lands: repeated until the flight data say that the drone is on the ground.
    ///
    /// # Errors
    /// Nothing confirmed it within [`BinaryConfig::land_give_up`].
    pub fn land(&self) -> Result<(), DriveError> {
        self.command(BinaryCommand::Land)
    }

    /// Sends a command and waits for its acknowledgement (`land`: until it stands). Only `land` is ever sent again.
    ///
    /// # Errors
    /// No acknowledgement came, or the session has landed on an alarm.
    pub fn command(&self, command: BinaryCommand) -> Result<(), DriveError> {
        match ask(&self.connection, |answer| Message::Command(command, answer))? {
            Ok(Ending::Acknowledged | Ending::Confirmed) => Ok(()),
            Ok(Ending::Unknown) => Err(DriveError::Unknown {
                verdict: Verdict::Unknown,
                attempts: 1,
            }),
            Err(alarm) => Err(crate::session::RequestError::Alarmed(alarm).into()),
        }
    }

    /// Sets the sticks; to be repeated within the watchdog's time.
    pub fn set_sticks(&self, sticks: Sticks) {
        let _ = self.connection.inbox.send(Message::Sticks(sticks));
    }

    /// Begins or ends the requests for video.
    pub fn set_video(&self, on: bool) {
        let _ = self.connection.inbox.send(Message::Video(on));
    }

    /// Cuts the motors at once: the drone falls.
    pub fn emergency(&self) {
        let _ = self.connection.inbox.send(Message::Emergency);
    }

    /// Reports a position for the fence, metres.
    pub fn report_position(&self, position: [f64; 3]) {
        let _ = self.connection.inbox.send(Message::Position(position));
    }

    /// Accepts commands again after an alarm.
    pub fn acknowledge_alarm(&self) {
        let _ = self.connection.inbox.send(Message::Acknowledge);
    }

    /// The newest telemetry and how old its attitude is.
    ///
    /// # Errors
    /// The connection is closed.
    pub fn telemetry(&self) -> Result<(Telemetry, Duration), DriveError> {
        let status = ask(&self.connection, Message::Status)?;
        Ok((status.telemetry, status.age))
    }

    /// Whether the drone is taken to be in the air.
    ///
    /// # Errors
    /// The connection is closed.
    pub fn may_be_flying(&self) -> Result<bool, DriveError> {
        ask(&self.connection, Message::Status).map(|status| status.may_be_flying)
    }

    /// Waits for the next event; `None` after the timeout. At most 1024 wait, newer ones are dropped.
    pub fn next_event(&self, timeout: Duration) -> Option<BinaryEvent> {
        self.events.recv_timeout(timeout).ok()
    }
}

#[derive(Debug, Clone, Copy)]
struct Status {
    telemetry: Telemetry,
    may_be_flying: bool,
    age: Duration,
    heard: bool,
}

enum Message {
    Datagram(SocketAddr, Vec<u8>),
    Command(BinaryCommand, Answer<Result<Ending, Alarm>>),
    Sticks(Sticks),
    Video(bool),
    Emergency,
    Position([f64; 3]),
    Acknowledge,
    Preflight(Answer<Vec<Finding>>),
    Status(Answer<Status>),
    AwaitAttitude(Answer<()>),
    Close,
}

struct Pilot {
    config: BinaryDroneConfig,
    session: BinarySession,
    publish: Box<dyn FnMut(BinaryEvent) + Send>,
    waiting: BTreeMap<CommandId, Answer<Result<Ending, Alarm>>>,
    awaiting: Vec<Answer<()>>,
    closing: Option<Duration>,
}

impl Engine for Pilot {
    type Message = Message;

    fn handle(&mut self, now: Duration, message: Message) {
        match message {
            Message::Datagram(from, bytes) => {
                if from.ip() == self.config.drone.ip() {
                    self.session.handle_datagram(now, &bytes);
                }
            }
            Message::Command(command, answer) => match self.session.command(now, command) {
                Ok(id) => drop(self.waiting.insert(id, answer)),
                Err(alarm) => answer(Err(alarm)),
            },
            Message::Sticks(sticks) => self.session.set_sticks(now, sticks),
            Message::Video(on) => self.session.set_video(now, on),
            Message::Emergency => self.session.emergency(),
            Message::Position(position) => self.session.report_position(now, position),
            Message::Acknowledge => self.session.acknowledge_alarm(),
            Message::Preflight(answer) => {
                let first = self.session.first_attitude();
                let telemetry = self.session.telemetry();
                answer(preflight(&self.config.preflight, telemetry, first, now));
            }
            Message::Status(answer) => answer(self.status(now)),
            Message::AwaitAttitude(answer) => self.awaiting.push(answer),
            Message::Close => self.close(now),
        }
        if self.session.first_attitude().is_some() {
            self.awaiting.drain(..).for_each(|answer| answer(()));
        }
    }

    fn tick(&mut self, now: Duration) {
        self.session.handle_timeout(now);
    }

    fn drain(&mut self, _now: Duration, send: &mut dyn FnMut(&[u8])) -> Duration {
        loop {
            match self.session.poll_output() {
                BinaryOutput::WaitUntil(deadline) => return deadline,
                BinaryOutput::Send(bytes) => send(&bytes),
                BinaryOutput::Event(event) => self.tell(event),
            }
        }
    }

    fn close(&mut self, now: Duration) {
        self.closing = self.closing.or(Some(now));
        if self.session.may_be_flying() {
            let _ = self.session.command(now, BinaryCommand::Land);
        }
    }

    fn is_over(&self, now: Duration) -> bool {
        self.closing.is_some_and(|since| {
            let waited = now.saturating_sub(since);
            !self.session.may_be_flying() || waited >= self.config.landing_timeout
        })
    }
}

impl Pilot {
    fn status(&self, now: Duration) -> Status {
        let telemetry = *self.session.telemetry();
        Status {
            telemetry,
            may_be_flying: self.session.may_be_flying(),
            age: telemetry.attitude.map_or(now, |reading| reading.age(now)),
            heard: telemetry.battery.is_some(),
        }
    }

    fn tell(&mut self, event: BinaryEvent) {
        if let BinaryEvent::Finished { id, ending, .. } = event
            && let Some(answer) = self.waiting.remove(&id)
        {
            answer(Ok(ending));
        }
        (self.publish)(event);
    }
}
