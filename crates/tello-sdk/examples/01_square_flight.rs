//! Flies a square of 1 m and lands.
//!
//! Input: `--drone ADDRESS:PORT` for a real drone (192.168.10.1:8889); without it an emulated drone on 127.0.0.2 is
//! started in this process. Output: one line per leg, then the battery's charge.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use tello_sdk::emulator::udp::{ServeConfig, serve};
use tello_sdk::{Distance, Drone, DroneConfig, Turn};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    if arguments.next().as_deref() == Some("--drone") {
        let address: SocketAddr = arguments
            .next()
            .ok_or("--drone needs an address")?
            .parse()?;
        return square(DroneConfig::at(address));
    }
    let emulator = ServeConfig::default();
    let address = SocketAddr::from((emulator.address, emulator.command_port));
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let server = scope.spawn(|| serve(&emulator, &stop));
        let flown = square(DroneConfig::at(address));
        stop.store(true, Ordering::Relaxed);
        server.join().map_err(|_| "the emulator panicked")??;
        flown
    })
}

fn square(config: DroneConfig) -> Result<(), Box<dyn Error>> {
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
