//! Problem: which points of a sparse map are wrong? Five ways to tell, judged by the truth that only a simulator has.
//!
//! Run: `cargo run --release -p examples --example compare_outlier_removal [WORLD] [SEED]`
//! Turns a simulated drone once round, takes the map of its SLAM, and prints precision, recall and F1 of what each way removes.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

use core::time::Duration;
use std::collections::HashMap;
use std::error::Error;

use indoor_sim::{SimConfig, Simulator, World};
use slam_bridge::{Map, SlamSource};
use submodular_minimax::baseline::{dbscan, lof, radius, statistical};
use submodular_minimax::{OutlierConfig, Views, remove_outliers};
use tello_sdk::{Command, Distance, Turn};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "apartment".to_owned());
    let seed: u64 = arguments.next().map_or(Ok(1), |word| word.parse())?;
    let mut sim = Simulator::new(World::named(&name, seed)?, SimConfig::default(), seed)?;
    scan(&mut sim)?;
    let map = sim.slam_ref().map();
    let wrong: Vec<bool> = (map.points.iter())
        .map(|point| sim.slam_ref().point_truth(point.id))
        .map(|truth| truth.is_some_and(|truth| truth.outlier.is_some()))
        .collect();
    let points = map.positions();
    let total = wrong.iter().filter(|&&wrong| wrong).count();
    println!("{} points, {total} of them wrong", points.len());
    println!("method                        removed  precision  recall     F1");

    let config = OutlierConfig::default();
    let seen = remove_outliers(&points, Some(&views(&map)?), &config)?;
    row("submodular, who saw what", &seen.removed, &wrong);
    let blind = remove_outliers(&points, None, &config)?;
    row("submodular, points alone", &blind.removed, &wrong);
    let sor = statistical(&points, &Default::default())?;
    row("SOR", &sor.removed, &wrong);
    let ror = radius(&points, &Default::default())?;
    row("ROR", &ror.removed, &wrong);
    let lof = lof(&points, &Default::default())?;
    row("LOF", &lof.removed, &wrong);
    let clusters = dbscan(&points, &Default::default())?;
    row("DBSCAN", &clusters.removed, &wrong);
    Ok(())
}

/// Takes off and turns once round, going up and down.
fn scan(sim: &mut Simulator) -> Result<(), Box<dyn Error>> {
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

/// Which camera position saw which point.
fn views(map: &Map) -> Result<Views, Box<dyn Error>> {
    let place: HashMap<_, _> = map
        .keyframes
        .iter()
        .enumerate()
        .map(|(i, k)| (k.id, i))
        .collect();
    let centers = map
        .keyframes
        .iter()
        .map(|keyframe| keyframe.center().into());
    let observers = (map.points.iter()).map(|point| {
        point
            .observers
            .iter()
            .filter_map(|id| place.get(id).copied())
            .collect()
    });
    Ok(Views::new(centers.collect(), observers.collect())?)
}

fn row(name: &str, removed: &[usize], wrong: &[bool]) {
    let hits = removed.iter().filter(|&&index| wrong[index]).count() as f64;
    let precision = hits / removed.len().max(1) as f64;
    let recall = hits / wrong.iter().filter(|&&wrong| wrong).count().max(1) as f64;
    let f1 = 2.0 * precision * recall / (precision + recall).max(1e-12);
    println!(
        "{name:28} {:8} {precision:10.3} {recall:7.3} {f1:6.3}",
        removed.len()
    );
}
