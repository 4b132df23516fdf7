//! Cost of building the hulls of clusters against the number of clusters and of points in each.

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
use sparse_to_obstacles::{KMeansConfig, ObstacleSet, kmeans};

fn hulls(c: &mut Criterion) {
    let mut group = c.benchmark_group("hull/from_clustering");
    group.sample_size(20);
    for (count, clusters) in [(3_000, 300), (8_500, 1_000), (30_000, 1_000)] {
        let points = rooms::points(count, 1);
        let config = KMeansConfig {
            clusters,
            ..KMeansConfig::default()
        };
        let clustering =
            kmeans(&points, &config, &mut Pcg64::seed_from_u64(1)).expect("good input");
        group.throughput(Throughput::Elements(clusters as u64));
        group.bench_function(
            BenchmarkId::from_parameter(format!("{count}x{clusters}")),
            |b| {
                b.iter(|| ObstacleSet::from_clustering(&points, &clustering).expect("good input"));
            },
        );
    }
    group.finish();
}

criterion_group!(benches, hulls);
criterion_main!(benches);
