//! Cost of K-means against n and K: the accelerated method beside Lloyd's, which gives the same result,
//! with and without swap rounds, and the seedings alone.

#![allow(clippy::expect_used, reason = "inputs are made here and must be good")]
#![allow(
    missing_docs,
    reason = "criterion_group! writes a public function without one"
)]

#[path = "inputs/rooms.rs"]
#[allow(dead_code, reason = "each bench uses a part of the shared inputs")]
mod rooms;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rand::SeedableRng;
use rand_pcg::Pcg64;
use sparse_to_obstacles::{KMeansConfig, KMeansMethod, KMeansSeeding, kmeans};

fn run(points: &[[f64; 3]], config: &KMeansConfig) -> f64 {
    kmeans(points, config, &mut Pcg64::seed_from_u64(1))
        .expect("good input")
        .inertia
}

fn methods(c: &mut Criterion) {
    let mut group = c.benchmark_group("kmeans/method");
    group.sample_size(10);
    for count in [2_000, 8_500, 42_500] {
        let points = rooms::points(count, 1);
        for clusters in [300, 1_000] {
            let plain = KMeansConfig::plain(clusters);
            let id = format!("{count}x{clusters}");
            let lloyd = KMeansConfig {
                method: KMeansMethod::Lloyd,
                ..plain.clone()
            };
            if count <= 8_500 {
                group.bench_function(BenchmarkId::new("lloyd", &id), |b| {
                    b.iter(|| run(&points, &lloyd));
                });
            }
            group.bench_function(BenchmarkId::new("accelerated", &id), |b| {
                b.iter(|| run(&points, &plain));
            });
            let swaps = KMeansConfig {
                clusters,
                ..KMeansConfig::default()
            };
            group.bench_function(BenchmarkId::new("default", &id), |b| {
                b.iter(|| run(&points, &swaps));
            });
            let batches = KMeansConfig {
                method: KMeansMethod::MiniBatch { batch: 1024 },
                ..plain
            };
            group.bench_function(BenchmarkId::new("mini_batch", &id), |b| {
                b.iter(|| run(&points, &batches));
            });
        }
    }
    group.finish();
}

fn seedings(c: &mut Criterion) {
    let mut group = c.benchmark_group("kmeans/seeding");
    group.sample_size(10);
    let points = rooms::points(8_500, 1);
    for (name, seeding) in [
        ("plus_plus", KMeansSeeding::PlusPlus { trials: Some(1) }),
        ("greedy_plus_plus", KMeansSeeding::PlusPlus { trials: None }),
        (
            "parallel",
            KMeansSeeding::Parallel {
                rounds: 5,
                oversampling: 2.0,
            },
        ),
    ] {
        let config = KMeansConfig {
            seeding,
            max_iterations: 1,
            ..KMeansConfig::plain(1_000)
        };
        group.bench_function(name, |b| b.iter(|| run(&points, &config)));
    }
    group.finish();
}

criterion_group!(benches, methods, seedings);
criterion_main!(benches);
