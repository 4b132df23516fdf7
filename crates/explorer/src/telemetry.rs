//! The drone's telemetry as the visual-inertial filter of `edge-slam` takes it.
//!
//! The drone counts degrees, yaw clockwise and pitch nose up; the filter wants radians about x ahead, y left and z
//! up, so that yaw and pitch change their signs.

use edge_slam::fusion::{AttitudeSample, FlightSample, VelocityFrame};
use nalgebra::Vector3;
use tello_sdk::Telemetry;

/// Velocity and battery at `time` (seconds); `None` where the velocity is missing or not valid. An unknown charge
/// counts as empty, which only makes the filter more careful.
#[must_use]
pub fn flight_sample(telemetry: &Telemetry, time: f64) -> Option<FlightSample> {
    let velocity = telemetry.velocity.filter(|reading| reading.valid)?.value;
    if velocity.valid != [true; 3] {
        return None;
    }
    let battery = telemetry
        .battery
        .map_or(0.0, |reading| f64::from(reading.value.percent()) / 100.0);
    Some(FlightSample {
        time,
        velocity: Vector3::from(velocity.meters_per_s),
        battery,
    })
}

/// Roll, pitch and yaw; `None` where the drone did not send them.
#[must_use]
pub fn attitude_sample(telemetry: &Telemetry) -> Option<AttitudeSample> {
    let attitude = telemetry.attitude.filter(|reading| reading.valid)?.value;
    let angles = Vector3::new(attitude.roll_deg, -attitude.pitch_deg, -attitude.yaw_deg);
    Some(AttitudeSample {
        angles: angles.map(f64::to_radians),
    })
}

/// The filter's name for the frame of the velocities; `None` without velocities. An unsettled frame is taken for the
/// drone's own heading.
#[must_use]
pub fn velocity_frame(telemetry: &Telemetry) -> Option<VelocityFrame> {
    Some(match telemetry.velocity?.value.frame {
        tello_sdk::VelocityFrame::PowerOn => VelocityFrame::World,
        tello_sdk::VelocityFrame::Body | tello_sdk::VelocityFrame::Unsettled => {
            VelocityFrame::YawLevelled
        }
    })
}

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use super::*;
    use tello_sdk::{Attitude, Source, Velocity};

    #[test]
    fn signs_and_units_are_turned() {
        let velocity = |valid| Velocity {
            meters_per_s: [1.0, 0.5, -0.2],
            frame: tello_sdk::VelocityFrame::Body,
            valid,
        };
        let attitude = Attitude {
            pitch_deg: 10.0,
            roll_deg: -5.0,
            yaw_deg: 90.0,
        };
        let with = |valid| {
            Telemetry::builder(Duration::ZERO, Source::Simulated)
                .velocity(velocity(valid))
                .attitude(attitude)
                .build()
        };
        let telemetry = with([true; 3]);
        let sample = flight_sample(&telemetry, 3.0);
        assert_eq!(
            sample.map(|s| (s.time, s.velocity.y, s.battery)),
            Some((3.0, 0.5, 0.0))
        );
        let angles = attitude_sample(&telemetry).map(|s| s.angles.map(f64::to_degrees));
        let wanted = Vector3::new(-5.0, -10.0, -90.0);
        assert!(angles.is_some_and(|angles| (angles - wanted).norm() < 1e-9));
        assert_eq!(velocity_frame(&telemetry), Some(VelocityFrame::YawLevelled));
        assert!(flight_sample(&with([true, false, true]), 0.0).is_none());
        assert!(attitude_sample(&Telemetry::default()).is_none());
    }
}
