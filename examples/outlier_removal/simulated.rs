//! The map that a simulated drone's SLAM makes during one turn, with its truth.

use core::time::Duration;
use std::error::Error;

use indoor_sim::{SimConfig, Simulator, World};
use slam_bridge::{Map, SlamSource};
use tello_sdk::{Command, Distance, Turn};

use crate::score::Labels;

/// The map of one turn in a simulated world, and which points are outliers.
pub(crate) fn scan(world: &str, seed: u64) -> Result<(Map, Labels), Box<dyn Error>> {
    let mut sim = Simulator::new(World::named(world, seed)?, SimConfig::default(), seed)?;
    turn_round(&mut sim)?;
    let map = sim.slam_ref().map();
    let truth = (map.points.iter())
        .map(|point| sim.slam_ref().point_truth(point.id))
        .map(|truth| Some(truth.is_some_and(|truth| truth.outlier.is_some())))
        .collect();
    Ok((map, truth))
}

/// Takes off and turns once round, going up and down.
fn turn_round(sim: &mut Simulator) -> Result<(), Box<dyn Error>> {
    let climb = Distance::from_cm(40)?;
    let turn = Command::Clockwise(Turn::from_degrees(20)?);
    let steps = (0..9).flat_map(|_| {
        [
            Command::Up(climb),
            turn.clone(),
            Command::Down(climb),
            turn.clone(),
        ]
    });
    for command in core::iter::once(Command::TakeOff).chain(steps) {
        sim.send(&command)?;
        while sim.poll_reply().is_none() {
            sim.advance(Duration::from_millis(100));
        }
    }
    Ok(())
}
