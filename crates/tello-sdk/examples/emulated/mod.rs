//! What every example begins with: the drone of `--drone ADDRESS:PORT`, or an emulated one with a camera in this process.

use std::error::Error;
use std::sync::atomic::{AtomicBool, Ordering};
use tello_sdk::DroneConfig;
use tello_sdk::emulator::udp::{DroneServer, ServeConfig};
use tello_sdk::video::TestCard;

/// What an example gives back.
pub(crate) type Flown = Result<(), Box<dyn Error>>;

/// Calls `fly` with the configuration for a drone.
pub(crate) fn with_drone(fly: impl FnOnce(DroneConfig) -> Flown) -> Flown {
    if let Some(address) = std::env::args().skip_while(|word| word != "--drone").nth(1) {
        return fly(DroneConfig::at(address.parse()?));
    }
    let config = ServeConfig::default();
    let (server, stop) = (DroneServer::bind(&config)?, AtomicBool::new(false));
    std::thread::scope(|scope| {
        scope.spawn(|| server.run(&|_| Some(Box::new(TestCard::new())), &stop));
        let address = config.address_of(0)?;
        let flown = fly(DroneConfig::at(address));
        stop.store(true, Ordering::Relaxed);
        flown
    })
}
