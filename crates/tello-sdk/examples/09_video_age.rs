//! How old is the newest decoded picture? Reads the time painted into the emulated drone's test card (feature `video`).
//!
//! Input: `ADDRESS:PORT` of `explorer emulate` on this machine (default 127.0.0.2:18889), which paints the time of day.
//! Output: time to the first picture, then the age at which pictures were there, decoded: median, 95 %, longest.
//! Exit code 1 if the 95th percentile is above 60 ms.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::net::SocketAddr;
use std::time::{Duration, Instant, SystemTime};
use tello_sdk::video::Decoder;
use tello_sdk::{Command, Drone, DroneConfig, VideoConfig, VideoStream};

fn main() -> Result<(), Box<dyn Error>> {
    let argument = std::env::args().nth(1);
    let address: SocketAddr = argument.as_deref().unwrap_or("127.0.0.2:18889").parse()?;
    let stream = VideoStream::open(VideoConfig {
        drone: Some(address.ip()),
        ..VideoConfig::default()
    })?;
    let drone = Drone::connect(DroneConfig::at(address))?;
    let mut decoder = Decoder::new()?;
    let start = Instant::now();
    drone.execute(Command::StreamOn)?;
    let (mut first, mut ages) = (None, Vec::new());
    while start.elapsed() < Duration::from_secs(10) {
        let Some(unit) = stream.next(Duration::from_secs(2)) else {
            continue;
        };
        let Some(picture) = decoder.decode(&unit) else {
            continue;
        };
        first = first.or(Some(start.elapsed()));
        let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH)?;
        ages.push(
            picture
                .card()
                .ok_or("the picture is no test card")?
                .age(now),
        );
    }
    drone.execute(Command::StreamOff)?;
    ages.sort();
    let at = |part: usize| {
        ages.get(ages.len() * part / 100)
            .copied()
            .unwrap_or_default()
    };
    let (median, p95, longest) = (at(50), at(95), ages.last().copied().unwrap_or_default());
    println!(
        "tello-sdk: first picture after {:?}; {} pictures, age median {median:?}, p95 {p95:?}, longest {longest:?}",
        first.unwrap_or_default(),
        ages.len()
    );
    if ages.len() > 200 && p95 <= Duration::from_millis(60) {
        Ok(())
    } else {
        Err("too few or too old pictures".into())
    }
}
