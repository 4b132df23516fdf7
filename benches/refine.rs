//! Cost of each refiner against the number of vertices, beside the naive search that checks all pairs of vertices.
//!
//! Paths of RRT with ever shorter steps through the same ten worlds of discs: 20 to 160 vertices for the same way.

#![allow(clippy::expect_used, reason = "inputs are made here and must be good")]
#![allow(
    missing_docs,
    reason = "criterion_group! writes a public function without one"
)]

#[path = "inputs/discs.rs"]
mod discs;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use discs::{World, discs, is_free};
use rand_pcg::Pcg64;
use rrt_refine::refine::{
    RopeConfig, ShortcutConfig, TautConfig, dag, greedy, rope, shortcut, taut,
};
use rrt_refine::{Bounds, Path, Query, RrtConfig, rrt};

type P = [f64; 2];

fn paths(step_length: f64) -> Vec<(World, Path<2>)> {
    let bounds = Bounds::new([0.0; 2], [20.0; 2]).expect("a box");
    let config = RrtConfig {
        step_length,
        max_iterations: 100_000,
        max_nodes: 100_000,
        ..RrtConfig::paper()
    };
    (1..=10)
        .filter_map(|seed| {
            let world = discs(seed);
            let free = |a: &P, b: &P| is_free(&world, a, b);
            let query = Query::new([0.5; 2], [19.5; 2], bounds);
            let plan = rrt(&query, &free, &config, &mut Pcg64::new(seed, 5));
            let path = plan.ok()?.path?;
            Some((world, path))
        })
        .collect()
}

/// Every pair of vertices checked, then the shortest path: what the lazy search saves.
fn all_pairs(world: &World, path: &Path<2>) -> f64 {
    let points = path.points();
    let mut best = vec![f64::INFINITY; points.len()];
    best[0] = 0.0;
    for j in 1..points.len() {
        for i in 0..j {
            if i + 1 == j || is_free(world, &points[i], &points[j]) {
                let gap = (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
                best[j] = best[j].min(best[i] + gap);
            }
        }
    }
    best[points.len() - 1]
}

fn refine(c: &mut Criterion) {
    let mut group = c.benchmark_group("refine");
    group.sample_size(20);
    for step in [1.6, 0.8, 0.4, 0.2] {
        let paths = paths(step);
        let vertices: usize = paths.iter().map(|(_, path)| path.points().len()).sum();
        group.throughput(Throughput::Elements(paths.len() as u64));
        let mut each = |name: &str, refine: &dyn Fn(&World, &Path<2>) -> f64| {
            let id = BenchmarkId::new(name, vertices / paths.len().max(1));
            group.bench_function(id, |b| {
                b.iter(|| {
                    paths
                        .iter()
                        .map(|(world, path)| refine(world, path))
                        .sum::<f64>()
                });
            });
        };
        each("all pairs checked", &all_pairs);
        each("dag", &|w, p| {
            dag(p, &|a: &P, b: &P| is_free(w, a, b)).path.length()
        });
        each("greedy", &|w, p| {
            greedy(p, &|a: &P, b: &P| is_free(w, a, b)).path.length()
        });
        each("taut", &|w, p| {
            taut(p, &|a: &P, b: &P| is_free(w, a, b), &TautConfig::default())
                .map_or(0.0, |r| r.path.length())
        });
        each("rope", &|w, p| {
            rope(p, &|a: &P, b: &P| is_free(w, a, b), &RopeConfig::default())
                .map_or(0.0, |r| r.path.length())
        });
        each("shortcut, 100", &|w, p| {
            let free = |a: &P, b: &P| is_free(w, a, b);
            shortcut(p, &free, &ShortcutConfig::default(), &mut Pcg64::new(1, 1))
                .path
                .length()
        });
    }
    group.finish();
}

criterion_group!(benches, refine);
criterion_main!(benches);
