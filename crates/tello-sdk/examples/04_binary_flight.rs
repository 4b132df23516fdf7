//! Takes off, turns and lands in the binary protocol of the maker's app.
//!
//! Input: `--drone ADDRESS:PORT` for a real drone (192.168.10.1:8889) or another program's; without it an emulated drone on
//! 127.0.0.3 is started in this process. Output: how far it turned, then the battery's charge.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tello_sdk::emulator::udp::{DroneServer, ServeConfig};
use tello_sdk::{BinaryDrone, BinaryDroneConfig, Stick, Sticks};

fn main() -> Result<(), Box<dyn Error>> {
    if let Some(address) = std::env::args().skip_while(|word| word != "--drone").nth(1) {
        return fly(address.parse()?);
    }
    let config = ServeConfig {
        address: [127, 0, 0, 3].into(),
        binary: true,
        ..ServeConfig::default()
    };
    let (server, stop) = (DroneServer::bind(&config)?, AtomicBool::new(false));
    std::thread::scope(|scope| {
        scope.spawn(|| server.run(&|_| None, &stop));
        let flown = config.address_of(0).map_err(Into::into).and_then(fly);
        stop.store(true, Ordering::Relaxed);
        flown
    })
}

fn fly(address: SocketAddr) -> Result<(), Box<dyn Error>> {
    let drone = BinaryDrone::connect(BinaryDroneConfig::at(address))?;
    drone.take_off()?;
    let start = Instant::now();
    let turn = Sticks {
        yaw: Stick::MAX,
        ..Sticks::CENTER
    };
    // Up for four seconds, then clockwise for two; each event comes with new telemetry.
    while start.elapsed() < Duration::from_secs(6) {
        let _ = drone.next_event(Duration::from_millis(100));
        if start.elapsed() > Duration::from_secs(4) {
            drone.set_sticks(turn);
        }
    }
    let (telemetry, _) = drone.telemetry()?;
    if let Some(attitude) = telemetry.attitude {
        println!("yaw {:.0} degrees", attitude.value.yaw_deg);
    }
    drone.land()?;
    let battery = telemetry.battery;
    println!(
        "battery {:?}",
        battery.map(|reading| reading.value.percent())
    );
    Ok(())
}
