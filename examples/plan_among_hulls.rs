//! Problem: how fast and how short are paths among the hulls of a sparse map, and do they clip a hull?
//!
//! Fifty queries through a furnished apartment (needs the data folder, `EXPLORER_DATA`), a ball of 0.15 m, exact swept checks.
//! Run: `cargo run --release -p examples --example plan_among_hulls`
//! Prints a table for K = 300 and 1,000: `find_path` with one attempt and with its six, against the best of RRT* at 50 ms.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]
#![expect(clippy::disallowed_methods, reason = "it measures time")]

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use rand::SeedableRng;
use rand_pcg::Pcg64;
use rrt_refine::refine::{TautConfig, taut};
use rrt_refine::{Bounds, FindPathConfig, Path, Query, RrtStar, RrtStarConfig, find_path};
use serde_json::Value;
use sparse_to_obstacles::{ObstacleConfig, ObstacleSet};

type Place = [f64; 3];

const RADIUS: f64 = 0.15;
/// A path clips a hull that it comes this much nearer than the radius.
const TOLERANCE: f64 = 1e-3;
const STAR_MS: u128 = 50;

struct Scene {
    points: Vec<Place>,
    queries: Vec<Query<3>>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::var("EXPLORER_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared").to_owned());
    let stem = PathBuf::from(folder).join("data/synthetic-apartment/apt_10k_o15");
    if !stem.with_extension("npy").exists() {
        println!(
            "skipped: {} is not there (set EXPLORER_DATA)",
            stem.display()
        );
        return Ok(());
    }
    let scene = load(&stem)?;
    println!(
        "| K | asked | solved | clip a hull | median, ms | length / RRT*, median | mean | worst |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for clusters in [300, 1000] {
        let mut rng = Pcg64::seed_from_u64(1);
        let config = ObstacleConfig::with_clusters(clusters);
        let hulls = ObstacleSet::from_points(&scene.points, &config, &mut rng)?;
        let best: Vec<Option<f64>> = scene
            .queries
            .iter()
            .map(|query| star(&hulls, query))
            .collect();
        for attempts in [1, 6] {
            row(&scene, &hulls, attempts, &best);
        }
    }
    Ok(())
}

fn row(scene: &Scene, hulls: &ObstacleSet, attempts: usize, best: &[Option<f64>]) {
    let (mut times, mut ratios, mut clipping) = (Vec::new(), Vec::new(), 0);
    for (query, best) in scene.queries.iter().zip(best) {
        let begun = Instant::now();
        let path = find(hulls, query, attempts);
        let elapsed = begun.elapsed().as_secs_f64() * 1e3;
        let Some(path) = path else { continue };
        times.push(elapsed);
        clipping += usize::from(clips(hulls, &path));
        ratios.extend(best.map(|best| path.length() / best));
    }
    times.sort_by(f64::total_cmp);
    ratios.sort_by(f64::total_cmp);
    let middle = |values: &[f64]| values.get(values.len() / 2).copied().unwrap_or(f64::NAN);
    println!(
        "| {} | {attempts} | {} of {} | {clipping} | {:.3} | {:.3} | {:.3} | {:.3} |",
        hulls.len(),
        times.len(),
        scene.queries.len(),
        middle(&times),
        middle(&ratios),
        ratios.iter().sum::<f64>() / ratios.len() as f64,
        ratios.last().copied().unwrap_or(f64::NAN),
    );
}

/// The default pipeline with so many attempts.
fn find(hulls: &ObstacleSet, query: &Query<3>, attempts: usize) -> Option<Path<3>> {
    let free = |a: &Place, b: &Place| hulls.motion_is_free(*a, *b, RADIUS);
    let config = FindPathConfig {
        attempts,
        ..FindPathConfig::default()
    };
    let found = find_path(query, &free, &config, &mut Pcg64::seed_from_u64(1));
    found.ok()?.path
}

/// Length of the shorter answer of RRT* and Informed RRT* after 50 ms each, refined.
fn star(hulls: &ObstacleSet, query: &Query<3>) -> Option<f64> {
    let free = |a: &Place, b: &Place| hulls.motion_is_free(*a, *b, RADIUS);
    let lengths = [false, true].into_iter().filter_map(|informed| {
        let mut config = RrtStarConfig {
            informed,
            ..RrtStarConfig::default()
        };
        config.rrt.max_iterations = usize::MAX;
        config.rrt.max_nodes = usize::MAX;
        let begun = Instant::now();
        let mut search = RrtStar::new(query, &free, &config).ok()?;
        let mut rng = Pcg64::seed_from_u64(1);
        let plan = search.advance(&mut rng, |_| begun.elapsed().as_millis() >= STAR_MS);
        let refined = taut(&plan.path?, &free, &TautConfig::default()).ok()?;
        Some(refined.path.length())
    });
    lengths.reduce(f64::min)
}

/// Does the ball come too near to a hull at any millimetre of the path?
fn clips(hulls: &ObstacleSet, path: &Path<3>) -> bool {
    let steps = (path.length() / 1e-3).ceil() as usize;
    (0..=steps).any(|step| {
        let place = path.point_at(1e-3 * step as f64);
        hulls.clearance(place, place) < RADIUS - TOLERANCE
    })
}

fn load(stem: &std::path::Path) -> Result<Scene, Box<dyn Error>> {
    let payload = |extension: &str| -> Result<Vec<u8>, Box<dyn Error>> {
        let bytes = std::fs::read(stem.with_extension(extension))?;
        // The header of a .npy file: its length stands in bytes 8 and 9.
        let start = match bytes.get(8..10) {
            Some(length) => 10 + usize::from(u16::from_le_bytes([length[0], length[1]])),
            None => return Err("not a .npy file".into()),
        };
        Ok(bytes.get(start..).unwrap_or_default().to_vec())
    };
    let number = |c: &[u8]| f64::from(f32::from_le_bytes([c[0], c[1], c[2], c[3]]));
    let (points, labels) = (payload("npy")?, payload("labels.npy")?);
    // Label 0 is a point of a surface, anything else an outlier.
    let points = points.chunks_exact(12).zip(labels);
    let points = points.filter(|&(_, label)| label == 0);
    let points = points
        .map(|(c, _)| [0, 4, 8].map(|at| number(&c[at..])))
        .collect();
    let scene: Value = serde_json::from_slice(&std::fs::read(stem.with_extension("scene.json"))?)?;
    let vector = |value: &Value, from: usize| {
        [0, 1, 2].map(|axis| value[from + axis].as_f64().unwrap_or(f64::NAN))
    };
    let bounds = Bounds::new(vector(&scene["bounds"], 0), vector(&scene["bounds"], 3))?;
    let queries = scene["queries"].as_array().ok_or("no queries")?;
    let queries = queries
        .iter()
        .map(|query| Query::new(vector(&query[0], 0), vector(&query[1], 0), bounds))
        .collect();
    Ok(Scene { points, queries })
}
