//! Emulated drones on UDP until interrupted: `emulator [ADDRESS] [COMMAND_PORT] [COUNT] [1.3|2.0|3.0|binary] [ideal|wifi|lossy] [real|fast]`
//!
//! With the feature `video` the drones have a camera that sends real H.264.
//!
//! Input: the arguments, by default `127.0.0.2 18889 1 2.0 ideal`. Output: a line with the first address, then nothing.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::sync::atomic::AtomicBool;
use tello_sdk::SdkVersion;
use tello_sdk::emulator::udp::{ServeConfig, serve_with_cameras};
use tello_sdk::emulator::{Faults, Timing, VideoSource};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let argument = |index: usize| arguments.get(index).map(String::as_str);
    let mut config = ServeConfig::default();
    if let Some(address) = argument(0) {
        config.address = address.parse()?;
    }
    if let Some(port) = argument(1) {
        config.command_port = port.parse()?;
    }
    if let Some(count) = argument(2) {
        config.count = count.parse()?;
    }
    config.drone.version = match argument(3).unwrap_or("2.0") {
        "1.3" => SdkVersion::V1_3,
        "2.0" => SdkVersion::V2_0,
        "3.0" => SdkVersion::V3_0,
        "binary" => {
            config.binary = true;
            SdkVersion::V2_0
        }
        other => return Err(format!("SDK {other} is not 1.3, 2.0, 3.0 or binary").into()),
    };
    config.drone.faults = match argument(4).unwrap_or("ideal") {
        "ideal" => Faults::default(),
        "wifi" => Faults::wifi(),
        "lossy" => Faults::lossy(),
        other => return Err(format!("faults {other} are not ideal, wifi or lossy").into()),
    };
    if argument(5) == Some("fast") {
        config.drone.timing = Timing::fast();
    }
    println!(
        "serving {} drone(s) from {}:{}",
        config.count, config.address, config.command_port
    );
    serve_with_cameras(&config, &camera, &AtomicBool::new(false))?;
    Ok(())
}

#[cfg(feature = "video")]
fn camera(_drone: u8) -> Option<Box<dyn VideoSource>> {
    let camera = tello_sdk::video::TestCard::new();
    Some(Box::new(camera))
}

#[cfg(not(feature = "video"))]
fn camera(_drone: u8) -> Option<Box<dyn VideoSource>> {
    None
}
