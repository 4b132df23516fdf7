//! Problem: how long does a long flight take to simulate, and how large does its map grow?
//!
//! Run: `time cargo run --release -p indoor-sim --example 03_ten_minutes [WORLD] [SEED]`
//! Scans on the spot for ten minutes (6,000 pictures) and prints the map's size and the battery.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

use core::time::Duration;
use std::error::Error;

use indoor_sim::slam_bridge::SlamSource;
use indoor_sim::{SimConfig, Simulator, World};
use tello_sdk::{Command, Distance, Turn};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_else(|| "apartment".to_owned());
    let seed: u64 = args.next().map_or(Ok(1), |text| text.parse())?;
    let mut sim = Simulator::new(World::named(&name, seed)?, SimConfig::default(), seed)?;
    let level = Distance::from_cm(40)?;
    let turn = Command::Clockwise(Turn::from_degrees(20)?);
    let cycle = [Command::Up(level), turn.clone(), Command::Down(level), turn];
    for command in core::iter::once(&Command::TakeOff).chain(cycle.iter().cycle()) {
        sim.send(command)?;
        while sim.poll_reply().is_none() {
            sim.advance(Duration::from_millis(100));
        }
        if sim.now() > Duration::from_secs(600) {
            break;
        }
    }
    let map = sim.slam_ref().map();
    let battery = sim
        .telemetry()
        .battery
        .map_or(0, |reading| reading.value.percent());
    println!(
        "{} landmarks, {} pictures",
        sim.world().landmarks().len(),
        sim.truth().trajectory.len()
    );
    println!(
        "map: {} points, {} keyframes",
        map.points.len(),
        map.keyframes.len()
    );
    println!(
        "battery: {battery} %, {:.0} m flown",
        sim.truth().path_length
    );
    Ok(())
}
