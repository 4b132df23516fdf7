//! The drone's side of the binary protocol without sockets or clocks: handshake, acknowledgements, sticks, video.
//!
//! The same body, link, camera and faults as the text protocol's [`Emulator`](crate::emulator::Emulator), the same calls. What is not known of real drones is assumed: a
//! command that is not carried out is acknowledged all the same.

use super::frame::Frame;
use super::message::Message;
use super::sticks::decode_sticks;
use crate::command::{Class, Command};
use crate::emulator::random::Random;
use crate::emulator::{
    Action, Body, Camera, Channel, Departure, Device, EmulatorConfig, Lane, Link, Physics,
    Progress, Summary, Transmit, VideoSource, loses_parameter_set, pad_to_multiple,
};
use crate::video::numbered_datagrams;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::net::SocketAddr;
use core::time::Duration;

/// One drone.
pub struct BinaryEmulator<P> {
    pub(super) config: EmulatorConfig,
    pub(super) body: Body<P>,
    pub(super) random: Random,
    pub(super) now: Duration,
    pub(super) client: Option<SocketAddr>,
    pub(super) log_acknowledged: bool,
    /// How far the visual odometry has jumped, m.
    pub(super) jump: [f64; 3],
    pub(super) height_offset: f64,
    link: Link,
    camera: Camera,
    video_port: u16,
    frame: u8,
    target: Duration,
    busy: bool,
    landing: bool,
    took_off: Duration,
    last_command: Duration,
    next_report: Duration,
    commands: usize,
    received: Vec<u16>,
}

/// Period of flight data and of attitude records.
pub(super) const PERIOD: Duration = Duration::from_millis(100);
/// Bound of [`BinaryEmulator::received`].
const LOG_LIMIT: usize = 4096;
/// Where video goes when the connection request names no port.
const VIDEO_PORT: u16 = 6038;

impl<P: Physics> BinaryEmulator<P> {
    /// A drone at power-on, on the ground. Version, ports and state period of the configuration belong to the text
    /// protocol and are not used.
    pub fn new(config: EmulatorConfig, physics: P) -> Self {
        Self {
            random: Random::new(config.seed),
            body: Body::new(physics, config.battery),
            now: Duration::ZERO,
            client: None,
            log_acknowledged: false,
            jump: [0.0; 3],
            height_offset: 0.0,
            link: Link::default(),
            camera: Camera::default(),
            video_port: VIDEO_PORT,
            frame: 0,
            target: Duration::ZERO,
            busy: false,
            landing: false,
            took_off: Duration::ZERO,
            last_command: Duration::ZERO,
            next_report: Duration::ZERO,
            commands: 0,
            received: Vec::new(),
            config,
        }
    }

    /// Gives it a camera.
    #[must_use]
    pub fn with_video(mut self, source: Box<dyn VideoSource>) -> Self {
        self.camera.source = Some(source);
        self
    }

    /// A datagram arrives at the drone's end of the link at `at`.
    pub fn receive(&mut self, at: Duration, from: SocketAddr, bytes: &[u8]) {
        self.run_to(at);
        let (timing, faults) = (&self.config.timing, &self.config.faults);
        self.link
            .accept(self.now, timing, faults, &mut self.random, from, bytes);
    }

    /// The next datagram for the client by `now`; `None` until [`BinaryEmulator::next_deadline`].
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

    /// Numbers of the messages received other than sticks, the first 4096.
    #[must_use]
    pub fn received(&self) -> &[u16] {
        &self.received
    }

    /// Whether the motors turn.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.body.physics.truth().motors
    }

    /// The model of movement.
    #[must_use]
    pub fn physics(&self) -> &P {
        &self.body.physics
    }

    fn next_event(&self) -> Duration {
        let others = [
            self.link.next_arrival(),
            self.camera.next,
            self.body.next_step(self.busy),
        ];
        others
            .into_iter()
            .flatten()
            .fold(self.next_report, Duration::min)
    }

    /// Lets everything up to `now` happen in the order of time.
    fn run_to(&mut self, now: Duration) {
        self.target = self.target.max(now);
        while self.next_event() <= now {
            let at = self.next_event();
            self.step_to(at);
            while let Some(packet) = self.link.arrived(at) {
                self.obey(packet.from, &packet.bytes);
            }
        }
        self.now = self.now.max(now);
    }

    fn step_to(&mut self, at: Duration) {
        self.now = self.now.max(at);
        self.body.advance(at, &self.config);
        match self.body.physics.progress() {
            Progress::Running => self.busy = true,
            Progress::Idle => self.busy = false,
            Progress::Ended(_) => {
                (self.busy, self.landing) = (false, false);
                self.body.lands_itself = false;
            }
        }
        let silence = self.now.saturating_sub(self.last_command);
        if !self.landing {
            self.body.land_by_itself(silence, self.busy, &self.config);
        }
        if self.next_report <= at {
            self.next_report = at + PERIOD;
            self.report();
        }
        self.send_video(at);
    }

    fn obey(&mut self, from: SocketAddr, bytes: &[u8]) {
        self.last_command = self.now;
        if bytes.starts_with(b"conn_req:") {
            let port = bytes.get(9..).and_then(|port| port.first_chunk::<2>());
            self.video_port = port.map_or(VIDEO_PORT, |port| u16::from_le_bytes(*port));
            self.client = Some(from);
            let answer = [&b"conn_ack:"[..], &self.video_port.to_le_bytes()].concat();
            self.push(Lane::Reply, answer, Duration::ZERO);
        } else if let Ok(frame) = Frame::parse(bytes) {
            self.obey_frame(&frame);
        } else if let Some(Ok(command)) = core::str::from_utf8(bytes).ok().map(Command::parse) {
            self.obey_text(&command);
        }
    }

    /// Apps send some commands as plain text also here; they are not answered.
    fn obey_text(&mut self, command: &Command) {
        self.commands += 1;
        if *command == Command::Emergency {
            (self.busy, self.landing) = (false, false);
            let _ = self.body.physics.begin(self.now, Action::CutMotors);
        } else if let (Class::Motion, Some(action)) = (
            command.class(),
            Action::of(command, self.config.timing.speed),
        ) {
            self.begin(action);
        }
    }

    fn obey_frame(&mut self, frame: &Frame<'_>) {
        let is = |message: Message| frame.message == message as u16;
        if is(Message::Sticks) {
            if let (Some((sticks, _)), false) = (decode_sticks(frame.payload), self.busy) {
                self.body.physics.set_sticks(self.now, sticks);
            }
            return;
        }
        self.commands += 1;
        if self.received.len() < LOG_LIMIT {
            self.received.push(frame.message);
        }
        if is(Message::LogHeader) {
            self.log_acknowledged = true;
            return;
        }
        if is(Message::VideoStart) {
            self.camera.start(self.now);
        }
        let action = if is(Message::TakeOff) || is(Message::ThrowAndGo) {
            Some(Action::TakeOff)
        } else if is(Message::Land) || is(Message::PalmLand) {
            Some(Action::Land)
        } else if is(Message::Flip) {
            Some(Action::Flip)
        } else {
            None
        };
        if let Some(action) = action {
            self.begin(action);
        }
        self.acknowledge(frame);
    }

    fn acknowledge(&mut self, frame: &Frame<'_>) {
        let faults = &self.config.faults;
        let (silent, late) = (faults.unanswered, (faults.late, faults.late_by));
        if self.random.chance(silent) {
            return;
        }
        let late = if self.random.chance(late.0) {
            late.1
        } else {
            Duration::ZERO
        };
        let answer = Frame {
            kind: 0xB0,
            payload: &[0],
            ..*frame
        };
        self.push(Lane::Reply, answer.encode(), late);
    }

    fn begin(&mut self, action: Action) {
        let faults = &self.config.faults;
        if action == Action::Land {
            // A repeated landing does not begin anew.
            let deaf = self.now < self.took_off + faults.deaf_to_land;
            if self.landing || self.body.lands_itself || deaf {
                return;
            }
        } else {
            let blind = self.now < faults.imu_invalid_until || faults.is_blind(self.now);
            let unfit = action == Action::TakeOff && self.body.is_unfit(&self.config);
            let refusal = faults.refusal;
            if blind || unfit || self.busy || self.random.chance(refusal) {
                return;
            }
        }
        if self.body.physics.begin(self.now, action).is_ok() {
            (self.busy, self.landing) = (true, action == Action::Land);
            if action == Action::TakeOff {
                self.took_off = self.now;
                self.height_offset = 0.35 * self.random.unit();
            }
        }
    }

    fn send_video(&mut self, at: Duration) {
        let Some(client) = self.client else { return };
        let Some(mut unit) = self.camera.shoot(at, self.target) else {
            return;
        };
        if self.random.chance(self.config.faults.exact_multiples) {
            pad_to_multiple(&mut unit);
        }
        let to = SocketAddr::new(client.ip(), self.video_port);
        for datagram in numbered_datagrams(&unit, self.frame) {
            let payload = datagram.get(2..).unwrap_or_default();
            if !loses_parameter_set(payload, &self.config.faults, &mut self.random) {
                self.push_to(to, Channel::Video, Lane::Video, datagram, Duration::ZERO);
            }
        }
        self.frame = self.frame.wrapping_add(1);
    }

    pub(super) fn push(&mut self, lane: Lane, bytes: Vec<u8>, late: Duration) {
        if let Some(client) = self.client {
            self.push_to(client, Channel::Reply, lane, bytes, late);
        }
    }

    fn push_to(
        &mut self,
        to: SocketAddr,
        channel: Channel,
        lane: Lane,
        bytes: Vec<u8>,
        late: Duration,
    ) {
        let departure = Departure {
            lane,
            transmit: Transmit::new(channel, to, bytes),
            late,
            prompt: false,
        };
        let (timing, faults) = (&self.config.timing, &self.config.faults);
        self.link
            .send(self.now, timing, faults, &mut self.random, departure);
    }
}

impl<P: Physics> Device for BinaryEmulator<P> {
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
            commands: self.commands,
            pictures: self.camera.units,
            battery: self.body.battery,
            flying: self.is_flying(),
        }
    }
}
