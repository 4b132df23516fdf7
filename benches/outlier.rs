//! Outlier removal of 10,000, 50,000 and 200,000 points: closed form, iterations, and SOR over an R*-tree.
//!
//! That SOR is the baseline of the quality tables, written to be plain, and no measure of how fast SOR can be: over
//! SciPy's k-d tree (`cKDTree(points).query(points, 21)`) it takes a half to two thirds of its time.
#![allow(missing_docs, reason = "criterion's macros make undocumented items")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use explorer::baseline::{StatisticalConfig, statistical};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::hint::black_box;
use submodular_minimax::{OutlierConfig, Solver, remove_outliers};

/// Five walls of a 12 x 7 x 2.6 m room in textured patches, every seventh point gross.
fn cloud(n: usize) -> Vec<[f64; 3]> {
    let mut rng = Pcg64::seed_from_u64(1);
    let patch: Vec<[f64; 3]> = (0..100 + n / 50)
        .map(|i| {
            let mut at = [12.0, 7.0, 2.6].map(|side| side * rng.random::<f64>());
            at[i % 3] = 0.0;
            at
        })
        .collect();
    (0..n)
        .map(|i| {
            let p = patch[rng.random_range(0..patch.len())];
            let spread = if i % 7 == 0 { 4.0 } else { 0.2 };
            p.map(|x| x + spread * (rng.random::<f64>() - 0.5))
        })
        .collect()
}

fn outlier(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("outlier");
    group.sample_size(10);
    for n in [10_000, 50_000, 200_000] {
        let points = cloud(n);
        group.throughput(Throughput::Elements(n as u64));
        let default = OutlierConfig::default();
        group.bench_with_input(BenchmarkId::new("default", n), &points, |b, points| {
            b.iter(|| remove_outliers(black_box(points), None, &default));
        });
        if n <= 10_000 {
            let engine = OutlierConfig {
                solver: Solver::IterativeXGrowing,
                ..default.clone()
            };
            group.bench_with_input(BenchmarkId::new("iterations", n), &points, |b, points| {
                b.iter(|| remove_outliers(black_box(points), None, &engine));
            });
        }
        group.bench_with_input(BenchmarkId::new("statistical", n), &points, |b, points| {
            b.iter(|| statistical(black_box(points), &StatisticalConfig::default()));
        });
    }
    group.finish();
}

criterion_group!(benches, outlier);
criterion_main!(benches);
