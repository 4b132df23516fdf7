//! Cost of the queries of a moving ball against the number of obstacles and the length of the motion.
//! `sampled` is the naive variant: the clearance at places a hundredth of a metre apart.

#![allow(clippy::expect_used, reason = "inputs are made here and must be good")]
#![allow(
    missing_docs,
    reason = "criterion_group! writes a public function without one"
)]

#[path = "inputs/rooms.rs"]
#[allow(dead_code, reason = "each bench uses a part of the shared inputs")]
mod rooms;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::SeedableRng;
use rand_pcg::Pcg64;
use sparse_to_obstacles::{ObstacleConfig, ObstacleSet};

const RADIUS: f64 = 0.15;

fn sampled(set: &ObstacleSet, a: [f64; 3], b: [f64; 3], length: f64) -> bool {
    let steps = (length / 0.01).ceil().max(1.0);
    (0..=steps as usize).all(|i| {
        let t = i as f64 / steps;
        let place = std::array::from_fn(|axis| a[axis] + t * (b[axis] - a[axis]));
        set.point_clearance(place) > RADIUS
    })
}

fn queries(c: &mut Criterion) {
    let mut group = c.benchmark_group("obstacle_query");
    group.sample_size(20);
    let points = rooms::points(8_500, 1);
    for clusters in [100, 300, 1_000] {
        let config = ObstacleConfig::with_clusters(clusters);
        let set = ObstacleSet::from_points(&points, &config, &mut Pcg64::seed_from_u64(1))
            .expect("good input");
        for length in [0.0, 0.5, 3.0] {
            let motions = rooms::motions(1_000, length, 2);
            group.throughput(Throughput::Elements(motions.len() as u64));
            let id = format!("{clusters}x{length}m");
            group.bench_function(BenchmarkId::new("motion_is_free", &id), |b| {
                b.iter(|| {
                    motions
                        .iter()
                        .filter(|m| set.motion_is_free(m.0, m.1, RADIUS))
                        .count()
                });
            });
            group.bench_function(BenchmarkId::new("clearance", &id), |b| {
                b.iter(|| motions.iter().map(|m| set.clearance(m.0, m.1)).sum::<f64>());
            });
            group.bench_function(BenchmarkId::new("first_contact", &id), |b| {
                b.iter(|| {
                    motions
                        .iter()
                        .filter_map(|m| set.first_contact(m.0, m.1, RADIUS))
                        .count()
                });
            });
            group.bench_function(BenchmarkId::new("sampled", &id), |b| {
                b.iter(|| {
                    motions
                        .iter()
                        .filter(|m| sampled(&set, m.0, m.1, length))
                        .count()
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, queries);
criterion_main!(benches);
