//! Flies a square of 1 m and lands.
//!
//! Input: `--drone ADDRESS:PORT` for a real drone (192.168.10.1:8889); without it an emulated drone on 127.0.0.2 is
//! started in this process. Output: one line per leg, then the battery's charge.

#![allow(clippy::print_stdout)]

mod emulated;

use emulated::{Flown, with_drone};
use tello_sdk::{Distance, Drone, DroneConfig, Turn};

fn main() -> Flown {
    with_drone(square)
}

fn square(config: DroneConfig) -> Flown {
    let drone = Drone::connect(config)?;
    drone.take_off()?;
    for leg in 1..=4 {
        drone.forward(Distance::from_cm(100)?)?;
        drone.clockwise(Turn::from_degrees(90)?)?;
        println!("leg {leg} flown");
    }
    println!("battery {} %", drone.battery()?);
    drone.land()?;
    Ok(())
}
