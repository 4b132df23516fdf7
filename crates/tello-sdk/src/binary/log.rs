//! Log records: 0x55, length, checksum, kind, tick, a payload XORed with the tick's low byte, and two bytes of CRC.

use crate::telemetry::{Reading, Source, Telemetry, Velocity, VelocityFrame};
use alloc::vec::Vec;
use core::time::Duration;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.806_65;
/// Bytes of a record without payload.
const EMPTY: usize = 12;
/// Longest payload that is read; the longest known has 132 bytes.
const LONGEST: usize = 1024;

/// What a record holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RecordKind {
    /// Visual odometry (29).
    Odometry,
    /// Attitude, rates and accelerations (2048), 10 Hz.
    Imu,
    /// Rates at three stages of filtering (1305), 20 Hz.
    Gyro,
    /// Distance to the ground (16), 5 Hz.
    Tof,
    /// Another.
    Other(u16),
}

impl RecordKind {
    fn number(self) -> u16 {
        match self {
            Self::Odometry => 29,
            Self::Imu => 2048,
            Self::Gyro => 1305,
            Self::Tof => 16,
            Self::Other(number) => number,
        }
    }

    fn from_number(number: u16) -> Self {
        match number {
            29 => Self::Odometry,
            2048 => Self::Imu,
            1305 => Self::Gyro,
            16 => Self::Tof,
            other => Self::Other(other),
        }
    }
}

/// One record with its payload in clear.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogRecord {
    /// What it holds.
    pub kind: RecordKind,
    /// The drone's counter, see [`TickClock`](super::TickClock).
    pub tick: u32,
    /// The content.
    pub payload: Vec<u8>,
}

/// The records of a log-data message's content (behind its first byte), up to the first that is damaged.
#[derive(Debug, Clone)]
pub struct LogRecords<'a> {
    rest: &'a [u8],
}

impl<'a> LogRecords<'a> {
    /// Reads the content of a log-data message.
    #[must_use]
    pub fn new(payload: &'a [u8]) -> Self {
        Self {
            rest: payload.get(1..).unwrap_or_default(),
        }
    }
}

impl Iterator for LogRecords<'_> {
    type Item = LogRecord;

    fn next(&mut self) -> Option<LogRecord> {
        let [0x55, l0, l1, _, k0, k1, t0, t1, t2, t3, ..] = self.rest else {
            return None;
        };
        let length = usize::from(u16::from_le_bytes([*l0, *l1]));
        let payload_length = length
            .checked_sub(EMPTY)
            .filter(|&length| length <= LONGEST)?;
        let payload = self.rest.get(10..10 + payload_length)?;
        let record = LogRecord {
            kind: RecordKind::from_number(u16::from_le_bytes([*k0, *k1])),
            tick: u32::from_le_bytes([*t0, *t1, *t2, *t3]),
            payload: payload.iter().map(|byte| byte ^ t0).collect(),
        };
        self.rest = self.rest.get(length..)?;
        Some(record)
    }
}

/// Writes a record as the drone does, with zero checksums (their rule is not published; readers ignore them).
#[must_use]
pub fn encode_record(record: &LogRecord) -> Vec<u8> {
    let payload = record.payload.get(..LONGEST).unwrap_or(&record.payload);
    let tick = record.tick.to_le_bytes();
    let mut bytes = Vec::with_capacity(payload.len() + EMPTY);
    bytes.push(0x55);
    bytes.extend_from_slice(&((payload.len() + EMPTY) as u16).to_le_bytes());
    bytes.push(0);
    bytes.extend_from_slice(&record.kind.number().to_le_bytes());
    bytes.extend_from_slice(&tick);
    bytes.extend(payload.iter().map(|byte| byte ^ tick[0]));
    bytes.extend_from_slice(&[0, 0]);
    bytes
}

/// Visual odometry, 0.2 to 0.9 s late; jumps when texture or light fails.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Odometry {
    /// Velocity, m/s, the wire's axes.
    pub velocity: [f64; 3],
    /// Position, m, the wire's axes.
    pub position: [f64; 3],
    /// Which components of the velocity are valid.
    pub velocity_valid: [bool; 3],
    /// Which components of the position are valid.
    pub position_valid: [bool; 3],
}

/// Attitude, rates and accelerations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Imu {
    /// Specific force, g.
    pub acceleration_g: [f64; 3],
    /// Angular rate, radians per second.
    pub rate: [f64; 3],
    /// w, x, y, z.
    pub quaternion: [f64; 4],
    /// Temperature of the sensor, degrees Celsius, if the record is long enough.
    pub temperature_c: Option<f64>,
}

/// Angular rates at three stages of filtering, radians per second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gyro {
    /// The stages; each is 10 to 20 ms later than the one before.
    pub stages: [[f64; 3]; 3],
}

impl LogRecord {
    /// The visual odometry in it.
    #[must_use]
    pub fn odometry(&self) -> Option<Odometry> {
        if self.kind != RecordKind::Odometry {
            return None;
        }
        let word = |at: usize| Some(f64::from(i16::from_le_bytes(self.take(at)?)) / 100.0);
        let flags = self.payload.get(76).copied().unwrap_or(0);
        let bit = |bit: u8| flags >> bit & 1 == 1;
        Some(Odometry {
            velocity: [word(2)?, word(4)?, word(6)?],
            position: self.floats(8)?,
            velocity_valid: [bit(0), bit(1), bit(2)],
            position_valid: [bit(4), bit(5), bit(6)],
        })
    }

    /// The attitude and rates in it.
    #[must_use]
    pub fn imu(&self) -> Option<Imu> {
        if self.kind != RecordKind::Imu {
            return None;
        }
        Some(Imu {
            acceleration_g: self.floats(20)?,
            rate: self.floats(32)?,
            quaternion: self.floats(48)?,
            temperature_c: self
                .take(106)
                .map(|two| f64::from(i16::from_le_bytes(two)) / 100.0),
        })
    }

    /// The three stages of angular rates in it.
    #[must_use]
    pub fn gyro(&self) -> Option<Gyro> {
        if self.kind != RecordKind::Gyro {
            return None;
        }
        Some(Gyro {
            stages: [self.floats(1)?, self.floats(13)?, self.floats(25)?],
        })
    }

    /// The raw distance in it; its unit is not confirmed.
    #[must_use]
    pub fn tof(&self) -> Option<i16> {
        if self.kind != RecordKind::Tof {
            return None;
        }
        self.take(0).map(i16::from_le_bytes)
    }

    /// The values with units, received at `at`.
    #[must_use]
    pub fn telemetry(&self, at: Duration) -> Telemetry {
        let mut telemetry = Telemetry::default();
        if let Some(odometry) = self.odometry() {
            let valid = odometry.velocity_valid;
            let frame = VelocityFrame::Unsettled;
            let velocity = Velocity {
                meters_per_s: odometry.velocity,
                frame,
                valid,
            };
            telemetry.velocity =
                Some(Reading::new(velocity, at, Source::Log).with_validity(valid == [true; 3]));
            let position = Reading::new(odometry.position, at, Source::Log);
            telemetry.position_m =
                Some(position.with_validity(odometry.position_valid == [true; 3]));
        }
        if let Some(imu) = self.imu() {
            telemetry = imu.telemetry(at);
        }
        telemetry
    }

    fn take<const N: usize>(&self, at: usize) -> Option<[u8; N]> {
        self.payload.get(at..)?.first_chunk().copied()
    }

    /// Finite numbers only: a damaged record gives none.
    fn floats<const N: usize>(&self, at: usize) -> Option<[f64; N]> {
        let mut values = [0.0; N];
        for (index, value) in values.iter_mut().enumerate() {
            *value = f64::from(f32::from_le_bytes(self.take(at + 4 * index)?));
            if !value.is_finite() {
                return None;
            }
        }
        Some(values)
    }
}

impl Imu {
    fn telemetry(&self, at: Duration) -> Telemetry {
        let sample = Telemetry::builder(at, Source::Log)
            .quaternion(self.quaternion)
            .acceleration(self.acceleration_g.map(|g| g * GRAVITY))
            .angular_rate(self.rate.map(f64::to_degrees));
        #[cfg(feature = "std")]
        let sample = sample.attitude(euler(self.quaternion));
        sample.build()
    }
}

/// Roll, pitch, yaw of a quaternion, rotation order z, y, x.
#[cfg(feature = "std")]
fn euler([w, x, y, z]: [f64; 4]) -> crate::telemetry::Attitude {
    let sine = (2.0 * (w * y - z * x)).clamp(-1.0, 1.0);
    crate::telemetry::Attitude {
        roll_deg: (2.0 * (w * x + y * z))
            .atan2(1.0 - 2.0 * (x * x + y * y))
            .to_degrees(),
        pitch_deg: sine.asin().to_degrees(),
        yaw_deg: (2.0 * (w * z + x * y))
            .atan2(1.0 - 2.0 * (y * y + z * z))
            .to_degrees(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn odometry() -> LogRecord {
        let mut payload = std::vec![0_u8; 80];
        payload[2..8].copy_from_slice(&[0x9C, 0xFF, 0x32, 0, 0, 0]);
        payload[8..12].copy_from_slice(&1.5_f32.to_le_bytes());
        payload[76] = 0b0111_0111;
        LogRecord {
            kind: RecordKind::Odometry,
            tick: 0x1234_56AB,
            payload,
        }
    }

    #[test]
    fn odometry_has_units_and_validity() {
        let o = odometry().odometry().unwrap();
        assert_eq!(
            (o.velocity, o.position),
            ([-1.0, 0.5, 0.0], [1.5, 0.0, 0.0])
        );
        let telemetry = odometry().telemetry(Duration::ZERO);
        assert!(telemetry.velocity.unwrap().valid && telemetry.position_m.unwrap().valid);
        let mut invalid = odometry();
        invalid.payload[76] = 0b0111_0101;
        let velocity = invalid.telemetry(Duration::ZERO).velocity.unwrap();
        assert!(!velocity.valid && velocity.value.valid == [true, false, true]);
    }

    #[test]
    fn a_quarter_turn_is_ninety_degrees_of_yaw() {
        let mut payload = std::vec![0_u8; 108];
        let half = std::f32::consts::FRAC_1_SQRT_2;
        payload[48..52].copy_from_slice(&half.to_le_bytes());
        payload[60..64].copy_from_slice(&half.to_le_bytes());
        payload[28..32].copy_from_slice(&(-1.0_f32).to_le_bytes());
        let record = LogRecord {
            kind: RecordKind::Imu,
            tick: 0,
            payload,
        };
        let telemetry = record.telemetry(Duration::ZERO);
        assert!((telemetry.attitude.unwrap().value.yaw_deg - 90.0).abs() < 1e-4);
        assert!((telemetry.acceleration.unwrap().value[2] + 9.806_65).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn records_come_back(kind: u16, tick: u32, payload in proptest::collection::vec(any::<u8>(), 0..200)) {
            let record = LogRecord { kind: RecordKind::from_number(kind), tick, payload };
            let bytes = [&[0][..], &encode_record(&record), &encode_record(&record)].concat();
            let read: Vec<_> = LogRecords::new(&bytes).collect();
            prop_assert_eq!(read, [record.clone(), record]);
        }

        #[test]
        fn any_bytes_are_read(bytes in proptest::collection::vec(prop_oneof![Just(0x55_u8), any::<u8>()], 0..200)) {
            for record in LogRecords::new(&bytes) {
                let _ = (record.telemetry(Duration::ZERO), record.gyro(), record.tof());
            }
        }
    }
}
