//! The same drone behind asynchronous calls (feature `tokio`).
//!
//! The session keeps the threads of the blocking [`Drone`](super::Drone): an executor that is busy or stopped starves
//! neither the keep-alive nor a landing, and both front ends speak to the drone in the same words.

use super::blocking::EVENTS;
use super::config::DroneConfig;
use super::connect;
use super::engine::{Answer, Connection};
use super::error::{ConnectError, DriveError, percentage, settle};
use super::pilot::{Message, Status};
use crate::command::{Command, Query};
use crate::reply::Reply;
use crate::session::{Counters, Event, Sticks};
use crate::telemetry::Telemetry;
use crate::units::{Battery, Distance, Turn};
use alloc::boxed::Box;
use alloc::string::String;
use core::time::Duration;
use tokio::sync::{mpsc, oneshot};
use tokio::task::spawn_blocking;

/// A connected drone.
///
/// [`AsyncDrone::close`] lands it without holding up the executor. Dropping it lands it too, but blocks the thread until
/// then or until [`DroneConfig::landing_timeout`]: a program that ends in the meantime would leave it in the air.
#[derive(Debug)]
pub struct AsyncDrone {
    connection: Connection<Message>,
    events: mpsc::Receiver<Event>,
}

impl AsyncDrone {
    /// Binds the sockets, enters the text protocol and waits for the first state line.
    ///
    /// # Errors
    /// A port is in use, the drone does not answer, or sends no state.
    pub async fn connect(config: DroneConfig) -> Result<Self, ConnectError> {
        let (publish, events) = mpsc::channel(EVENTS);
        // Nobody has to listen; when the queue is full the newest event is dropped.
        let publish = Box::new(move |event| drop(publish.try_send(event)));
        let connected = spawn_blocking(move || connect::connect(config, None, publish)).await;
        let connection = connected.map_err(|error| ConnectError::Thread(error.into()))??;
        Ok(Self { connection, events })
    }

    /// Sends a command and waits for its end.
    ///
    /// # Errors
    /// As [`Drone::execute`](super::Drone::execute).
    pub async fn execute(&self, command: Command) -> Result<Reply, DriveError> {
        settle(
            self.ask(|answer| Message::Request(command, answer))
                .await??,
        )
    }

    /// Checks battery, temperature, state and attitude, then takes off.
    ///
    /// # Errors
    /// A finding of the preflight, or the take-off failed.
    pub async fn take_off(&self) -> Result<(), DriveError> {
        let findings = self.ask(Message::Preflight).await?;
        if !findings.is_empty() {
            return Err(DriveError::Preflight(findings));
        }
        self.execute(Command::TakeOff).await.map(drop)
    }

    /// Lands: repeated until a reply or the telemetry confirms it.
    ///
    /// # Errors
    /// As [`AsyncDrone::execute`].
    pub async fn land(&self) -> Result<(), DriveError> {
        self.execute(Command::Land).await.map(drop)
    }

    /// Flies forward.
    ///
    /// # Errors
    /// As [`AsyncDrone::execute`].
    pub async fn forward(&self, distance: Distance) -> Result<(), DriveError> {
        self.execute(Command::Forward(distance)).await.map(drop)
    }

    /// Turns clockwise.
    ///
    /// # Errors
    /// As [`AsyncDrone::execute`].
    pub async fn clockwise(&self, turn: Turn) -> Result<(), DriveError> {
        self.execute(Command::Clockwise(turn)).await.map(drop)
    }

    /// Asks for the battery's charge.
    ///
    /// # Errors
    /// As [`AsyncDrone::execute`], or the answer is no percentage.
    pub async fn battery(&self) -> Result<Battery, DriveError> {
        percentage(self.execute(Command::Query(Query::Battery)).await?)
    }

    /// Asks a question and gives the answer's text.
    ///
    /// # Errors
    /// As [`AsyncDrone::execute`].
    pub async fn query(&self, query: Query) -> Result<String, DriveError> {
        self.execute(Command::Query(query))
            .await
            .map(|reply| reply.raw)
    }

    /// Sets the sticks; to be repeated within the watchdog's time.
    ///
    /// # Errors
    /// A motion or landing runs, or an alarm is latched.
    pub async fn set_sticks(&self, sticks: Sticks) -> Result<(), DriveError> {
        Ok(self.ask(|answer| Message::Sticks(sticks, answer)).await??)
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
    pub async fn telemetry(&self) -> Result<(Telemetry, Duration), DriveError> {
        let status = self.status().await?;
        Ok((status.telemetry, status.age))
    }

    /// Whether the drone is taken to be in the air.
    ///
    /// # Errors
    /// The connection is closed.
    pub async fn may_be_flying(&self) -> Result<bool, DriveError> {
        self.status().await.map(|status| status.may_be_flying)
    }

    /// What was and was not attributed.
    ///
    /// # Errors
    /// The connection is closed.
    pub async fn counters(&self) -> Result<Counters, DriveError> {
        self.status().await.map(|status| status.counters)
    }

    /// The next event; `None` when the connection has ended. At most 1024 wait, newer ones are dropped.
    pub async fn next_event(&mut self) -> Option<Event> {
        self.events.recv().await
    }

    /// Lands a drone that may be flying and ends the connection.
    pub async fn close(self) {
        // The wait is on a thread that may block; nothing is left to do if it cannot be joined.
        let _ = spawn_blocking(move || drop(self)).await;
    }

    async fn status(&self) -> Result<Status, DriveError> {
        self.ask(Message::Status).await
    }

    async fn ask<T: Send + 'static>(
        &self,
        message: impl FnOnce(Answer<T>) -> Message,
    ) -> Result<T, DriveError> {
        let (answer, result) = oneshot::channel();
        let answer: Answer<T> = Box::new(move |value| drop(answer.send(value)));
        let sent = self.connection.inbox.send(message(answer));
        sent.map_err(|_| DriveError::Closed)?;
        result.await.map_err(|_| DriveError::Closed)
    }
}
