//! The client side of the text protocol without sockets, clocks or threads.
//!
//! Contract: after every call that takes a time, drain [`Session::poll_output`] until it returns
//! [`Output::WaitUntil`]; then wait for a datagram or for that time and call [`Session::handle_input`].
//!
//! 1. One command is in flight. Its reply is recognised by order and shape; a reply that could belong to an earlier
//!    command is counted and handed out as [`Event::Stale`], never attributed.
//! 2. No reply in time: queries and settings are sent again, motions never. What became of a motion is judged by the
//!    telemetry after a query (the fence) has shown that the drone answers and moves no more.
//! 3. `land`, `stop`, `motoroff` and `emergency` overtake everything and are repeated until confirmed.
//! 4. `rc` goes out at a fixed rate and is centred when no new set-point comes.
//!
//! What it rests on: a datagram older than [`SessionConfig::max_delay`] never arrives, a copy not later than
//! [`SessionConfig::duplicate_window`] after the first. Cost: constant per input (measured below 1 us).

mod advance;
mod config;
mod event;
mod evidence;
mod exchange;
mod ledger;
mod priority;
mod replies;
mod sticks;

pub use config::{ConfigError, SessionConfig};
pub use event::{
    Counters, Event, Input, Origin, Outcome, Output, RequestError, RequestId, Verdict,
};
pub use evidence::Motors;
pub use sticks::Sticks;

use crate::command::{Class, Command};
use crate::safety::{Alarm, Guard, outside};
use crate::telemetry::Telemetry;
use alloc::collections::VecDeque;
use alloc::string::ToString;
use core::time::Duration;
use evidence::Evidence;
use exchange::{Exchange, Probe, Queued};
use ledger::Ledger;
use priority::Urgent;
use sticks::StickLane;

/// Later times are taken as this one (a hundred years), so that sums of times cannot overflow.
const LATEST: Duration = Duration::from_secs(100 * 365 * 86_400);

/// One drone as seen from this side of the link.
#[derive(Debug, Clone)]
pub struct Session {
    config: SessionConfig,
    now: Duration,
    queue: VecDeque<Queued>,
    exchange: Option<Exchange>,
    urgent: Option<Urgent>,
    resync: Option<Probe>,
    ledger: Ledger,
    sticks: StickLane,
    evidence: Evidence,
    guard: Guard,
    telemetry: Telemetry,
    first_state: Option<Duration>,
    last_sent: Option<Duration>,
    last_heard: Duration,
    last_beat: Duration,
    lift_off_until: Option<Duration>,
    link_lost: bool,
    next_id: u64,
    outputs: VecDeque<Output>,
    counters: Counters,
}

impl Session {
    /// A session at time zero that has sent nothing.
    ///
    /// # Errors
    /// A period or a count of the configuration is zero.
    pub fn new(config: SessionConfig) -> Result<Self, ConfigError> {
        config.validate()?;
        Ok(Self {
            config,
            now: Duration::ZERO,
            queue: VecDeque::new(),
            exchange: None,
            urgent: None,
            resync: None,
            ledger: Ledger::default(),
            sticks: StickLane::new(),
            evidence: Evidence::default(),
            guard: Guard::default(),
            telemetry: Telemetry::default(),
            first_state: None,
            last_sent: None,
            last_heard: Duration::ZERO,
            last_beat: Duration::ZERO,
            lift_off_until: None,
            link_lost: false,
            next_id: 0,
            outputs: VecDeque::new(),
            counters: Counters::default(),
        })
    }

    /// Asks for a command; its end comes as [`Event::Finished`].
    ///
    /// Commands are sent in the order of the requests, except that land, stop, motoroff and emergency overtake: what
    /// waits is then dropped ([`Outcome::NotSent`]) and what is in flight is given up ([`Outcome::Unknown`]).
    ///
    /// # Errors
    /// The drone's SDK lacks the command, the queue is full, sticks are in use, or an alarm is latched.
    pub fn request(&mut self, now: Duration, command: Command) -> Result<RequestId, RequestError> {
        self.accepts(&command)?;
        self.now = self.now.max(now.min(LATEST));
        self.next_id += 1;
        let id = RequestId(self.next_id);
        if command.class() == Class::Safety {
            self.start_urgent(Some(id), command);
        } else {
            self.queue.push_back(Queued {
                id,
                command,
                since: self.now,
            });
        }
        self.advance();
        Ok(id)
    }

    fn accepts(&self, command: &Command) -> Result<(), RequestError> {
        let (needs, has) = (command.since(), self.config.version);
        if needs > has {
            return Err(RequestError::Unsupported { needs, has });
        }
        let class = command.class();
        if class == Class::Sticks {
            return Err(RequestError::Sticks);
        }
        if class == Class::Safety {
            return Ok(());
        }
        if let (Some(alarm), true) = (self.guard.latched(), class != Class::Query) {
            return Err(RequestError::Alarmed(alarm));
        }
        if class == Class::Motion && self.sticks.is_active() {
            return Err(RequestError::SticksInUse);
        }
        if self.queue.len() >= self.config.queue_limit {
            return Err(RequestError::QueueFull {
                waiting: self.queue.len(),
            });
        }
        Ok(())
    }

    /// Sets the sticks; they are sent at [`SessionConfig::stick_period`] until released or until
    /// [`SessionConfig::stick_watchdog`] passes without another call.
    ///
    /// # Errors
    /// A motion or a landing is running, or an alarm is latched.
    pub fn set_sticks(&mut self, now: Duration, sticks: Sticks) -> Result<(), RequestError> {
        if let Some(alarm) = self.guard.latched() {
            return Err(RequestError::Alarmed(alarm));
        }
        let moving = self
            .exchange
            .as_ref()
            .is_some_and(|e| e.command.class() == Class::Motion);
        let waiting = self
            .queue
            .iter()
            .any(|q| q.command.class() == Class::Motion);
        if moving || waiting || self.urgent.is_some() {
            return Err(RequestError::MotionRunning);
        }
        self.now = self.now.max(now.min(LATEST));
        self.sticks.set(self.now, sticks);
        self.advance();
        Ok(())
    }

    /// Centres the sticks and goes quiet after saying so several times.
    pub fn release_sticks(&mut self, now: Duration) {
        self.now = self.now.max(now.min(LATEST));
        self.sticks.release(self.now);
        self.advance();
    }

    /// Tells that the owner is alive; needed only with [`SessionConfig::heartbeat`].
    pub fn heartbeat(&mut self, now: Duration) {
        self.now = self.now.max(now.min(LATEST));
        self.last_beat = self.now;
        self.advance();
    }

    /// Reports a position from outside (SLAM, a simulator) for the fence of the safety limits, metres.
    pub fn report_position(&mut self, now: Duration, position: [f64; 3]) {
        self.now = self.now.max(now.min(LATEST));
        if let Some(fence) = &self.config.safety.fence {
            let distance_cm = outside(fence, position);
            if distance_cm > 0 && self.guard.is_flying() {
                self.raise(Alarm::Fence { distance_cm });
            }
        }
        self.advance();
    }

    /// Accepts commands again after an alarm.
    pub fn acknowledge_alarm(&mut self) {
        self.guard.acknowledge();
    }

    /// Takes in a datagram or the passing of time.
    pub fn handle_input(&mut self, input: Input<'_>) {
        match input {
            Input::Tick(at) => self.now = self.now.max(at.min(LATEST)),
            Input::Reply { at, origin, bytes } => {
                self.now = self.now.max(at.min(LATEST));
                self.on_reply(origin, bytes);
            }
            Input::State { at, origin, bytes } => {
                self.now = self.now.max(at.min(LATEST));
                self.on_state(origin, bytes);
            }
        }
        self.advance();
    }

    /// What to do next; call until it returns [`Output::WaitUntil`].
    pub fn poll_output(&mut self) -> Output {
        self.outputs
            .pop_front()
            .unwrap_or_else(|| Output::WaitUntil(self.deadline()))
    }

    /// The newest value of each kind.
    #[must_use]
    pub fn telemetry(&self) -> &Telemetry {
        &self.telemetry
    }

    /// When the first state line came.
    #[must_use]
    pub fn first_state(&self) -> Option<Duration> {
        self.first_state
    }

    /// Whether the motors turn, by the telemetry.
    #[must_use]
    pub fn motors(&self) -> Motors {
        self.evidence.motors(self.now)
    }

    /// Whether the drone is taken to be in the air: a take-off was sent or the motors turn, and no standstill was seen.
    #[must_use]
    pub fn may_be_flying(&self) -> bool {
        self.guard.is_flying()
    }

    /// The latched alarm.
    #[must_use]
    pub fn alarm(&self) -> Option<Alarm> {
        self.guard.latched()
    }

    /// Whether nothing was heard for [`SessionConfig::link_timeout`].
    #[must_use]
    pub fn link_is_lost(&self) -> bool {
        self.link_lost
    }

    /// Whether no request waits, is in flight or is repeated.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.queue.is_empty() && self.exchange.is_none() && self.urgent.is_none()
    }

    /// What was and was not attributed.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// The configuration.
    #[must_use]
    pub fn config(&self) -> &SessionConfig {
        &self.config
    }

    fn send(&mut self, command: &Command) {
        self.counters.sent += 1;
        self.last_sent = Some(self.now);
        self.outputs
            .push_back(Output::Send(command.to_string().into_bytes()));
    }

    fn emit(&mut self, event: Event) {
        self.outputs.push_back(Output::Event(event));
    }

    fn finish(&mut self, id: Option<RequestId>, command: Command, outcome: Outcome) {
        if let Some(id) = id {
            self.emit(Event::Finished {
                id,
                command,
                outcome,
            });
        }
    }
}
