//! Three drones take off together, fly forward and land.
//!
//! Input: addresses of drones in station mode (`192.168.1.21:8889 ...`); without any, three emulated drones on 127.0.0.2 to
//! 127.0.0.4 are started in this process. Output: the drones found and how each flight ended.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::sync::Barrier;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tello_sdk::emulator::udp::{ServeConfig, serve};
use tello_sdk::{Distance, Drone, DroneConfig, StateHub, discover};

fn main() -> Result<(), Box<dyn Error>> {
    let given: Result<Vec<SocketAddr>, _> = std::env::args().skip(1).map(|a| a.parse()).collect();
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
    let barrier = Barrier::new(found.len());
    std::thread::scope(|scope| {
        for drone in &found {
            println!("found {} {:?}", drone.address, drone.serial_number);
            scope.spawn(|| {
                // One drone's failure does not keep the others from flying.
                println!(
                    "{}: {:?}",
                    drone.address,
                    fly(&hub, drone.address, &barrier).is_ok()
                );
            });
        }
    });
    Ok(())
}

fn fly(hub: &StateHub, address: SocketAddr, start: &Barrier) -> Result<(), Box<dyn Error>> {
    let drone = Drone::connect_through(hub, DroneConfig::at(address));
    start.wait();
    let drone = drone?;
    drone.take_off()?;
    drone.forward(Distance::from_cm(50)?)?;
    drone.land()?;
    Ok(())
}
