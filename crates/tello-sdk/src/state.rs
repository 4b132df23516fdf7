//! The state line of the text protocol: `key:value;` pairs at about 10 Hz, read for every SDK version.
//!
//! Missing and additional keys are tolerated, the order is free, values may be integers or decimals; a value that is
//! no finite number is counted in [`StateLine::malformed`] and left out. Reading never panics, never allocates and
//! costs one pass over the bytes.

use crate::command::SdkVersion;
use crate::telemetry::{
    Attitude, PadSighting, Source, Telemetry, Temperature, Velocity, VelocityFrame,
};
use crate::units::Battery;
use alloc::string::String;
use core::fmt::Write as _;
use core::time::Duration;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.806_65;

/// Why bytes are not a state line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// Not UTF-8 (a packet of the binary protocol, for example).
    #[error("{length} bytes on the state port are no text")]
    NotText {
        /// Bytes received.
        length: usize,
    },
    /// No known `key:value` in it.
    #[error("none of the {pairs} `key:value` pairs in {length} bytes is known")]
    NoKnownKey {
        /// Bytes received.
        length: usize,
        /// Pairs found.
        pairs: usize,
    },
}

/// How the wire's velocity is to be read; configurable because published sources disagree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateConvention {
    /// m/s per unit of vgx, vgy, vgz; decimetres per second by the 3.0 manual.
    pub velocity_scale: f64,
    /// Factor per axis, +1 or -1; one user saw a negative vgx while flying forward.
    pub velocity_sign: [f64; 3],
    /// Frame of the velocity.
    pub velocity_frame: VelocityFrame,
}

impl Default for StateConvention {
    fn default() -> Self {
        Self {
            velocity_scale: 0.1,
            velocity_sign: [1.0; 3],
            velocity_frame: VelocityFrame::Unsettled,
        }
    }
}

/// The values of one state line in the wire's units; `None` where the line had none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StateLine {
    /// Mission pad: 1 to 8, -1 none, -2 detection off.
    pub mid: Option<f64>,
    /// Position in the pad's frame, cm.
    pub pad_position: [Option<f64>; 3],
    /// `mpry`: attitude relative to the pad, degrees.
    pub mpry: Option<[f64; 3]>,
    /// Degrees.
    pub pitch: Option<f64>,
    /// Degrees.
    pub roll: Option<f64>,
    /// Degrees.
    pub yaw: Option<f64>,
    /// vgx, vgy, vgz, dm/s.
    pub velocity: [Option<f64>; 3],
    /// Lowest temperature, degrees Celsius.
    pub templ: Option<f64>,
    /// Highest temperature, degrees Celsius.
    pub temph: Option<f64>,
    /// Distance to the ground, cm.
    pub tof: Option<f64>,
    /// Height, cm.
    pub h: Option<f64>,
    /// Battery, percent.
    pub bat: Option<f64>,
    /// Barometric height, m.
    pub baro: Option<f64>,
    /// Motor time, s.
    pub time: Option<f64>,
    /// agx, agy, agz, 0.001 g.
    pub acceleration: [Option<f64>; 3],
    /// Pairs whose key is not known.
    pub unknown: usize,
    /// Pairs whose value is not a finite number.
    pub malformed: usize,
}

impl StateLine {
    /// Reads one datagram of the state port.
    ///
    /// # Errors
    /// Not text, or no known key in it.
    pub fn parse(bytes: &[u8]) -> Result<Self, StateError> {
        let text = core::str::from_utf8(bytes).map_err(|_| StateError::NotText {
            length: bytes.len(),
        })?;
        let mut line = Self::default();
        let mut pairs = 0;
        let mut known = 0;
        for part in text.split([';', '\r', '\n', '\0']) {
            let Some((key, value)) = part.split_once(':') else {
                continue;
            };
            pairs += 1;
            known += usize::from(line.set(key.trim(), value.trim()));
        }
        if known == 0 {
            return Err(StateError::NoKnownKey {
                length: bytes.len(),
                pairs,
            });
        }
        Ok(line)
    }

    /// Stores one pair; true if the key is known and the value a number.
    fn set(&mut self, key: &str, value: &str) -> bool {
        if key == "mpry" {
            self.mpry = triple(value);
            self.malformed += usize::from(self.mpry.is_none());
            return self.mpry.is_some();
        }
        let Some(slot) = self.slot(key) else {
            self.unknown += 1;
            return false;
        };
        *slot = finite(value);
        let good = slot.is_some();
        self.malformed += usize::from(!good);
        good
    }

    fn slot(&mut self, key: &str) -> Option<&mut Option<f64>> {
        let [x, y, z] = &mut self.pad_position;
        let [vgx, vgy, vgz] = &mut self.velocity;
        let [agx, agy, agz] = &mut self.acceleration;
        Some(match key {
            "mid" => &mut self.mid,
            "x" => x,
            "y" => y,
            "z" => z,
            "pitch" => &mut self.pitch,
            "roll" => &mut self.roll,
            "yaw" => &mut self.yaw,
            "vgx" => vgx,
            "vgy" => vgy,
            "vgz" => vgz,
            "templ" => &mut self.templ,
            "temph" => &mut self.temph,
            "tof" => &mut self.tof,
            "h" => &mut self.h,
            "bat" => &mut self.bat,
            "baro" => &mut self.baro,
            "time" => &mut self.time,
            "agx" => agx,
            "agy" => agy,
            "agz" => agz,
            _ => return None,
        })
    }

    /// The values in metres, seconds and degrees, received at `at`.
    ///
    /// A group (attitude, velocity, acceleration) is there only if all of its members came; a battery outside 0..=100
    /// percent is left out.
    #[must_use]
    pub fn telemetry(&self, at: Duration, convention: &StateConvention) -> Telemetry {
        let mut sample = Telemetry::builder(at, Source::TextState);
        if let (Some(pitch_deg), Some(roll_deg), Some(yaw_deg)) = (self.pitch, self.roll, self.yaw)
        {
            sample = sample.attitude(Attitude {
                pitch_deg,
                roll_deg,
                yaw_deg,
            });
        }
        if let Some(raw) = all(self.velocity) {
            let sign = convention.velocity_sign;
            let meters_per_s =
                [0, 1, 2].map(|axis| raw[axis] * sign[axis] * convention.velocity_scale);
            let frame = convention.velocity_frame;
            sample = sample.velocity(Velocity {
                meters_per_s,
                frame,
                valid: [true; 3],
            });
        }
        if let Some(raw) = all(self.acceleration) {
            sample = sample.acceleration(raw.map(|milli_g| milli_g * 1e-3 * GRAVITY));
        }
        if let (Some(low), Some(high)) = (self.templ, self.temph) {
            sample = sample.temperature(Temperature {
                low_c: low as i16,
                high_c: high as i16,
            });
        }
        sample = self.heights(sample);
        if let Some(battery) = self.bat.and_then(|b| Battery::from_percent(b as i64).ok()) {
            sample = sample.battery(battery);
        }
        if let Some(time) = self.time.and_then(|t| Duration::try_from_secs_f64(t).ok()) {
            sample = sample.motor_time(time);
        }
        if let Some(pad) = self.pad() {
            sample = sample.pad(pad);
        }
        sample.build()
    }

    fn heights(
        &self,
        mut sample: crate::telemetry::TelemetryBuilder,
    ) -> crate::telemetry::TelemetryBuilder {
        if let Some(h) = self.h {
            sample = sample.height_m(h / 100.0);
        }
        if let Some(tof) = self.tof {
            sample = sample.tof_m(tof / 100.0);
        }
        if let Some(baro) = self.baro {
            sample = sample.barometer_m(baro);
        }
        sample
    }

    fn pad(&self) -> Option<PadSighting> {
        let pad = self.mid.filter(|mid| (1.0..=8.0).contains(mid))? as u8;
        let position_cm = all(self.pad_position)?.map(|cm| cm as i16);
        let attitude_deg = self.mpry.unwrap_or_default().map(|degrees| degrees as i16);
        Some(PadSighting {
            pad,
            position_cm,
            attitude_deg,
        })
    }

    /// Writes the line as a drone of the given SDK sends it, with CR LF; a missing value is written as 0.
    #[must_use]
    pub fn encode(&self, version: SdkVersion) -> String {
        let mut text = String::with_capacity(192);
        let n = |value: Option<f64>| value.unwrap_or(0.0) as i64;
        // Writing to a String cannot fail.
        if version >= SdkVersion::V2_0 {
            let [x, y, z] = self.pad_position.map(|c| c.unwrap_or(-200.0) as i64);
            let [p, r, w] = self.mpry.unwrap_or_default().map(|c| c as i64);
            let mid = self.mid.unwrap_or(-2.0) as i64;
            let _ = write!(text, "mid:{mid};x:{x};y:{y};z:{z};mpry:{p},{r},{w};");
        }
        let [vx, vy, vz] = self.velocity.map(n);
        let _ = write!(
            text,
            "pitch:{};roll:{};yaw:{};",
            n(self.pitch),
            n(self.roll),
            n(self.yaw)
        );
        let _ = write!(text, "vgx:{vx};vgy:{vy};vgz:{vz};");
        let _ = write!(text, "templ:{};temph:{};", n(self.templ), n(self.temph));
        let _ = write!(
            text,
            "tof:{};h:{};bat:{};",
            n(self.tof),
            n(self.h),
            n(self.bat)
        );
        let _ = write!(
            text,
            "baro:{:.2};time:{};",
            self.baro.unwrap_or(0.0),
            n(self.time)
        );
        let [ax, ay, az] = self.acceleration.map(|a| a.unwrap_or(0.0));
        let _ = write!(text, "agx:{ax:.2};agy:{ay:.2};agz:{az:.2};\r\n");
        text
    }
}

impl Telemetry {
    /// Reads a state line of any SDK version, received at `at`.
    ///
    /// ```
    /// use core::time::Duration;
    /// use tello_sdk::{StateConvention, Telemetry};
    /// let line = b"pitch:0;roll:-1;yaw:90;vgx:3;vgy:0;vgz:0;templ:60;temph:63;tof:80;h:70;bat:81;baro:93.25;time:12;agx:-9.00;agy:2.00;agz:-998.00;\r\n";
    /// let telemetry = Telemetry::parse_state(line, Duration::ZERO, &StateConvention::default())?;
    /// assert_eq!(telemetry.height_m.map(|h| h.value), Some(0.7));
    /// # Ok::<(), tello_sdk::StateError>(())
    /// ```
    ///
    /// # Errors
    /// Not text, or no known key in it.
    pub fn parse_state(
        bytes: &[u8],
        at: Duration,
        convention: &StateConvention,
    ) -> Result<Self, StateError> {
        Ok(StateLine::parse(bytes)?.telemetry(at, convention))
    }
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

fn triple(text: &str) -> Option<[f64; 3]> {
    let mut parts = text.split(',').map(finite);
    let triple = [parts.next()??, parts.next()??, parts.next()??];
    parts.next().is_none().then_some(triple)
}

fn all(values: [Option<f64>; 3]) -> Option<[f64; 3]> {
    let [x, y, z] = values;
    Some([x?, y?, z?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const V1: &str = "pitch:1;roll:-2;yaw:-179;vgx:-7;vgy:0;vgz:1;templ:60;temph:63;tof:10;h:-10;bat:81;baro:93.25;time:12;agx:-9.00;agy:2.00;agz:-998.00;\r\n";
    const V3: &str = "mid:3;x:-20;y:11;z:80;mpry:0,1,-2;pitch:0;roll:0;yaw:0;vgx:0;vgy:0;vgz:0;templ:60;temph:62;tof:6553;h:0;bat:100;baro:-57.14;time:0;agx:5.00;agy:-9.00;agz:-1000.00;\r\n";

    fn read(text: &str) -> Telemetry {
        Telemetry::parse_state(text.as_bytes(), Duration::ZERO, &StateConvention::default())
            .unwrap()
    }

    #[test]
    fn a_line_of_1_3_is_read_with_units() {
        let t = read(V1);
        let attitude = t.attitude.unwrap().value;
        assert_eq!(
            (attitude.pitch_deg, attitude.roll_deg, attitude.yaw_deg),
            (1.0, -2.0, -179.0)
        );
        assert!((t.velocity.unwrap().value.meters_per_s[0] + 0.7).abs() < 1e-12);
        assert_eq!(t.height_m.unwrap().value, -0.1);
        assert!(!t.tof_m.unwrap().valid, "10 cm is the floor reading");
        assert_eq!(t.battery.unwrap().value.percent(), 81);
        assert_eq!(t.motor_time.unwrap().value, Duration::from_secs(12));
        assert!((t.acceleration.unwrap().value[2] + 9.787).abs() < 1e-3);
        assert_eq!(t.pad, None);
    }

    #[test]
    fn a_line_of_3_0_is_longer_than_150_bytes_and_not_cut() {
        assert!(V3.len() > 150);
        let t = read(V3);
        let pad = t.pad.unwrap().value;
        assert_eq!(
            (pad.pad, pad.position_cm, pad.attitude_deg),
            (3, [-20, 11, 80], [0, 1, -2])
        );
        assert!(!t.tof_m.unwrap().valid);
        assert_eq!(t.barometer_m.unwrap().value, -57.14);
    }

    #[test]
    fn missing_additional_and_malformed_values_are_tolerated() {
        let line = StateLine::parse(b"bat:50;new:3;pitch:x;roll:NaN;vgx:1;vgy:2;yaw:inf").unwrap();
        assert_eq!((line.bat, line.unknown, line.malformed), (Some(50.0), 1, 3));
        let t = line.telemetry(Duration::ZERO, &StateConvention::default());
        assert!(t.attitude.is_none() && t.velocity.is_none());
        assert!(read("bat:300;h:1").battery.is_none());
        assert!(read("time:-1;h:1").motor_time.is_none());
    }

    #[test]
    fn what_is_no_state_line_is_an_error() {
        assert_eq!(
            StateLine::parse(b""),
            Err(StateError::NoKnownKey {
                length: 0,
                pairs: 0
            })
        );
        assert_eq!(
            StateLine::parse(b"ok"),
            Err(StateError::NoKnownKey {
                length: 2,
                pairs: 0
            })
        );
        assert_eq!(
            StateLine::parse(&[0xCC, 0xFF]),
            Err(StateError::NotText { length: 2 })
        );
    }

    #[test]
    fn what_a_drone_writes_is_read_back() {
        let line = StateLine::parse(V3.as_bytes()).unwrap();
        assert_eq!(line.encode(SdkVersion::V3_0), V3);
        let old = StateLine::parse(V1.as_bytes()).unwrap();
        assert_eq!(old.encode(SdkVersion::V1_3), V1);
    }

    proptest! {
        #[test]
        fn any_bytes_are_read(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
            let _ = StateLine::parse(&bytes);
        }

        #[test]
        fn any_pairs_are_read(text in "((mid|x|mpry|bat|time|tof|vgx|vgy|vgz|h|k):[-+0-9.,eEnaif]{0,24};){0,12}") {
            if let Ok(line) = StateLine::parse(text.as_bytes()) {
                let _ = line.telemetry(Duration::ZERO, &StateConvention::default());
                let _ = line.encode(SdkVersion::V3_0);
            }
        }
    }
}
