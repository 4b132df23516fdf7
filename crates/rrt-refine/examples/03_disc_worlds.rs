//! How short each refiner makes the paths of RRT, and for how many checks, over 60 random worlds of discs.
//!
//! A square of 20 with 55 discs of radius 0.5 to 1.2, RRT with a step of 0.8 from corner to corner. Lengths are over the
//! best of all refiners in that world. Prints the table of docs/measurements.md:
//! `cargo run --release -p rrt-refine --example 03_disc_worlds`

#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/planar/mod.rs"]
mod planar;

use std::error::Error;

use planar::DiscWorld;
use rand_pcg::Pcg64;
use rrt_refine::refine::{Places, ShortcutConfig, dag, greedy, rope, shortcut, taut};
use rrt_refine::{Path, Query, RrtConfig, rrt};

const WORLDS: usize = 60;
const NAMES: [&str; 8] = [
    "none (RRT)",
    "greedy, farthest first",
    "random vertex pairs, one a vertex",
    "100 random shortcuts",
    "**DAG**",
    "DAG, then 100 random shortcuts",
    "**taut** (starts with the DAG)",
    "rope, parts of 0.4 (starts with the DAG)",
];

/// Length and checks of every refiner on one path.
fn compare(world: &DiscWorld, path: &Path<2>) -> Result<Vec<(f64, usize)>, Box<dyn Error>> {
    let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
    let any = ShortcutConfig::default();
    let (attempts, between) = (path.points().len(), Places::Vertices);
    let random = |path, config| shortcut(path, &free, config, &mut Pcg64::new(1, 1));
    let (greedy, dag) = (greedy(path, &free), dag(path, &free));
    let (mut after, hundred) = (random(&dag.path, &any), random(path, &any));
    after.checks += dag.checks;
    let pairs = random(path, &ShortcutConfig { attempts, between });
    let taut = taut(path, &free, &Default::default())?;
    let rope = rope(path, &free, &Default::default())?;
    let all = [greedy, pairs, hundred, dag, after, taut, rope];
    let refined = all.into_iter().map(|r| (r.path.length(), r.checks));
    Ok(std::iter::once((path.length(), 0)).chain(refined).collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut table = NAMES.map(|name| (name, Vec::new(), 0));
    let mut config = RrtConfig::paper();
    config.step_length = 0.8;
    for seed in 1..=WORLDS as u64 {
        let (world, start, goal) = DiscWorld::random(seed, 20.0, 55);
        let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
        let rng = &mut Pcg64::new(seed.into(), 5);
        let query = Query::new(start, goal, world.bounds());
        let plan = rrt(&query, &free, &config, rng)?;
        let rows = compare(&world, &plan.path.ok_or("a world without a path")?)?;
        let best = rows.iter().map(|row| row.0).fold(f64::INFINITY, f64::min);
        for ((length, checks), row) in rows.into_iter().zip(&mut table) {
            row.1.push(length / best);
            row.2 += checks;
        }
    }
    println!("| refiner | length / best, mean | 95th percentile | checks |");
    println!("| --- | --- | --- | --- |");
    for (name, mut ratios, checks) in table {
        ratios.sort_by(f64::total_cmp);
        let mean = ratios.iter().sum::<f64>() / WORLDS as f64;
        let high = ratios[WORLDS * 95 / 100];
        println!("| {name} | {mean:.3} | {high:.3} | {} |", checks / WORLDS);
    }
    Ok(())
}
