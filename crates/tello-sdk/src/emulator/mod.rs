//! The drone side of the text protocol without sockets or clocks: bytes and time in, datagrams out.
//!
//! Call [`Emulator::receive`] with each datagram of the command port and [`Emulator::poll`] until it returns `None`,
//! then wait until [`Emulator::next_deadline`]. The movement comes from a [`Physics`] (here [`Kinematic`]; a simulator
//! brings its own), the times from [`Timing`], what goes wrong from [`Faults`]; with the same seed and inputs the
//! output is the same to the byte.
//!
//! What is not known of real drones is assumed and said so: queries are answered while a move runs, an interrupted
//! move is not answered.

mod answers;
mod channel;
mod config;
mod faults;
#[cfg(feature = "std")]
mod kinematic;
mod obey;
mod physics;
pub(crate) mod random;
mod sensors;
#[cfg(feature = "std")]
pub mod udp;

pub use config::{EmulatorConfig, Timing, WhenBusy};
pub use faults::{Faults, Impairment};
#[cfg(feature = "std")]
pub use kinematic::Kinematic;
pub use physics::{Action, Physics, Progress, Truth};

use crate::command::Command;
use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;
use channel::Channels;
use core::net::SocketAddr;
use core::time::Duration;
use random::Random;

/// Which of the drone's sockets a datagram leaves from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Channel {
    /// The command socket.
    Reply,
    /// Any other port of the drone (a fault).
    ReplyFromOtherPort,
    /// The state socket.
    State,
    /// The video socket.
    Video,
}

/// A datagram that leaves the drone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transmit {
    /// From which socket.
    pub channel: Channel,
    /// To whom.
    pub to: SocketAddr,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// Which command it answers: the place in the order of arrival, from 0 (for tests; the wire does not tell).
    pub answers: Option<usize>,
}

/// A command as it reached the drone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Received {
    /// When.
    pub at: Duration,
    /// Its text.
    pub text: String,
    /// Whether it is the second copy of a datagram that the link doubled.
    pub is_copy: bool,
}

/// Where the pictures come from: access units in Annex B byte-stream format, one per call.
pub trait VideoSource: Send {
    /// The next access unit, or `None` to skip this frame. Called every [`VideoSource::period`].
    fn next_unit(&mut self, now: Duration) -> Option<Vec<u8>>;

    /// Time between frames.
    fn period(&self) -> Duration {
        Duration::from_nanos(33_333_333)
    }
}

/// One drone.
pub struct Emulator<P> {
    config: EmulatorConfig,
    physics: P,
    random: Random,
    now: Duration,
    channels: Channels,
    downlink: BTreeMap<(Duration, u64), Transmit>,
    client: Option<SocketAddr>,
    running: Option<Running>,
    stepped: Duration,
    target: Duration,
    next_state: Duration,
    next_video: Option<Duration>,
    video: Option<Box<dyn VideoSource>>,
    last_command: Duration,
    took_off: Duration,
    lands_itself: bool,
    battery: f64,
    motor_time: Duration,
    speed: f64,
    height_offset: f64,
    log: Vec<Received>,
    arrived: usize,
    answering: Option<usize>,
    answers_doubled: bool,
    refused_at: Option<(crate::reply::Refusal, Duration)>,
}

/// The command that is being carried out.
struct Running {
    command: Command,
    reply_to: SocketAddr,
    index: Option<usize>,
}

/// Bound of [`Emulator::log`].
const LOG_LIMIT: usize = 4096;
/// Step of the movement while something runs.
const STEP: Duration = Duration::from_millis(20);

impl<P: Physics> Emulator<P> {
    /// A drone at power-on, on the ground.
    pub fn new(config: EmulatorConfig, physics: P) -> Self {
        Self {
            random: Random::new(config.seed),
            now: Duration::ZERO,
            channels: Channels::default(),
            downlink: BTreeMap::new(),
            client: None,
            running: None,
            stepped: Duration::ZERO,
            target: Duration::ZERO,
            next_state: Duration::ZERO,
            next_video: None,
            video: None,
            last_command: Duration::ZERO,
            took_off: Duration::ZERO,
            lands_itself: false,
            battery: config.battery,
            motor_time: Duration::ZERO,
            speed: config.timing.speed,
            height_offset: 0.0,
            log: Vec::new(),
            arrived: 0,
            answering: None,
            answers_doubled: false,
            refused_at: None,
            physics,
            config,
        }
    }

    /// Gives it a camera.
    #[must_use]
    pub fn with_video(mut self, source: Box<dyn VideoSource>) -> Self {
        self.video = Some(source);
        self
    }

    /// A datagram arrives at the drone's end of the link at `at` (the link's delay and faults come on top).
    pub fn receive(&mut self, at: Duration, from: SocketAddr, bytes: &[u8]) {
        self.run_to(at);
        if self.config.faults.is_gap(self.now) {
            return;
        }
        let latency = self.config.timing.one_way(self.random.unit());
        let link = self.config.faults.commands;
        self.channels
            .accept(self.now, latency, &link, &mut self.random, from, bytes);
    }

    /// The next datagram that has left the drone by `now`; `None` until [`Emulator::next_deadline`].
    pub fn poll(&mut self, now: Duration) -> Option<Transmit> {
        self.run_to(now);
        let first = self.downlink.first_entry()?;
        (first.key().0 <= self.now).then(|| first.remove())
    }

    /// When something happens next without input.
    #[must_use]
    pub fn next_deadline(&self) -> Duration {
        let sent = self.downlink.first_key_value().map(|(&(at, _), _)| at);
        let arrives = self.channels.next_arrival();
        [Some(self.next_step()), sent, arrives]
            .into_iter()
            .flatten()
            .min()
            .unwrap_or(Duration::MAX)
    }

    /// The commands that reached the drone, the first 4096 of them.
    #[must_use]
    pub fn log(&self) -> &[Received] {
        &self.log
    }

    /// The model of movement.
    #[must_use]
    pub fn physics(&self) -> &P {
        &self.physics
    }

    /// The model of movement, to change the world under the drone.
    pub fn physics_mut(&mut self) -> &mut P {
        &mut self.physics
    }

    /// Charge, percent.
    #[must_use]
    pub fn battery(&self) -> f64 {
        self.battery
    }

    /// Whether the motors turn.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.physics.truth().motors
    }

    fn next_step(&self) -> Duration {
        let busy = self.running.is_some() || self.lands_itself;
        let step = if busy {
            self.stepped + STEP
        } else {
            self.next_state
        };
        let video = self.next_video.unwrap_or(Duration::MAX);
        step.min(self.next_state).min(video)
    }

    /// Lets everything up to `now` happen in the order of time.
    fn run_to(&mut self, now: Duration) {
        self.target = self.target.max(now);
        while self.next_event() <= now {
            let at = self.next_event();
            self.step_to(at);
            while let Some(packet) = self.channels.arrived(at) {
                self.obey(packet);
            }
        }
        self.now = self.now.max(now);
    }

    fn next_event(&self) -> Duration {
        self.channels
            .next_arrival()
            .unwrap_or(Duration::MAX)
            .min(self.next_step())
    }

    fn step_to(&mut self, at: Duration) {
        let elapsed = at.saturating_sub(self.stepped);
        self.now = self.now.max(at);
        self.stepped = at;
        self.physics.advance(at);
        if self.physics.truth().motors {
            self.motor_time += elapsed;
            self.battery =
                (self.battery - self.config.drain * elapsed.as_secs_f64() / 60.0).max(0.0);
        }
        self.end_of_action();
        self.land_by_itself();
        if self.next_state <= at {
            self.next_state = at + self.config.state_period.max(Duration::from_millis(1));
            self.send_state();
        }
        if self.next_video.is_some_and(|next| next <= at) {
            self.send_video(at);
        }
    }

    fn end_of_action(&mut self) {
        let Progress::Ended(result) = self.physics.progress() else {
            return;
        };
        self.lands_itself = false;
        let Some(done) = self.running.take() else {
            return;
        };
        if done.command == Command::TakeOff {
            self.took_off = self.now;
        }
        self.answering = done.index;
        self.answer_motion(done.reply_to, result);
        self.answering = None;
    }

    fn land_by_itself(&mut self) {
        if self.lands_itself || !self.physics.truth().motors {
            return;
        }
        let silent = self.now.saturating_sub(self.last_command) >= self.config.auto_land;
        let forced = self
            .config
            .faults
            .auto_land_at
            .is_some_and(|at| (at..at + Duration::from_secs(1)).contains(&self.now));
        let empty = self.battery < self.config.min_battery;
        let lands = self
            .running
            .as_ref()
            .is_some_and(|r| r.command == Command::Land);
        if (silent && self.running.is_none() || forced || empty) && !lands {
            self.running = None;
            self.lands_itself = self.physics.begin(self.now, Action::Land).is_ok();
        }
    }
}
