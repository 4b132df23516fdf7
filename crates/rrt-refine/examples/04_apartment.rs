//! Fifty queries through the doors of a furnished apartment: planning and refining against its true boxes.
//!
//! Needs the data folder (`EXPLORER_DATA`). A ball of 0.15 m, exact swept checks. Times are the best of three runs of a
//! query, then the median over the queries; lengths are over the shorter of the two RRT*. Prints the table of docs/measurements.md:
//! `cargo run --release -p rrt-refine --example 04_apartment`

#[path = "../tests/scene/mod.rs"]
mod scene;
mod stopwatch;

use std::error::Error;

use rand_pcg::Pcg64;
use rrt_refine::refine::{TautConfig, dag, rope, taut};
use rrt_refine::{
    FindPathConfig, Path, Plan, Query, RefineStop, Refined, RrtConfig, RrtStar, RrtStarConfig,
    find_path, rrt, rrt_connect,
};
use stopwatch::{measure, now};

fn main() -> Result<(), Box<dyn Error>> {
    let Some((world, queries)) = scene::apartment() else {
        return Ok(());
    };
    let free = |a: &[f64; 3], b: &[f64; 3]| world.is_free(a, b);
    let config = RrtConfig::default();

    let single = |query: &Query<3>, rng: &mut Pcg64| rrt(query, &free, &config, rng);
    let double = |query: &Query<3>, rng: &mut Pcg64| rrt_connect(query, &free, &config, rng);
    let mut star_config = RrtStarConfig::default();
    star_config.rrt.max_iterations = usize::MAX;
    star_config.rrt.max_nodes = usize::MAX;
    let star = |informed| {
        let config = RrtStarConfig {
            informed,
            ..star_config
        };
        let free = &free;
        move |query: &Query<3>, rng: &mut Pcg64| {
            let begun = now();
            let mut search = RrtStar::new(query, free, &config)?;
            Ok(search.advance(rng, |_| begun.elapsed().as_millis() >= 50))
        }
    };
    let best_of_six = |query: &Query<3>, rng: &mut Pcg64| {
        let found = find_path(query, &free, &FindPathConfig::default(), rng)?;
        Ok(Plan {
            path: found.path,
            checks: found.checks,
            ..found.plan
        })
    };
    let shortest = |path: &_| Ok(dag(path, &free));
    let pulled = |path: &_| taut(path, &free, &TautConfig::default());
    let two_rounds = TautConfig {
        max_rounds: 2,
        ..TautConfig::default()
    };
    let pulled_twice = |path: &_| taut(path, &free, &two_rounds);
    let roped = |path: &_| rope(path, &free, &Default::default());

    stopwatch::print(&[
        (
            "RRT* for 50 ms, DAG",
            measure(&queries, star(false), shortest)?,
        ),
        (
            "Informed RRT* for 50 ms, DAG",
            measure(&queries, star(true), shortest)?,
        ),
        ("RRT, DAG", measure(&queries, single, shortest)?),
        ("RRT-Connect, DAG", measure(&queries, double, shortest)?),
        (
            "RRT-Connect, taut in 2 rounds",
            measure(&queries, double, pulled_twice)?,
        ),
        ("RRT-Connect, taut", measure(&queries, double, pulled)?),
        (
            "**`find_path`** (RRT-Connect and taut, then anything shorter)",
            measure(&queries, best_of_six, |path| Ok(unrefined(path)))?,
        ),
        ("RRT-Connect, rope", measure(&queries, double, roped)?),
    ]);
    Ok(())
}

/// The path as it is, refined already.
fn unrefined(path: &Path<3>) -> Refined<3> {
    Refined {
        path: path.clone(),
        checks: 0,
        length_before: path.length(),
        stop: RefineStop::Done,
    }
}
