//! Problem: explore rooms that nobody has seen, with one camera and a Tello's commands, and land when nothing is left.
//!
//! Run: `cargo run --release -p examples --example explore_simulated [WORLD] [SEED]`
//! Prints the mission's story as it happens, and at the end what only the simulator can know: how much was seen, and whether
//! anything was touched. WORLD is a preset of `indoor_sim::PRESETS` (apartment, two-rooms, ...) or generated:SEED.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

use std::error::Error;

use explorer::{MissionConfig, SimulatedFlight};
use indoor_sim::{SimConfig, World};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments
        .next()
        .unwrap_or_else(|| "one-door-room".to_owned());
    let seed: u64 = arguments.next().map_or(Ok(1), |word| word.parse())?;

    let world = World::named(&name, seed)?;
    let (simulator, mission) = (SimConfig::default(), MissionConfig::default());
    let mut flight = SimulatedFlight::new(world, simulator, mission, seed)?;

    let mut told = 0;
    while !flight.is_over() {
        flight.step(&mut ()); // a tenth of a second: frame, telemetry and pose in, a command out
        let log = &flight.mission().record().log;
        for logged in &log[told..] {
            println!("{:7.1} s  {}", logged.time.as_secs_f64(), logged.event);
        }
        told = log.len();
    }

    let summary = flight.summary();
    println!("outcome      {}", summary.outcome);
    println!("seen         {:.1} %", 100.0 * summary.coverage);
    println!("flown        {:.1} m", summary.path_length);
    println!("scans        {}", summary.scans);
    println!("collisions   {}", summary.collisions);
    if let Some(clearance) = summary.min_clearance {
        println!("clearance    {clearance:.2} m at least, from the drone's centre");
    }
    Ok(())
}
