//! Records a short flight into a file, then runs the recording again.
//!
//! Input: `--drone ADDRESS:PORT` for a real drone; without it an emulated one in this process. Output: where the file is,
//! how many datagrams were sent, and whether the second run sent the same ones.

#![allow(clippy::print_stdout)]

mod emulated;

use emulated::{Flown, with_drone};
use tello_sdk::{Distance, Drone, DroneConfig, SessionConfig, record};

fn main() -> Flown {
    let path = std::env::temp_dir().join("flight.tello");
    with_drone(|config| {
        fly(DroneConfig {
            record: Some(path.clone()),
            ..config
        })
    })?;
    let again = record::replay(&std::fs::read(&path)?, SessionConfig::default())?;
    println!(
        "{}: {} datagrams sent, same again: {}",
        path.display(),
        again.recorded.len(),
        again.is_identical()
    );
    Ok(())
}

fn fly(config: DroneConfig) -> Flown {
    let drone = Drone::connect(config)?;
    drone.take_off()?;
    drone.forward(Distance::from_cm(50)?)?;
    drone.land()?;
    Ok(())
}
