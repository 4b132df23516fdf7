//! What the drone says of itself, rounded as the real one does.

use core::time::Duration;

use nalgebra::UnitQuaternion;
use tello_sdk::{Attitude, Battery, Source, Telemetry, Velocity, VelocityFrame};

use crate::drone::{Drone, GRAVITY, ground_below};
use crate::world::World;

/// A telemetry sample: whole degrees, velocity in dm/s, height in 10 cm steps, distance to the ground in cm.
pub(crate) fn sample(
    drone: &Drone,
    world: &World,
    at: Duration,
    motor_time: Duration,
) -> Telemetry {
    let start_yaw = world.start().yaw_degrees;
    let builder = Telemetry::builder(at, Source::Simulated)
        .attitude(attitude(drone, start_yaw))
        .velocity(velocity(drone, start_yaw))
        .acceleration(specific_force(drone))
        .height_m(height(drone))
        .tof_m(ground_distance(drone, world))
        .barometer_m(((FLOOR_ALTITUDE + drone.position().z) * 100.0).round() / 100.0)
        .motor_time(Duration::from_secs(motor_time.as_secs()));
    let percent = drone.charge.percent().floor() as i64;
    match Battery::from_percent(percent) {
        Ok(battery) => builder.battery(battery).build(),
        Err(_) => builder.build(),
    }
}

/// What the barometer shows at the floor, metres; real ones show anything, as they know no weather. Assumption.
const FLOOR_ALTITUDE: f64 = 150.0;

fn attitude(drone: &Drone, start_yaw: f64) -> Attitude {
    let (roll, pitch, _) = drone.world_from_body().rotation.euler_angles();
    let yaw = wrapped_degrees(start_yaw - drone.yaw().to_degrees());
    // About the y axis to the left a positive angle is nose down.
    Attitude {
        pitch_deg: (-pitch.to_degrees()).round(),
        roll_deg: roll.to_degrees().round(),
        yaw_deg: yaw.round(),
    }
}

/// To -180..=180.
fn wrapped_degrees(angle: f64) -> f64 {
    angle - 360.0 * (angle / 360.0).round()
}

fn velocity(drone: &Drone, start_yaw: f64) -> Velocity {
    let start =
        UnitQuaternion::from_axis_angle(&nalgebra::Vector3::z_axis(), start_yaw.to_radians());
    let velocity = start.inverse() * drone.velocity();
    Velocity {
        meters_per_s: velocity.map(|value| (value * 10.0).round() / 10.0).into(),
        frame: VelocityFrame::PowerOn,
        valid: [true; 3],
    }
}

/// Specific force in sensor axes, about -g on z at rest.
fn specific_force(drone: &Drone) -> [f64; 3] {
    let body = drone.world_from_body().rotation.inverse();
    let felt = drone.acceleration() + nalgebra::Vector3::z() * GRAVITY;
    let felt = body * felt;
    [felt.x, felt.y, -felt.z]
}

fn height(drone: &Drone) -> f64 {
    let above = drone.position().z - drone.config.radius - drone.height_offset;
    (above.max(0.0) * 10.0).floor() / 10.0
}

/// Distance to what is underneath, metres, in cm; never below the 0.10 m that the sensor shows on the floor.
fn ground_distance(drone: &Drone, world: &World) -> f64 {
    let position = drone.position();
    let distance = position.z - ground_below(world, position);
    (distance.clamp(0.10, 81.92) * 100.0).round() / 100.0
}
