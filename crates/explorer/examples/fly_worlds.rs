//! Flies missions in several worlds and prints a row for each: `cargo run --release -p explorer --example fly_worlds -- WORLD SEED RUNS`.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

use explorer::{MissionConfig, SimulatedFlight};
use indoor_sim::{SimConfig, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let world = arguments.next().unwrap_or_else(|| "apartment".to_owned());
    let first: u64 = arguments.next().map_or(Ok(1), |word| word.parse())?;
    let runs: u64 = arguments.next().map_or(Ok(1), |word| word.parse())?;
    let verbose = arguments.next().is_some();
    for seed in first..first + runs {
        let world = World::named(&world, seed)?;
        let mut flight =
            SimulatedFlight::new(world, SimConfig::default(), MissionConfig::default(), seed)?;
        while !flight.is_over() {
            flight.step(&mut ());
        }
        if verbose {
            for logged in flight.mission().record().log {
                println!("{:7.1} s  {}", logged.time.as_secs_f64(), logged.event);
            }
            for collision in &flight.simulator().truth().collisions {
                let solid = &flight.simulator().world().solids()[collision.solid];
                println!("collision at {:?} with {solid:?}", collision.position);
            }
        }
        println!("seed {seed}: {:?}", flight.summary());
    }
    Ok(())
}
