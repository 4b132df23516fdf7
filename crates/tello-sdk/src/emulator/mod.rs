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
mod body;
mod camera;
mod config;
mod faults;
#[cfg(feature = "std")]
mod kinematic;
mod link;
mod obey;
mod pads;
mod physics;
mod presets;
pub(crate) mod random;
mod sensors;
#[cfg(feature = "std")]
pub mod udp;

pub use camera::VideoSource;
pub use config::{EmulatorConfig, Timing, WhenBusy};
pub use faults::{Faults, Impairment};
#[cfg(feature = "std")]
pub use kinematic::Kinematic;
pub use pads::FloorPad;
pub use physics::{Action, Physics, Progress, Truth};
pub use presets::PRESETS;

pub(crate) use body::Body;
pub(crate) use camera::{Camera, loses_parameter_set, pad_to_multiple};
pub(crate) use link::{Departure, Lane, Link};

use crate::command::{Command, PadDirection};
use crate::reply::Refusal;
use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
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

/// An emulated drone of either protocol as its sockets see it.
pub trait Device {
    /// A datagram arrives at the drone's end of the link at `at`.
    fn receive(&mut self, at: Duration, from: SocketAddr, bytes: &[u8]);

    /// The next datagram that has left the drone by `now`.
    fn poll(&mut self, now: Duration) -> Option<Transmit>;

    /// When something happens next without input.
    fn next_deadline(&self) -> Duration;

    /// What happened to it so far.
    fn summary(&self) -> Summary;
}

/// What happened to an emulated drone.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Summary {
    /// Commands that reached it.
    pub commands: usize,
    /// Pictures that it took.
    pub pictures: u64,
    /// Charge, percent.
    pub battery: f64,
    /// Whether its motors turn.
    pub flying: bool,
}

/// One drone.
pub struct Emulator<P> {
    config: EmulatorConfig,
    body: Body<P>,
    random: Random,
    now: Duration,
    link: Link,
    client: Option<SocketAddr>,
    running: Option<Running>,
    target: Duration,
    next_state: Duration,
    camera: Camera,
    last_command: Duration,
    took_off: Duration,
    speed: f64,
    height_offset: f64,
    looks_for_pads: bool,
    pad_direction: PadDirection,
    log: Vec<Received>,
    arrived: usize,
    answering: Option<usize>,
    answers_doubled: bool,
    refused_at: Option<(Refusal, Duration)>,
}

/// The command that is being carried out.
struct Running {
    command: Command,
    reply_to: SocketAddr,
    index: Option<usize>,
    /// The turn of a jump.
    is_second_part: bool,
}

/// Bound of [`Emulator::log`].
const LOG_LIMIT: usize = 4096;

impl<P: Physics> Emulator<P> {
    /// A drone at power-on, on the ground.
    pub fn new(config: EmulatorConfig, physics: P) -> Self {
        Self {
            random: Random::new(config.seed),
            body: Body::new(physics, config.battery),
            now: Duration::ZERO,
            link: Link::default(),
            client: None,
            running: None,
            target: Duration::ZERO,
            next_state: Duration::ZERO,
            camera: Camera::default(),
            last_command: Duration::ZERO,
            took_off: Duration::ZERO,
            speed: config.timing.speed,
            height_offset: 0.0,
            looks_for_pads: false,
            pad_direction: PadDirection::Down,
            log: Vec::new(),
            arrived: 0,
            answering: None,
            answers_doubled: false,
            refused_at: None,
            config,
        }
    }

    /// Gives it a camera.
    #[must_use]
    pub fn with_video(mut self, source: Box<dyn VideoSource>) -> Self {
        self.camera.source = Some(source);
        self
    }

    /// A datagram arrives at the drone's end of the link at `at` (the link's delay and faults come on top).
    pub fn receive(&mut self, at: Duration, from: SocketAddr, bytes: &[u8]) {
        self.run_to(at);
        let (timing, faults) = (&self.config.timing, &self.config.faults);
        self.link
            .accept(self.now, timing, faults, &mut self.random, from, bytes);
    }

    /// The next datagram that has left the drone by `now`; `None` until [`Emulator::next_deadline`].
    pub fn poll(&mut self, now: Duration) -> Option<Transmit> {
        self.run_to(now);
        self.link.delivered(self.now)
    }

    /// When something happens next without input.
    #[must_use]
    pub fn next_deadline(&self) -> Duration {
        let sent = self.link.next_delivery().unwrap_or(Duration::MAX);
        self.next_event().min(sent)
    }

    /// The commands that reached the drone, the first 4096 of them.
    #[must_use]
    pub fn log(&self) -> &[Received] {
        &self.log
    }

    /// The model of movement.
    #[must_use]
    pub fn physics(&self) -> &P {
        &self.body.physics
    }

    /// The model of movement, to change the world under the drone.
    pub fn physics_mut(&mut self) -> &mut P {
        &mut self.body.physics
    }

    /// Charge, percent.
    #[must_use]
    pub fn battery(&self) -> f64 {
        self.body.battery
    }

    /// Whether the motors turn.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.body.physics.truth().motors
    }

    /// How many commands reached the drone.
    #[must_use]
    pub fn commands(&self) -> usize {
        self.arrived
    }

    /// How many pictures were taken.
    #[must_use]
    pub fn pictures(&self) -> u64 {
        self.camera.units
    }

    fn next_step(&self) -> Duration {
        let step = self.body.next_step(self.running.is_some());
        let video = self.camera.next.unwrap_or(Duration::MAX);
        step.unwrap_or(Duration::MAX)
            .min(self.next_state)
            .min(video)
    }

    /// Lets everything up to `now` happen in the order of time.
    fn run_to(&mut self, now: Duration) {
        self.target = self.target.max(now);
        while self.next_event() <= now {
            let at = self.next_event();
            self.step_to(at);
            while let Some(packet) = self.link.arrived(at) {
                self.obey(packet);
            }
        }
        self.now = self.now.max(now);
    }

    fn next_event(&self) -> Duration {
        let arrival = self.link.next_arrival().unwrap_or(Duration::MAX);
        arrival.min(self.next_step())
    }

    fn step_to(&mut self, at: Duration) {
        self.now = self.now.max(at);
        self.body.advance(at, &self.config);
        self.end_of_action();
        self.land_by_itself();
        if self.next_state <= at {
            self.next_state = at + self.config.state_period.max(Duration::from_millis(1));
            self.send_state();
        }
        self.send_video(at);
    }

    fn end_of_action(&mut self) {
        let Progress::Ended(mut result) = self.body.physics.progress() else {
            return;
        };
        self.body.lands_itself = false;
        let Some(mut done) = self.running.take() else {
            return;
        };
        if let (Command::Jump { .. }, Ok(()), false) = (&done.command, result, done.is_second_part)
        {
            let begun = self.second_part(&done.command).map(|action| {
                done.is_second_part = true;
                self.body.physics.begin(self.now, action)
            });
            if begun == Some(Ok(())) {
                self.running = Some(done);
                return;
            }
            result = Err(Refusal::NotValidMarker);
        }
        if done.command == Command::TakeOff {
            self.took_off = self.now;
        }
        self.answering = done.index;
        self.answer_motion(done.reply_to, result);
        self.answering = None;
    }

    fn land_by_itself(&mut self) {
        let runs = |running: &Running| running.command == Command::Land;
        if self.running.as_ref().is_some_and(runs) {
            return;
        }
        let silence = self.now.saturating_sub(self.last_command);
        let busy = self.running.is_some();
        if self.body.land_by_itself(silence, busy, &self.config) {
            self.running = None;
        }
    }
}

impl<P: Physics> Device for Emulator<P> {
    fn receive(&mut self, at: Duration, from: SocketAddr, bytes: &[u8]) {
        Self::receive(self, at, from, bytes);
    }

    fn poll(&mut self, now: Duration) -> Option<Transmit> {
        Self::poll(self, now)
    }

    fn next_deadline(&self) -> Duration {
        Self::next_deadline(self)
    }

    fn summary(&self) -> Summary {
        Summary {
            commands: self.arrived,
            pictures: self.camera.units,
            battery: self.body.battery,
            flying: self.is_flying(),
        }
    }
}
