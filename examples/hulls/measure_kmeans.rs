//! Problem: what does K-means cost, and how low is its inertia, by each method and seeding?
//!
//! Run: `cargo run --release -p examples --example measure_kmeans` for the recorded apartment (needs the data folder,
//! `EXPLORER_DATA`), or with `FIRST COUNT POINTS` for generated ones: `... 101 3 42500`. A last argument is a folder that the
//! points are written to, one `x y z` a line, for other programs.
//! Prints for K = 300 and 1,000 the processor time of a run, averaged over twenty seeds, and the inertia of these, mean and worst.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

mod cpu_clock;
#[allow(dead_code, reason = "queries are for planners")]
mod scene;

use std::error::Error;

use cpu_clock::CpuClock;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use scene::{Place, Scene};
use sparse_to_obstacles::{KMeansConfig, KMeansError, KMeansMethod, KMeansSeeding, kmeans};

const SEEDS: u64 = 20;
const CLUSTERS: [usize; 2] = [300, 1000];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let scenes: Vec<Scene> = match &arguments[..] {
        [] | [_] => scene::recorded()?.into_iter().collect(),
        [first, count, points] | [first, count, points, _] => {
            let (first, count): (u64, u64) = (first.parse()?, count.parse()?);
            let scenes = (first..first + count).map(|seed| scene::generated(seed, points.parse()?));
            scenes.collect::<Result<_, Box<dyn Error>>>()?
        }
        _ => return Err("give [FIRST COUNT POINTS] [FOLDER]".into()),
    };
    println!("| apartment | points | K | K-means | CPU time, s | inertia, mean | worst |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for scene in &scenes {
        if let (1 | 4, Some(folder)) = (arguments.len(), arguments.last()) {
            scene.write(folder.as_ref())?;
        }
        for clusters in CLUSTERS {
            for (name, config) in rows(clusters) {
                let (seconds, inertias) = measure(&scene.points, &config)?;
                println!(
                    "| {} | {} | {clusters} | {name} | {seconds:.4} | {:.1} | {:.1} |",
                    scene.name,
                    scene.points.len(),
                    inertias.iter().sum::<f64>() / inertias.len() as f64,
                    inertias.iter().copied().fold(0.0, f64::max),
                );
            }
        }
    }
    Ok(())
}

/// The methods, then the seedings with a single pass after them.
fn rows(clusters: usize) -> [(&'static str, KMeansConfig); 7] {
    let plain = KMeansConfig::plain(clusters);
    let swaps = KMeansConfig {
        clusters,
        ..KMeansConfig::default()
    };
    let by = |method| KMeansConfig {
        method,
        ..plain.clone()
    };
    let once = |seeding| KMeansConfig {
        seeding,
        max_iterations: 1,
        ..plain.clone()
    };
    let parallel = KMeansSeeding::Parallel {
        rounds: 5,
        oversampling: 2.0,
    };
    [
        ("default (swaps)", swaps),
        ("plain, accelerated", plain.clone()),
        ("plain, Lloyd", by(KMeansMethod::Lloyd)),
        (
            "plain, mini-batch of 1,024",
            by(KMeansMethod::MiniBatch { batch: 1024 }),
        ),
        (
            "k-means++, one pass",
            once(KMeansSeeding::PlusPlus { trials: Some(1) }),
        ),
        (
            "greedy k-means++, one pass",
            once(KMeansSeeding::PlusPlus { trials: None }),
        ),
        (r"k-means\|\|, one pass", once(parallel)),
    ]
}

/// Processor seconds of a run, averaged over the seeds, and the inertia of each.
fn measure(points: &[Place], config: &KMeansConfig) -> Result<(f64, Vec<f64>), KMeansError> {
    let begun = CpuClock::start();
    let inertias: Vec<f64> = (1..=SEEDS)
        .map(|seed| Ok(kmeans(points, config, &mut Pcg64::seed_from_u64(seed))?.inertia))
        .collect::<Result<_, KMeansError>>()?;
    Ok((begun.seconds() / SEEDS as f64, inertias))
}
