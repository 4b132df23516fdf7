//! Prints the telemetry for five seconds: every value with its unit, its age and whether the sensor calls it valid.
//!
//! Input: `--drone ADDRESS:PORT` for a real drone; without it an emulated one in this process. The drone does not take
//! off. Output: two lines a second.

#![allow(clippy::print_stdout)]

mod emulated;

use emulated::{Flown, with_drone};
use std::time::{Duration, Instant};
use tello_sdk::{Drone, DroneConfig, Event};

fn main() -> Flown {
    with_drone(watch)
}

fn watch(config: DroneConfig) -> Flown {
    let drone = Drone::connect(config)?;
    let start = Instant::now();
    let mut lines = 0;
    while start.elapsed() < Duration::from_secs(5) {
        let event = drone.next_event(Duration::from_millis(500));
        lines += u32::from(event == Some(Event::Telemetry));
        // State lines come at 10 Hz.
        if event == Some(Event::Telemetry) && lines.is_multiple_of(5) {
            print(&drone)?;
        }
    }
    println!("{lines} state lines; {:?}", drone.counters()?);
    Ok(())
}

fn print(drone: &Drone) -> Flown {
    let (t, age) = drone.telemetry()?;
    if let (Some(attitude), Some(tof), Some(battery)) = (t.attitude, t.tof_m, t.battery) {
        println!(
            "yaw {:4.0} deg, ground {:.2} m ({}), battery {} %, {} ms old",
            attitude.value.yaw_deg,
            tof.value,
            if tof.valid { "valid" } else { "out of range" },
            battery.value.percent(),
            age.as_millis()
        );
    }
    Ok(())
}
