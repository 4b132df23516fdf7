//! The client's side of the binary protocol without sockets or clocks.
//!
//! Handshake, continuous sticks (the drone needs them), acknowledgement of the log header, commands matched to their
//! acknowledgements by message and sequence number. No command is sent again except `land`, which is repeated until the
//! flight data say that the drone is on the ground. Drain [`BinarySession::poll_output`] after every call.

use super::clock::TickClock;
use super::command::{BinaryCommand, BinaryEvent, BinaryOutput, CommandId, Ending};
use super::config::BinaryConfig;
use super::flight_data::FlightData;
use super::frame::Frame;
use super::landing::{LATEST, Landing};
use super::log::{LogRecord, LogRecords, RecordKind};
use super::message::Message;
use super::sticks::encode_sticks;
use crate::safety::{Alarm, Guard};
use crate::session::Sticks;
use crate::telemetry::{Source, Telemetry};
use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::time::Duration;

#[derive(Debug, Clone, Copy)]
struct Pending {
    id: CommandId,
    command: BinaryCommand,
    sequence: u16,
    deadline: Duration,
}

/// One drone in the binary protocol.
#[derive(Debug, Clone)]
pub struct BinarySession {
    pub(super) config: BinaryConfig,
    pub(super) now: Duration,
    connected: bool,
    next_request: Duration,
    next_sticks: Duration,
    next_video: Option<Duration>,
    heard: Duration,
    pub(super) sticks: Sticks,
    pub(super) sticks_set: Option<Duration>,
    pending: Vec<Pending>,
    pub(super) landing: Option<Landing>,
    sequence: u16,
    next_id: u64,
    pub(super) telemetry: Telemetry,
    clock: TickClock,
    first_attitude: Option<Duration>,
    pub(super) guard: Guard,
    pub(super) lift_off_until: Option<Duration>,
    rejected: u64,
    pub(super) outputs: VecDeque<BinaryOutput>,
}

/// A take-off may take this long to show in the flight data.
const LIFT_OFF: Duration = Duration::from_millis(1500);
/// The odometry's velocity is preferred to that of the flight data while it is younger than this: it is up to 0.9 s late.
const LOG_LASTS: Duration = Duration::from_millis(1500);

/// Commands that wait for an acknowledgement at most; the oldest is given up beyond.
const PENDING: usize = 64;

impl BinarySession {
    /// A session that asks for a connection at once.
    #[must_use]
    pub fn new(config: BinaryConfig) -> Self {
        Self {
            config,
            now: Duration::ZERO,
            connected: false,
            next_request: Duration::ZERO,
            next_sticks: Duration::ZERO,
            next_video: None,
            heard: Duration::ZERO,
            sticks: Sticks::CENTER,
            sticks_set: None,
            pending: Vec::new(),
            landing: None,
            sequence: 0,
            next_id: 0,
            telemetry: Telemetry::default(),
            clock: TickClock::new(),
            first_attitude: None,
            guard: Guard::default(),
            lift_off_until: None,
            rejected: 0,
            outputs: VecDeque::new(),
        }
    }

    /// Sends a command once (`land`: until confirmed); its end comes as an event.
    ///
    /// # Errors
    /// The session has landed on an alarm: only `land` is accepted until it is acknowledged.
    pub fn command(&mut self, now: Duration, command: BinaryCommand) -> Result<CommandId, Alarm> {
        self.now = self.now.max(now.min(LATEST));
        if let (Some(alarm), true) = (self.guard.latched(), command != BinaryCommand::Land) {
            return Err(alarm);
        }
        self.next_id += 1;
        let id = CommandId(self.next_id);
        if command == BinaryCommand::Land {
            self.begin_landing(Some(id));
        } else {
            self.start(id, command);
        }
        self.advance();
        Ok(id)
    }

    /// Accepts commands again after an alarm.
    pub fn acknowledge_alarm(&mut self) {
        self.guard.acknowledge();
    }

    /// The latched alarm.
    #[must_use]
    pub fn alarm(&self) -> Option<Alarm> {
        self.guard.latched()
    }

    /// Whether the drone is taken to be in the air: a take-off was sent or it says so, and no standstill was told since.
    #[must_use]
    pub fn may_be_flying(&self) -> bool {
        self.guard.is_flying()
    }

    /// When the first attitude came from the log.
    #[must_use]
    pub fn first_attitude(&self) -> Option<Duration> {
        self.first_attitude
    }

    /// Sets the sticks; to be repeated within the watchdog's time.
    pub fn set_sticks(&mut self, now: Duration, sticks: Sticks) {
        self.now = self.now.max(now.min(LATEST));
        if self.landing.is_none() {
            self.sticks = sticks;
            self.sticks_set = Some(self.now);
        }
        self.advance();
    }

    /// Asks for video, or no longer.
    pub fn set_video(&mut self, now: Duration, on: bool) {
        self.now = self.now.max(now.min(LATEST));
        self.next_video = on.then_some(self.now);
        self.advance();
    }

    /// Cuts the motors at once: the plain text `emergency`, three times; never answered.
    pub fn emergency(&mut self) {
        for _ in 0..3 {
            self.outputs
                .push_back(BinaryOutput::Send(b"emergency".to_vec()));
        }
    }

    /// Takes in a datagram of the drone's command port.
    pub fn handle_datagram(&mut self, at: Duration, bytes: &[u8]) {
        self.now = self.now.max(at.min(LATEST));
        if bytes.starts_with(b"conn_ack:") {
            self.heard = self.now;
            if !self.connected {
                self.connected = true;
                self.clock = TickClock::new();
                self.next_sticks = self.now;
                self.outputs
                    .push_back(BinaryOutput::Event(BinaryEvent::Connected));
            }
        } else if let Ok(frame) = Frame::parse(bytes) {
            self.heard = self.now;
            self.on_frame(&frame);
        } else {
            self.rejected += 1;
        }
        self.advance();
    }

    /// Lets time pass.
    pub fn handle_timeout(&mut self, now: Duration) {
        self.now = self.now.max(now.min(LATEST));
        self.advance();
    }

    /// What to do next; call until it returns [`BinaryOutput::WaitUntil`].
    pub fn poll_output(&mut self) -> BinaryOutput {
        self.outputs
            .pop_front()
            .unwrap_or_else(|| BinaryOutput::WaitUntil(self.deadline()))
    }

    /// The newest value of each kind.
    #[must_use]
    pub fn telemetry(&self) -> &Telemetry {
        &self.telemetry
    }

    /// Datagrams that were no frame: another protocol, or a wrong checksum.
    #[must_use]
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    fn on_frame(&mut self, frame: &Frame<'_>) {
        let is = |message: Message| frame.message == message as u16;
        if is(Message::FlightData) {
            if let Some(data) = FlightData::parse(frame.payload) {
                self.take_flight_data(&data);
            }
        } else if is(Message::LogHeader) {
            // Without this acknowledgement no log data come.
            let id = frame.payload.get(..2).unwrap_or(&[0, 0]);
            let payload = [&[0][..], id].concat();
            self.send(Message::LogHeader, 0x50, &payload);
        } else if is(Message::LogData) {
            for record in LogRecords::new(frame.payload) {
                self.take_record(&record);
            }
        } else if let Some(index) = self.pending.iter().position(|p| {
            p.sequence == frame.sequence && p.command.frame().0 as u16 == frame.message
        }) {
            let done = self.pending.swap_remove(index);
            self.finish(done.id, done.command, Ending::Acknowledged);
        }
    }

    fn take_flight_data(&mut self, data: &FlightData) {
        let mut sample = data.telemetry(self.now);
        let logged = self.telemetry.velocity.is_some_and(|velocity| {
            velocity.source == Source::Log && velocity.valid && velocity.age(self.now) < LOG_LASTS
        });
        if logged {
            // The odometry's velocity is finer; the two would alternate.
            sample.velocity = None;
        }
        self.take(&sample);
        let lifting = self.lift_off_until.is_some_and(|until| self.now < until);
        if data.is_flying() || !lifting {
            self.guard.motors(self.now, Some(data.is_flying()));
        }
        if data.is_hot && self.guard.is_flying() {
            self.raise(Alarm::Hot);
        }
    }

    /// Each value carries the time at which the drone made it, by the converted counter. The attitude's records set the
    /// clock: they come soonest.
    fn take_record(&mut self, record: &LogRecord) {
        let made = if record.kind == RecordKind::Imu {
            self.clock.observe(record.tick, self.now)
        } else {
            self.clock.convert(record.tick, self.now)
        };
        let Some(at) = made else { return };
        let sample = record.telemetry(at);
        if sample.attitude.is_some() {
            self.first_attitude = self.first_attitude.or(Some(self.now));
        }
        self.take(&sample);
    }

    fn take(&mut self, sample: &Telemetry) {
        self.telemetry.merge(sample);
        self.outputs
            .push_back(BinaryOutput::Event(BinaryEvent::Telemetry));
    }

    fn start(&mut self, id: CommandId, command: BinaryCommand) {
        if self.pending.len() >= PENDING {
            let oldest = self.pending.swap_remove(0);
            self.finish(oldest.id, oldest.command, Ending::Unknown);
        }
        if matches!(command, BinaryCommand::TakeOff | BinaryCommand::ThrowAndGo) {
            self.lift_off_until = Some(self.now + LIFT_OFF);
            self.guard.motors(self.now, Some(true));
        }
        let (message, kind, payload) = command.frame();
        let sequence = self.send(message, kind, &payload);
        let deadline = self.now + self.config.ack_timeout;
        self.pending.push(Pending {
            id,
            command,
            sequence,
            deadline,
        });
    }

    pub(super) fn send(&mut self, message: Message, kind: u8, payload: &[u8]) -> u16 {
        self.sequence = self.sequence.wrapping_add(1);
        let sequence = self.sequence;
        let frame = Frame {
            kind,
            message: message as u16,
            sequence,
            payload,
        };
        self.outputs.push_back(BinaryOutput::Send(frame.encode()));
        sequence
    }

    pub(super) fn finish(&mut self, id: CommandId, command: BinaryCommand, ending: Ending) {
        let event = BinaryEvent::Finished {
            id,
            command,
            ending,
        };
        self.outputs.push_back(BinaryOutput::Event(event));
    }

    pub(super) fn advance(&mut self) {
        let safety = self.config.safety;
        if let Some(alarm) = self
            .guard
            .check(self.now, &safety, &self.telemetry, self.heard)
        {
            self.land_on(alarm);
        }
        self.step_link();
        self.step_pending();
        self.step_landing();
        self.step_sticks();
        if self.connected && self.next_video.is_some_and(|next| next <= self.now) {
            self.send(Message::VideoStart, 0x60, &[]);
            self.next_video = Some(self.now + self.config.video_repeat);
        }
    }

    fn step_link(&mut self) {
        if self.connected && self.heard + self.config.link_timeout <= self.now {
            self.connected = false;
            self.next_request = self.now;
            self.outputs
                .push_back(BinaryOutput::Event(BinaryEvent::Disconnected));
        }
        if !self.connected && self.next_request <= self.now {
            let port = self.config.video_port.to_le_bytes();
            self.outputs
                .push_back(BinaryOutput::Send([&b"conn_req:"[..], &port].concat()));
            self.next_request = self.now + self.config.repeat;
        }
    }

    fn step_pending(&mut self) {
        while let Some(index) = self.pending.iter().position(|p| p.deadline <= self.now) {
            let lost = self.pending.swap_remove(index);
            self.finish(lost.id, lost.command, Ending::Unknown);
        }
    }

    fn step_sticks(&mut self) {
        if self
            .sticks_set
            .is_some_and(|at| at + self.config.stick_watchdog <= self.now)
        {
            self.sticks = Sticks::CENTER;
            self.sticks_set = None;
            self.outputs
                .push_back(BinaryOutput::Event(BinaryEvent::SticksCentered));
        }
        if self.connected && self.next_sticks <= self.now {
            let time = (self.now.as_millis() % 86_400_000) as u32;
            let payload = encode_sticks(self.sticks, false, time);
            let frame = Frame {
                kind: 0x60,
                message: Message::Sticks as u16,
                sequence: 0,
                payload: &payload,
            };
            self.outputs.push_back(BinaryOutput::Send(frame.encode()));
            self.next_sticks = self.now + self.config.stick_period;
        }
    }

    fn deadline(&self) -> Duration {
        let link = if self.connected {
            self.next_sticks.min(self.heard + self.config.link_timeout)
        } else {
            self.next_request
        };
        let watchdog = self.sticks_set.map(|at| at + self.config.stick_watchdog);
        let pending = self.pending.iter().map(|p| p.deadline).min();
        let landing = self.landing.map(|landing| landing.next);
        let video = self.next_video.filter(|_| self.connected);
        let guard = self.guard.deadline(&self.config.safety, self.heard);
        let all = [Some(link), watchdog, pending, landing, video, guard];
        all.into_iter().flatten().min().unwrap_or(Duration::MAX)
    }
}
