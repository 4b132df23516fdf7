//! Fifty queries through the doors of a furnished apartment: every one solved, no path touches a true box, and the refined
//! path of RRT-Connect is not longer than what RRT* finds with a hundred times the checks.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a broken expectation must fail the test"
)]

mod scene;

use rand_pcg::Pcg64;
use rrt_refine::refine::{RopeConfig, TautConfig, dag, rope, taut};
use rrt_refine::{Path, RrtConfig, RrtStarConfig, rrt, rrt_connect, rrt_star};
use scene::{BoxWorld, apartment, squared_gap};

/// Distance from the path to the nearest box, by points one millimetre apart: shares nothing with the swept check but the
/// distance of a point.
fn gap_by_points(world: &BoxWorld, path: &Path<3>) -> f64 {
    let dense = path.densified(1e-3).expect("a sensible step");
    dense
        .points()
        .iter()
        .flat_map(|p| {
            world
                .boxes
                .iter()
                .map(move |(min, max)| point_gap(p, min, max))
        })
        .fold(f64::INFINITY, f64::min)
}

fn point_gap(p: &[f64; 3], min: &[f64; 3], max: &[f64; 3]) -> f64 {
    let outside: f64 = (0..3)
        .map(|k| (p[k] - p[k].clamp(min[k], max[k])).powi(2))
        .sum();
    outside.sqrt()
}

#[test]
fn every_query_is_solved_without_a_touch_and_about_as_short_as_can_be() {
    let Some((world, queries)) = apartment() else {
        return;
    };
    let free = |a: &[f64; 3], b: &[f64; 3]| world.is_free(a, b);
    let config = RrtConfig::default();
    let mut star = RrtStarConfig::informed();
    star.rrt.max_iterations = 800;
    let (mut connect_total, mut star_total) = (0.0, 0.0);
    for (seed, query) in queries.iter().enumerate() {
        let rng = || Pcg64::new(seed as u128, 1);
        let single = rrt(query, &free, &config, &mut rng()).expect("fair");
        let double = rrt_connect(query, &free, &config, &mut rng()).expect("fair");
        let best = rrt_star(query, &free, &star, &mut rng()).expect("fair");
        let [single, double, best] = [single, double, best].map(|plan| plan.path.expect("solved"));
        let short = taut(&double, &free, &TautConfig::default())
            .expect("good parameters")
            .path;
        star_total += dag(&best, &free).path.length();
        connect_total += short.length();
        let sparse = dag(&double, &free).path;
        let roped = rope(&double, &free, &RopeConfig::default())
            .expect("good parameters")
            .path;
        for path in [&single, &double, &best, &short, &sparse, &roped] {
            assert_eq!(path.first_blocked(&free), None, "query {seed}");
            let gap = gap_by_points(&world, path);
            assert!(gap >= world.radius - 1e-9, "query {seed}: {gap}");
        }
    }
    let ratio = connect_total / star_total;
    println!("RRT-Connect and taut over Informed RRT* of 800 samples and DAG: {ratio:.3}");
    assert!(ratio <= 1.03, "{ratio}");
}

#[test]
fn swept_distances_agree_with_dense_points() {
    let box_ = ([0.0, 0.0, 0.0], [1.0, 2.0, 0.5]);
    let ends = [-1.3, -0.2, 0.4, 0.9, 1.7, 2.6];
    for (k, x) in ends.iter().enumerate() {
        for (l, y) in ends.iter().enumerate() {
            let from = [*x, *y, ends[(k + l) % 6]];
            let to = [ends[(k + 2) % 6], ends[(l + 3) % 6], ends[(2 * k + l) % 6]];
            let exact = squared_gap(&from, &to, &box_.0, &box_.1).sqrt();
            let dense = (0..=10_000)
                .map(|i| {
                    let t = f64::from(i) / 1e4;
                    let p = [0, 1, 2].map(|a| from[a] * (1.0 - t) + to[a] * t);
                    point_gap(&p, &box_.0, &box_.1)
                })
                .fold(f64::INFINITY, f64::min);
            assert!(
                (exact - dense).abs() < 1e-3 && exact <= dense + 1e-12,
                "{from:?} {to:?}: {exact} {dense}"
            );
        }
    }
}
