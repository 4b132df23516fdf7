//! A drone behind blocking calls. The threads keep it alive and watch it, whatever the caller does.

use super::config::DroneConfig;
use super::connect;
use super::engine::{Answer, Connection};
use super::error::{ConnectError, DriveError, settle};
use super::hub::StateHub;
use super::pilot::{Message, Status};
use super::video::VideoStream;
use crate::command::{Command, Query, SdkVersion};
use crate::reply::Reply;
use crate::safety::Finding;
use crate::session::{Counters, Event, Motors, RequestError, Sticks};
use crate::telemetry::Telemetry;
use crate::units::{Battery, Distance, Turn};
use alloc::boxed::Box;
use alloc::string::String;
use core::time::Duration;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};

/// Events that wait for [`Drone::next_event`] at most.
pub(super) const EVENTS: usize = 1024;

/// A connected drone; it can be used from several threads.
///
/// Dropping it (also while a panic unwinds) lands a drone that may be flying: land is repeated until the telemetry
/// confirms it or [`DroneConfig::landing_timeout`] has passed.
#[derive(Debug)]
pub struct Drone {
    connection: Connection<Message>,
    events: Mutex<Receiver<Event>>,
}

/// Lands a drone from anywhere and ends its connection: what waits on the drone ends with an error, and dropping the
/// [`Drone`] waits for the landing as always.
#[derive(Debug, Clone)]
pub struct Lander(SyncSender<Message>);

impl Lander {
    /// Lands if it may be flying; returns at once.
    pub fn land(&self) {
        // A connection that has ended has landed.
        let _ = self.0.send(Message::Close);
    }
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
        let (publish, events) = sync_channel(EVENTS);
        // Nobody has to listen; when the queue is full the newest event is dropped.
        let publish = Box::new(move |event| drop(publish.try_send(event)));
        let connection = connect::connect(config, hub, publish)?;
        let events = Mutex::new(events);
        Ok(Self { connection, events })
    }

    /// Sends a command and waits for its end.
    ///
    /// # Errors
    /// Everything but a positive end: see [`DriveError`]. A motion whose reply is missing but which the telemetry shows
    /// as done is a positive end without text.
    pub fn execute(&self, command: Command) -> Result<Reply, DriveError> {
        settle(self.ask(|answer| Message::Request(command, answer))??)
    }

    /// Checks battery, temperature, state and attitude, then takes off.
    ///
    /// # Errors
    /// A finding of the preflight, or the take-off failed.
    pub fn take_off(&self) -> Result<(), DriveError> {
        self.take_off_unless(None)
    }

    /// Like [`Drone::take_off`], and the video must have brought a key frame within the last two seconds.
    ///
    /// # Errors
    /// As [`Drone::take_off`], or there is no picture.
    pub fn take_off_seeing(&self, video: &VideoStream) -> Result<(), DriveError> {
        let age = video.key_frame_age();
        let seen = age.is_some_and(|age| age <= Duration::from_secs(2));
        let age_ms = age.map(|age| age.as_millis() as u64);
        self.take_off_unless((!seen).then_some(Finding::NoVideo { age_ms }))
    }

    fn take_off_unless(&self, blind: Option<Finding>) -> Result<(), DriveError> {
        let mut findings = self.ask(Message::Preflight)?;
        findings.extend(blind);
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
        super::error::percentage(reply)
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
        let _ = self.connection.inbox.send(Message::ReleaseSticks);
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
        let events = self.events.lock();
        let events = events.unwrap_or_else(PoisonError::into_inner);
        events.recv_timeout(timeout).ok()
    }

    /// The SDK that the drone speaks, by its answer to `sdk?`; one that does not know the question speaks 1.3.
    ///
    /// # Errors
    /// As [`Drone::execute`], or the answer is no known version.
    pub fn sdk_version(&self) -> Result<SdkVersion, DriveError> {
        let reply = match self.execute(Command::Query(Query::Sdk)) {
            Err(
                DriveError::Refused { .. } | DriveError::Request(RequestError::Unsupported { .. }),
            ) => {
                return Ok(SdkVersion::V1_3);
            }
            other => other?,
        };
        match reply.number() {
            Some(20.0) => Ok(SdkVersion::V2_0),
            Some(30.0) => Ok(SdkVersion::V3_0),
            _ => Err(DriveError::NotAValue { raw: reply.raw }),
        }
    }

    /// A handle that lands the drone from anywhere, a signal handler for example.
    #[must_use]
    pub fn lander(&self) -> Lander {
        Lander(self.connection.inbox.clone())
    }

    fn status(&self) -> Result<Status, DriveError> {
        self.ask(Message::Status)
    }

    fn ask<T: Send + 'static>(
        &self,
        message: impl FnOnce(Answer<T>) -> Message,
    ) -> Result<T, DriveError> {
        connect::ask(&self.connection, message)
    }
}
