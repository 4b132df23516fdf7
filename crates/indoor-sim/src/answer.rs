//! The drone's answers to questions, spelled as on the wire.

use tello_sdk::{Query, Telemetry};

use crate::drone::Drone;

/// The answer's text; what the simulated drone does not know is answered as an old firmware does.
pub(crate) fn answer(query: Query, drone: &Drone, telemetry: &Telemetry) -> String {
    let meters =
        |value: Option<tello_sdk::Reading<f64>>| value.map_or(0.0, |reading| reading.value);
    match query {
        Query::Speed => format!("{:.1}", drone.speed() * 100.0),
        Query::Battery => format!("{}", drone.charge.percent().floor()),
        Query::MotorTime => {
            format!(
                "{}s",
                telemetry
                    .motor_time
                    .map_or(0, |reading| reading.value.as_secs())
            )
        }
        Query::Height => format!("{:.0}dm", meters(telemetry.height_m) * 10.0),
        Query::Tof => format!("{:.0}mm", meters(telemetry.tof_m) * 1000.0),
        Query::Barometer => format!("{:.2}", meters(telemetry.barometer_m)),
        Query::Attitude => {
            let attitude = telemetry
                .attitude
                .map(|reading| reading.value)
                .unwrap_or_default();
            let (pitch, roll, yaw) = (attitude.pitch_deg, attitude.roll_deg, attitude.yaw_deg);
            format!("pitch:{pitch};roll:{roll};yaw:{yaw};")
        }
        Query::Wifi => "90".to_owned(),
        other => format!("unknown command: {}", other.text()),
    }
}
