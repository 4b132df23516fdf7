//! A simulated world behind the drone's real protocol, in real time: an emulated Tello on UDP whose body is `indoor-sim`'s.
//!
//! Input: nothing, then our own driver flies it; or `serve`, then it waits for any client on 127.0.0.2:18889 until
//! killed. Output: what the drone says of itself, and what really happened in the world.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};

use indoor_sim::{SimConfig, Simulator, World};
use tello_sdk::emulator::udp::DroneSockets;
use tello_sdk::emulator::{Emulator, EmulatorConfig};
use tello_sdk::video::TestCard;
use tello_sdk::{Distance, Drone, DroneConfig, Turn};

fn main() -> Result<(), Box<dyn Error>> {
    let address = SocketAddr::from(([127, 0, 0, 2], 18_889));
    let world = World::named("one-door-room", 1)?;
    let simulator = Simulator::new(world, SimConfig::default(), 1)?;
    let mut tello =
        Emulator::new(EmulatorConfig::default(), simulator).with_video(Box::new(TestCard::new()));
    let (sockets, stop) = (DroneSockets::bind(address)?, AtomicBool::new(false));
    std::thread::scope(|scope| {
        let flight = scope.spawn(|| {
            let summary = sockets.run(&mut tello, &stop);
            (summary, tello)
        });
        let flown = if std::env::args().any(|word| word == "serve") {
            println!("a Tello in a simulated room on {address}");
            Ok(())
        } else {
            let flown = fly(address);
            stop.store(true, Ordering::Relaxed);
            flown
        };
        let (summary, tello) = flight.join().map_err(|_| "the drone's thread panicked")?;
        let truth = tello.physics().truth();
        println!(
            "{} commands; {:.2} m flown, least clearance {:.2} m, {} collisions, {:?}",
            summary.commands,
            truth.path_length,
            truth.min_clearance,
            truth.collisions.len(),
            tello.physics().phase()
        );
        flown
    })
}

fn fly(address: SocketAddr) -> Result<(), Box<dyn Error>> {
    let drone = Drone::connect(DroneConfig::at(address))?;
    drone.take_off()?;
    for _ in 0..2 {
        drone.forward(Distance::from_cm(40)?)?;
        drone.clockwise(Turn::from_degrees(180)?)?;
    }
    let (telemetry, _) = drone.telemetry()?;
    println!(
        "height {:?} m",
        telemetry.height_m.map(|reading| reading.value)
    );
    drone.land()?;
    Ok(())
}
