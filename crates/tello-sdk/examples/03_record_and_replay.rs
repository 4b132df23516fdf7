//! Records a short flight of an emulated drone into a file, then runs the recording again.
//!
//! Input: an optional file name (default in the folder for temporary files). Output: how many datagrams were sent, and
//! whether the second run sent the same ones.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use tello_sdk::emulator::udp::{ServeConfig, serve};
use tello_sdk::{Distance, Drone, DroneConfig, SessionConfig, record};

fn main() -> Result<(), Box<dyn Error>> {
    let default = || std::env::temp_dir().join("flight.tello");
    let path = std::env::args().nth(1).map_or_else(default, PathBuf::from);
    let emulator = ServeConfig::default();
    let address = SocketAddr::from((emulator.address, emulator.command_port));
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let server = scope.spawn(|| serve(&emulator, &stop));
        let flown = fly(DroneConfig {
            record: Some(path.clone()),
            ..DroneConfig::at(address)
        });
        stop.store(true, Ordering::Relaxed);
        server.join().map_err(|_| "the emulator panicked")??;
        flown
    })?;
    let again = record::replay(&std::fs::read(&path)?, SessionConfig::default())?;
    println!(
        "{} datagrams sent, same again: {}",
        again.recorded.len(),
        again.is_identical()
    );
    Ok(())
}

fn fly(config: DroneConfig) -> Result<(), Box<dyn Error>> {
    let drone = Drone::connect(config)?;
    drone.take_off()?;
    drone.forward(Distance::from_cm(50)?)?;
    drone.land()?;
    Ok(())
}
