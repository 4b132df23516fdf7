//! The drone's side of the binary protocol without sockets or clocks: handshake, acknowledgements, flight data at 10 Hz,
//! log records once the header is acknowledged.

use super::flight_data::FlightData;
use super::frame::Frame;
use super::log::{LogRecord, RecordKind, encode_record};
use super::message::Message;
use super::sticks::decode_sticks;
use crate::emulator::{Action, Physics, Progress};
use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::time::Duration;

/// One drone.
#[derive(Debug)]
pub struct BinaryEmulator<P> {
    physics: P,
    now: Duration,
    connected: bool,
    log_acknowledged: bool,
    landing: bool,
    next: Duration,
    tick: u64,
    battery: f64,
    outbox: VecDeque<Vec<u8>>,
    received: Vec<u16>,
}

/// Period of flight data and of attitude records.
const PERIOD: Duration = Duration::from_millis(100);
/// Datagrams that wait at most.
const OUTBOX: usize = 1024;
/// Bound of [`BinaryEmulator::received`].
const LOG_LIMIT: usize = 4096;

impl<P: Physics> BinaryEmulator<P> {
    /// A drone at power-on.
    pub fn new(physics: P) -> Self {
        Self {
            physics,
            now: Duration::ZERO,
            connected: false,
            log_acknowledged: false,
            landing: false,
            next: Duration::ZERO,
            tick: 0,
            battery: 87.0,
            outbox: VecDeque::new(),
            received: Vec::new(),
        }
    }

    /// Takes in a datagram.
    pub fn receive(&mut self, at: Duration, bytes: &[u8]) {
        self.run_to(at);
        if bytes.starts_with(b"conn_req:") {
            self.connected = true;
            let port = bytes.get(9..11).unwrap_or(&[0x96, 0x17]);
            self.push([&b"conn_ack:"[..], port].concat());
        } else if bytes == b"emergency" {
            let _ = self.physics.begin(self.now, Action::CutMotors);
        } else if let Ok(frame) = Frame::parse(bytes) {
            self.obey(&frame);
        }
    }

    /// The next datagram for the client; `None` until [`BinaryEmulator::next_deadline`].
    pub fn poll(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.run_to(now);
        self.outbox.pop_front()
    }

    /// When something happens next without input.
    #[must_use]
    pub fn next_deadline(&self) -> Duration {
        if self.outbox.is_empty() {
            self.next
        } else {
            self.now
        }
    }

    /// Numbers of the messages received other than sticks, the first 4096.
    #[must_use]
    pub fn received(&self) -> &[u16] {
        &self.received
    }

    /// Whether the motors turn.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.physics.truth().motors
    }

    fn obey(&mut self, frame: &Frame<'_>) {
        let is = |message: Message| frame.message == message as u16;
        if is(Message::Sticks) {
            if let (Some((sticks, _)), Progress::Idle) =
                (decode_sticks(frame.payload), self.physics.progress())
            {
                self.physics.set_sticks(self.now, sticks);
            }
            return;
        }
        if self.received.len() < LOG_LIMIT {
            self.received.push(frame.message);
        }
        if is(Message::LogHeader) {
            self.log_acknowledged = true;
            return;
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
            // A repeated landing does not begin anew.
            let busy = self.physics.progress() == Progress::Running;
            if !busy || (action == Action::Land && !self.landing) {
                self.landing = action == Action::Land;
                let _ = self.physics.begin(self.now, action);
            }
        }
        let answer = Frame {
            kind: 0xB0,
            payload: &[0],
            ..*frame
        };
        self.push(answer.encode());
    }

    fn run_to(&mut self, now: Duration) {
        while self.next <= now {
            self.now = self.next;
            self.next += PERIOD;
            self.physics.advance(self.now);
            self.tick += 234_400;
            if self.physics.truth().motors {
                self.battery = (self.battery - 7.7 * PERIOD.as_secs_f64() / 60.0).max(0.0);
            }
            if self.connected {
                self.report();
            }
        }
        self.now = self.now.max(now);
        self.physics.advance(self.now);
    }

    fn report(&mut self) {
        let truth = self.physics.truth();
        let tenths = |value: f64| (value * 10.0) as i16;
        let data = FlightData {
            height_dm: tenths(truth.height),
            north_speed: tenths(truth.velocity[0]),
            east_speed: tenths(-truth.velocity[1]),
            battery_percent: self.battery as u8,
            flight_bits: if truth.motors { 1 } else { 2 },
            fly_mode: if truth.motors { 6 } else { 1 },
            ..FlightData::default()
        };
        self.message(Message::FlightData, &data.encode());
        self.message(Message::Wifi, &[90, 0]);
        self.message(Message::Light, &[0]);
        if self.log_acknowledged {
            let records = [self.imu(), self.odometry()].concat();
            self.message(Message::LogData, &[&[0][..], &records].concat());
        } else {
            self.message(Message::LogHeader, &[&[0x34, 0x12][..], &[0; 60]].concat());
        }
    }

    fn message(&mut self, message: Message, payload: &[u8]) {
        let frame = Frame {
            kind: 0x88,
            message: message as u16,
            sequence: 0,
            payload,
        };
        self.push(frame.encode());
    }

    fn push(&mut self, bytes: Vec<u8>) {
        if self.outbox.len() < OUTBOX {
            self.outbox.push_back(bytes);
        }
    }

    fn imu(&self) -> Vec<u8> {
        let truth = self.physics.truth();
        let mut payload = alloc::vec![0_u8; 108];
        put(&mut payload, 20, &truth.acceleration.map(|a| a / 9.806_65));
        put(&mut payload, 48, &yaw_quaternion(truth.attitude_deg[2]));
        encode_record(&LogRecord {
            kind: RecordKind::Imu,
            tick: self.tick as u32,
            payload,
        })
    }

    fn odometry(&self) -> Vec<u8> {
        let truth = self.physics.truth();
        let mut payload = alloc::vec![0_u8; 80];
        for (index, speed) in truth.velocity.iter().enumerate() {
            let word = ((speed * 100.0) as i16).to_le_bytes();
            payload[2 + 2 * index..4 + 2 * index].copy_from_slice(&word);
        }
        put(&mut payload, 8, &truth.position);
        payload[76] = if truth.motors { 0x77 } else { 0 };
        encode_record(&LogRecord {
            kind: RecordKind::Odometry,
            tick: self.tick as u32,
            payload,
        })
    }
}

fn put(payload: &mut [u8], at: usize, values: &[f64]) {
    for (slot, value) in payload
        .get_mut(at..)
        .unwrap_or_default()
        .chunks_exact_mut(4)
        .zip(values)
    {
        slot.copy_from_slice(&(*value as f32).to_le_bytes());
    }
}

/// w, x, y, z of a heading; without the standard library the level attitude.
fn yaw_quaternion(degrees: f64) -> [f64; 4] {
    #[cfg(feature = "std")]
    {
        let (sin, cos) = (degrees.to_radians() / 2.0).sin_cos();
        [cos, 0.0, 0.0, sin]
    }
    #[cfg(not(feature = "std"))]
    {
        let _ = degrees;
        [1.0, 0.0, 0.0, 0.0]
    }
}
