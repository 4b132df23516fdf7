//! Problem: what do obstacles from a sparse map cost, how short are the paths among them, and do they clip a hull?
//!
//! Fifty queries through a furnished apartment, a ball of 0.15 m, exact swept checks.
//! Run: `cargo run --release -p examples --example plan_among_hulls` for the recorded apartment (needs the data folder,
//! `EXPLORER_DATA`), or with `FIRST COUNT POINTS` for generated ones: `... 101 5 42500`. A fourth argument is a folder that the
//! points are written to, one `x y z` a line, for other programs.
//! Prints for K = 300 and 1,000 what clusters, hulls and queries cost, and `find_path` with one attempt and with its twelve against the
//! best of RRT* at 50 ms. Times of clusters and hulls, and the 50 ms, are processor time; all times are the best of five runs.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

mod cpu_clock;
mod scene;

use std::error::Error;

use cpu_clock::CpuClock;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rrt_refine::refine::{TautConfig, taut};
use rrt_refine::{FindPathConfig, Path, Query, RrtStar, RrtStarConfig, find_path};
use scene::{Place, RADIUS, Scene};
use sparse_to_obstacles::{KMeansConfig, ObstacleSet, kmeans};

/// A path clips a hull that it comes this much nearer than the radius.
const TOLERANCE: f64 = 1e-3;
const STAR_SECONDS: f64 = 0.05;
const CLUSTERS: [usize; 2] = [300, 1000];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let scenes = match &arguments[..] {
        [] => scene::recorded()?.into_iter().collect(),
        [first, count, points, ..] => {
            let (first, count): (u64, u64) = (first.parse()?, count.parse()?);
            let scenes = (first..first + count).map(|seed| scene::generated(seed, points.parse()?));
            scenes.collect::<Result<Vec<_>, Box<dyn Error>>>()?
        }
        _ => return Err("give nothing, or FIRST COUNT POINTS [FOLDER]".into()),
    };
    if let Some(folder) = arguments.get(3) {
        for scene in &scenes {
            scene.write(folder.as_ref())?;
        }
    }
    println!(
        "| apartment | points | K | K-means, s | inertia | hulls, ms | 0.5 m motion, us | 3 m, us |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut built = Vec::new();
    for scene in &scenes {
        for clusters in CLUSTERS {
            built.push((scene, build(scene, clusters)?));
        }
    }
    println!();
    println!(
        "| apartment | K | asked | solved | clip a hull | median, ms | length / RRT*, median | mean | worst |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for (scene, hulls) in &built {
        let best: Vec<Option<f64>> = scene.queries.iter().map(|q| star(hulls, q)).collect();
        for attempts in [1, FindPathConfig::default().attempts] {
            plan_all(scene, hulls, attempts, &best);
        }
    }
    Ok(())
}

/// Seconds of the fastest of five runs by `clock`, and what it gave.
fn fastest<T>(clock: fn(&CpuClock) -> f64, mut run: impl FnMut() -> T) -> (f64, T) {
    let mut timed = || {
        let begun = CpuClock::start();
        let result = run();
        (clock(&begun), result)
    };
    let first = timed();
    (0..4).fold(first, |best, _| {
        let next = timed();
        if next.0 < best.0 { next } else { best }
    })
}

/// Clusters and hulls, with a row of what they cost.
fn build(scene: &Scene, clusters: usize) -> Result<ObstacleSet, Box<dyn Error>> {
    let config = KMeansConfig {
        clusters,
        ..KMeansConfig::default()
    };
    let (seconds, clustering) = fastest(CpuClock::seconds, || {
        kmeans(&scene.points, &config, &mut Pcg64::seed_from_u64(1))
    });
    let clustering = clustering?;
    let (hull_seconds, hulls) = fastest(CpuClock::seconds, || {
        ObstacleSet::from_clustering(&scene.points, &clustering)
    });
    let hulls = hulls?;
    let [short, long] = [0.5, 3.0].map(|length| {
        let motions = motions(scene, length);
        let free = || {
            let free = |m: &&[Place; 2]| hulls.motion_is_free(m[0], m[1], RADIUS);
            motions.iter().filter(free).count()
        };
        fastest(CpuClock::wall_seconds, free).0 / motions.len() as f64 * 1e6
    });
    println!(
        "| {} | {} | {} | {seconds:.3} | {:.1} | {:.1} | {short:.2} | {long:.2} |",
        scene.name,
        scene.points.len(),
        hulls.len(),
        clustering.inertia,
        hull_seconds * 1e3,
    );
    Ok(hulls)
}

/// Level motions of this length from anywhere in the bounds.
fn motions(scene: &Scene, length: f64) -> Vec<[Place; 2]> {
    let mut rng = Pcg64::seed_from_u64(2);
    (0..2000)
        .map(|_| {
            let a = scene.bounds.sample(&mut rng);
            let turn = std::f64::consts::TAU * rng.random::<f64>();
            let b = [a[0] + length * turn.cos(), a[1] + length * turn.sin(), a[2]];
            [a, b]
        })
        .collect()
}

fn plan_all(scene: &Scene, hulls: &ObstacleSet, attempts: usize, best: &[Option<f64>]) {
    let (mut times, mut ratios, mut clipping) = (Vec::new(), Vec::new(), 0);
    for (query, best) in scene.queries.iter().zip(best) {
        let (seconds, path) = fastest(CpuClock::wall_seconds, || find(hulls, query, attempts));
        let Some(path) = path else { continue };
        times.push(seconds * 1e3);
        clipping += usize::from(clips(hulls, &path));
        ratios.extend(best.map(|best| path.length() / best));
    }
    times.sort_by(f64::total_cmp);
    ratios.sort_by(f64::total_cmp);
    let middle = |values: &[f64]| values.get(values.len() / 2).copied().unwrap_or(f64::NAN);
    println!(
        "| {} | {} | {attempts} | {} of {} ({} by RRT*) | {clipping} | {:.3} | {:.3} | {:.3} | {:.3} |",
        scene.name,
        hulls.len(),
        times.len(),
        scene.queries.len(),
        best.iter().flatten().count(),
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
        let begun = CpuClock::start();
        let mut search = RrtStar::new(query, &free, &config).ok()?;
        let mut rng = Pcg64::seed_from_u64(1);
        let plan = search.advance(&mut rng, |_| begun.seconds() >= STAR_SECONDS);
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
