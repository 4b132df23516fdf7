//! Three drones take off together, fly forward and land.
//!
//! Input: addresses of drones in station mode (`--drone 192.168.1.21:8889 --drone ...`); without any, three emulated drones on 127.0.0.2 to
//! 127.0.0.4 are started in this process. Output: the drones found and how each flight ended.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tello_sdk::emulator::udp::{ServeConfig, serve};
use tello_sdk::{Distance, DriveError, Drone, DroneConfig, StateHub, discover, together};

fn main() -> Result<(), Box<dyn Error>> {
    let words = std::env::args().skip(1).filter(|word| word != "--drone");
    let given: Result<Vec<SocketAddr>, _> = words.map(|a| a.parse()).collect();
    let given = given?;
    if !given.is_empty() {
        return swarm(&given);
    }
    let emulators = ServeConfig {
        count: 3,
        ..ServeConfig::default()
    };
    let port = emulators.command_port;
    let addresses = [2, 3, 4].map(|last| SocketAddr::from(([127, 0, 0, last], port)));
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| serve(&emulators, &stop));
        let flown = swarm(&addresses);
        stop.store(true, Ordering::Relaxed);
        flown
    })
}

fn swarm(addresses: &[SocketAddr]) -> Result<(), Box<dyn Error>> {
    let any = SocketAddr::from(([0, 0, 0, 0], 0));
    let found = discover(any, addresses, Duration::from_secs(2))?;
    let hub = StateHub::bind(SocketAddr::from(([0, 0, 0, 0], 8890)))?;
    let mut drones = Vec::new();
    for drone in &found {
        println!("found {} {:?}", drone.address, drone.serial_number);
        drones.push(Drone::connect_through(
            &hub,
            DroneConfig::at(drone.address),
        )?);
    }
    let drones: Vec<&Drone> = drones.iter().collect();
    // One drone's failure does not keep the others from flying.
    for (drone, flown) in found.iter().zip(together(&drones, hop)) {
        println!("{}: {flown:?}", drone.address);
    }
    Ok(())
}

fn hop(drone: &Drone) -> Result<(), DriveError> {
    drone.take_off()?;
    drone.forward(Distance::MIN)?;
    drone.land()
}
