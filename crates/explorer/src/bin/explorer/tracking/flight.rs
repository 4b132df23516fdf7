//! The telemetry of a recorded flight: the state lines of a recording by `tello-sdk`, for the filter.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use edge_slam::fusion::{AttitudeSample, FlightSample, VelocityFrame};
use edge_slam::sequence::read_at_most;
use explorer::{attitude_sample, flight_sample, velocity_frame};
use tello_sdk::record::{Channel, Records};
use tello_sdk::{StateConvention, StateLine};

use crate::args::{Slam, TelemetryChoice};
use crate::failure::Failure;

/// The recording that is looked for beside the frames.
const NAME: &str = "flight.tello";
/// Most bytes of a recording, its video included.
const MOST_BYTES: u64 = 1 << 30;

/// What a drone said of itself while it filmed the sequence.
#[derive(Debug, Clone)]
pub(crate) struct Flight {
    pub(crate) path: PathBuf,
    /// In the order of their times, which are those of the frames.
    pub(crate) samples: Vec<(FlightSample, Option<AttitudeSample>)>,
    pub(crate) velocity_frame: VelocityFrame,
    /// State lines without a velocity, or that are no state lines.
    pub(crate) unusable: usize,
    /// Bytes at the recording's end that are torn or damaged.
    pub(crate) damaged_bytes: usize,
}

impl Flight {
    /// The wanted recording; without a wish the one beside the frames, or none where there is none.
    pub(crate) fn open(arguments: &Slam) -> Result<Option<Self>, Failure> {
        let (path, wanted) = match &arguments.telemetry {
            Some(TelemetryChoice::None) => return Ok(None),
            Some(TelemetryChoice::File(path)) => (path.clone(), true),
            None => (arguments.sequence.join(NAME), false),
        };
        let bytes = match read_at_most(&path, MOST_BYTES) {
            Err(error) if error.kind() == ErrorKind::NotFound && !wanted => return Ok(None),
            read => read.map_err(|error| unusable(&path, &error, "check the path"))?,
        };
        Self::parse(path, &bytes, arguments.telemetry_start).map(Some)
    }

    /// `start` is the frames' time at which the recording began.
    fn parse(path: PathBuf, bytes: &[u8], start: f64) -> Result<Self, Failure> {
        let mut records = Records::new(bytes);
        let (mut samples, mut unread) = (Vec::new(), 0);
        let mut frame = None;
        for record in records.by_ref() {
            if record.channel != Channel::State {
                continue;
            }
            let line = StateLine::parse(record.bytes).ok();
            let telemetry = line.map(|line| line.telemetry(record.at, &StateConvention::default()));
            let time = start + record.at.as_secs_f64();
            let found = telemetry.and_then(|telemetry| {
                frame = frame.or_else(|| velocity_frame(&telemetry));
                Some((
                    flight_sample(&telemetry, time)?,
                    attitude_sample(&telemetry),
                ))
            });
            match found {
                Some(found) => samples.push(found),
                None => unread += 1,
            }
        }
        let damaged_bytes = records.torn_bytes();
        samples.sort_by(|(a, _), (b, _)| a.time.total_cmp(&b.time));
        let Some(velocity_frame) = frame.filter(|_| !samples.is_empty()) else {
            let reason = format!(
                "it has no state line with a velocity ({unread} without, {damaged_bytes} bytes damaged)"
            );
            let advice = "give a recording of tello-sdk, or --telemetry none";
            return Err(unusable(&path, &reason, advice));
        };
        Ok(Self {
            path,
            samples,
            velocity_frame,
            unusable: unread,
            damaged_bytes,
        })
    }

    /// First and last time.
    pub(crate) fn span(&self) -> Option<[f64; 2]> {
        let (first, last) = (self.samples.first()?, self.samples.last()?);
        Some([first.0.time, last.0.time])
    }
}

fn unusable(path: &Path, reason: &dyn core::fmt::Display, advice: &str) -> Failure {
    Failure::new(format!("{}: {reason}", path.display()), advice)
}

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use proptest::prelude::*;
    use tello_sdk::record::{Record, encode};

    use super::*;

    fn recording(lines: &[(u64, &str)]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for &(milliseconds, line) in lines {
            let record = Record {
                at: Duration::from_millis(milliseconds),
                channel: Channel::State,
                bytes: line.as_bytes(),
            };
            encode(&record, &mut bytes);
        }
        bytes
    }

    const LINE: &str = "pitch:2;roll:-1;yaw:90;vgx:5;vgy:-2;vgz:1;bat:80;";

    #[test]
    fn state_lines_become_samples_on_the_clock_of_the_frames() {
        let mut bytes = recording(&[(0, "bat:80;"), (100, LINE), (200, "rubbish")]);
        bytes.extend([0xA5, 2, 9]);
        let flight = Flight::parse("f".into(), &bytes, 1000.0).expect("a flight");
        let (sample, attitude) = flight.samples[0];
        assert!((sample.time - 1000.1).abs() < 1e-9);
        assert!((sample.velocity.x - 0.5).abs() < 1e-12 && (sample.battery - 0.8).abs() < 1e-12);
        let yaw = attitude.expect("an attitude").angles.z;
        assert!((yaw + core::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert_eq!((flight.unusable, flight.damaged_bytes), (2, 3));
        assert_eq!(flight.velocity_frame, VelocityFrame::YawLevelled);
        assert_eq!(flight.samples.len(), 1);
    }

    #[test]
    fn a_recording_without_velocities_is_refused() {
        for bytes in [
            Vec::new(),
            b"no recording".to_vec(),
            recording(&[(0, "bat:80;")]),
        ] {
            assert!(Flight::parse("f".into(), &bytes, 0.0).is_err());
        }
    }

    proptest! {
        #[test]
        fn any_bytes_are_a_flight_or_an_error(
            bytes in prop::collection::vec(any::<u8>(), 0..200), at in 0usize..200, value in any::<u8>(),
        ) {
            let _ = Flight::parse("f".into(), &bytes, 0.0);
            let mut damaged = recording(&[(0, LINE), (100, LINE), (200, LINE)]);
            let at = at % damaged.len();
            damaged[at] = value;
            if let Ok(flight) = Flight::parse("f".into(), &damaged, 0.0) {
                prop_assert!(flight.samples.len() <= 3);
            }
        }
    }
}
