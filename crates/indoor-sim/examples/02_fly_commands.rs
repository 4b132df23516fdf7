//! Problem: fly a Tello-like drone by commands, look round, and read what SLAM makes of it.
//!
//! Run: `cargo run --release -p indoor-sim --example 02_fly_commands [WORLD] [SEED]`
//! Prints the state after each command, then the map and the truth.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

use core::time::Duration;
use std::error::Error;

use indoor_sim::slam_bridge::SlamSource;
use indoor_sim::{SimConfig, Simulator, World, coverage};
use tello_sdk::{Command, Distance, Turn};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_else(|| "apartment".to_owned());
    let seed: u64 = args.next().map_or(Ok(1), |text| text.parse())?;
    let mut sim = Simulator::new(World::named(&name, seed)?, SimConfig::default(), seed)?;
    let (up, down) = (
        Command::Up(Distance::from_cm(40)?),
        Command::Down(Distance::from_cm(40)?),
    );
    let turn = Command::Clockwise(Turn::from_degrees(20)?);
    let mut commands = vec![Command::TakeOff];
    for step in 0..18 {
        commands.push(if step % 2 == 0 {
            up.clone()
        } else {
            down.clone()
        });
        commands.push(turn.clone());
    }
    commands.push(Command::Land);
    for command in &commands {
        fly(&mut sim, command)?;
    }
    let map = sim.slam_ref().map();
    let seen = coverage(sim.world(), &sim.truth().positions(0.2), 5.0);
    println!(
        "map: {} points, {} keyframes",
        map.points.len(),
        map.keyframes.len()
    );
    println!("seen: {:.1} % of the reachable space", 100.0 * seen);
    println!(
        "collisions: {}, {}",
        sim.truth().collisions.len(),
        sim.truth().min_clearance
    );
    Ok(())
}

/// Sends a command and waits for its reply.
fn fly(sim: &mut Simulator, command: &Command) -> Result<(), Box<dyn Error>> {
    sim.send(command)?;
    let reply = loop {
        sim.advance(Duration::from_millis(100));
        if let Some(reply) = sim.poll_reply() {
            break reply;
        }
    };
    let (mut state, mut tracked) = (sim.slam_ref().state(), 0);
    while let Some(update) = sim.slam().poll() {
        (state, tracked) = (update.state, update.tracked_points);
    }
    let battery = sim
        .telemetry()
        .battery
        .map_or(0, |reading| reading.value.percent());
    println!(
        "{:6.2} s  {command}: {}  {state:?} {tracked}  {battery} %",
        sim.now().as_secs_f64(),
        reply.raw
    );
    Ok(())
}
