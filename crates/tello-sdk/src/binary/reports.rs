//! What an emulated drone of the binary protocol tells by itself: flight data, and log records once their header is
//! acknowledged. Rates and the lateness of the odometry are those of TelloPy's published timing notes.

use super::emulated::{BinaryEmulator, PERIOD};
use super::flight_data::FlightData;
use super::frame::Frame;
use super::log::{LogRecord, RecordKind, encode_record};
use super::message::Message;
use crate::emulator::{Lane, Physics};
use alloc::vec::Vec;
use core::time::Duration;

/// Ticks per second of the drone's counter.
const TICK_RATE: f64 = 2.344e6;
/// The odometry is late by 0.2 to 0.9 s, drifting there and back in this time.
const LATENESS: (f64, f64) = (0.2, 0.7);
const LATENESS_PERIOD: f64 = 8.0;

impl<P: Physics> BinaryEmulator<P> {
    /// Everything of one period.
    pub(super) fn report(&mut self) {
        if self.client.is_none() {
            return;
        }
        let data = self.flight_data();
        self.message(Message::FlightData, &data.encode(), Duration::ZERO);
        self.message(Message::Wifi, &[90, 0], Duration::ZERO);
        let dark = u8::from(self.config.faults.is_blind(self.now));
        self.message(Message::Light, &[dark], Duration::ZERO);
        if !self.log_acknowledged {
            let header = [&[0x34, 0x12][..], &[0; 60]].concat();
            return self.message(Message::LogHeader, &header, Duration::ZERO);
        }
        let mut records = [self.imu(), self.gyro(PERIOD / 2), self.gyro(Duration::ZERO)].concat();
        let periods = self.now.as_millis() / PERIOD.as_millis();
        if periods.is_multiple_of(2) {
            records.extend(self.tof());
        }
        self.message(
            Message::LogData,
            &[&[0][..], &records].concat(),
            Duration::ZERO,
        );
        let odometry = [&[0][..], &self.odometry()].concat();
        let phase = self.now.as_secs_f64() % LATENESS_PERIOD / LATENESS_PERIOD * 2.0;
        let late = LATENESS.0 + LATENESS.1 * phase.min(2.0 - phase);
        self.message(
            Message::LogData,
            &odometry,
            Duration::from_millis((late * 1e3) as u64),
        );
    }

    fn flight_data(&self) -> FlightData {
        let truth = self.body.physics.truth();
        let tenths = |value: f64| (value * 10.0) as i16;
        let blind = self.config.faults.is_blind(self.now);
        let velocity = if blind { [0.0; 3] } else { truth.velocity };
        let [low, lower] = [20.0, 10.0].map(|limit| u8::from(self.body.battery < limit));
        let flies = if truth.motors { 1 } else { 2 };
        let left = self.body.battery / self.config.drain.max(1e-3) * 60.0;
        FlightData {
            height_dm: if truth.motors {
                tenths(truth.height - self.height_offset)
            } else {
                0
            },
            north_speed: tenths(velocity[0]),
            east_speed: tenths(-velocity[1]),
            ground_speed: tenths(velocity[2]),
            fly_time: self.body.motor_time.as_secs() as i16,
            state_bits: u8::from(self.now < self.config.faults.imu_invalid_until)
                | u8::from(blind) << 2,
            battery_percent: self.body.battery as u8,
            fly_time_left: (left * 10.0) as i16,
            flight_bits: flies | low << 5 | lower << 6,
            fly_mode: if truth.motors { 6 } else { 1 },
            is_hot: self.body.temperature(&self.config) > self.config.max_temperature,
            ..FlightData::default()
        }
    }

    fn message(&mut self, message: Message, payload: &[u8], late: Duration) {
        let frame = Frame {
            kind: 0x88,
            message: message as u16,
            sequence: 0,
            payload,
        };
        self.push(Lane::State, frame.encode(), late);
    }

    fn tick(&self, ago: Duration) -> u32 {
        (self.now.saturating_sub(ago).as_secs_f64() * TICK_RATE) as u64 as u32
    }

    fn record(&self, kind: RecordKind, ago: Duration, payload: Vec<u8>) -> Vec<u8> {
        let tick = self.tick(ago);
        encode_record(&LogRecord {
            kind,
            tick,
            payload,
        })
    }

    fn imu(&self) -> Vec<u8> {
        let truth = self.body.physics.truth();
        let mut payload = alloc::vec![0_u8; 108];
        put(&mut payload, 20, &truth.acceleration.map(|a| a / 9.806_65));
        put(&mut payload, 48, &quaternion(truth.attitude_deg));
        self.record(RecordKind::Imu, Duration::ZERO, payload)
    }

    /// The model of movement has no rates: a drone that does not turn.
    fn gyro(&self, ago: Duration) -> Vec<u8> {
        self.record(RecordKind::Gyro, ago, alloc::vec![0_u8; 37])
    }

    fn tof(&self) -> Vec<u8> {
        let millimeters = (self.body.physics.truth().ground_distance * 1e3) as i16;
        self.record(
            RecordKind::Tof,
            Duration::ZERO,
            millimeters.to_le_bytes().to_vec(),
        )
    }

    fn odometry(&mut self) -> Vec<u8> {
        if self.random.chance(self.config.faults.odometry_jump) {
            self.jump = [0; 3].map(|_: u8| 600.0 * self.random.unit() - 300.0);
        }
        let truth = self.body.physics.truth();
        let valid = truth.motors && !self.config.faults.is_blind(self.now);
        let velocity = if valid { truth.velocity } else { [0.0; 3] };
        let mut payload = alloc::vec![0_u8; 80];
        for (slot, speed) in payload[2..8].chunks_exact_mut(2).zip(velocity) {
            slot.copy_from_slice(&((speed * 100.0) as i16).to_le_bytes());
        }
        let position = [0, 1, 2].map(|axis| truth.position[axis] + self.jump[axis]);
        put(&mut payload, 8, &position);
        payload[76] = if valid { 0x77 } else { 0 };
        self.record(RecordKind::Odometry, Duration::ZERO, payload)
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

/// w, x, y, z of pitch, roll and yaw in degrees, rotation order z, y, x; without the standard library the level attitude.
fn quaternion(attitude_deg: [f64; 3]) -> [f64; 4] {
    #[cfg(feature = "std")]
    {
        let [(sp, cp), (sr, cr), (sy, cy)] =
            attitude_deg.map(|angle| (angle.to_radians() / 2.0).sin_cos());
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    }
    #[cfg(not(feature = "std"))]
    {
        let _ = attitude_deg;
        [1.0, 0.0, 0.0, 0.0]
    }
}
