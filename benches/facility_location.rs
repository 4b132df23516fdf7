//! The 20 most representative of n points, without a stored kernel: bounded, lazy and naive greedy.
#![allow(missing_docs, reason = "criterion's macros make undocumented items")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark's input is right by construction"
)]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use submodular_minimax::functions::{FacilityLocation, Kernel, Points};
use submodular_minimax::maximize::{Greedy, LazyGreedy, Maximizer};

fn facility_location(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("facility_location");
    group.sample_size(10);
    for n in [1_000, 3_000, 10_000] {
        let mut rng = Pcg64::seed_from_u64(4);
        let points: Vec<[f64; 3]> = (0..n)
            .map(|_| [12.0, 7.0, 2.6].map(|side| side * rng.random::<f64>()))
            .collect();
        let points = Points::new(&points, Kernel::Linear { reach: 3.0 }).unwrap();
        let function = FacilityLocation::new(points);
        group.bench_function(BenchmarkId::new("bounded", n), |b| {
            b.iter(|| function.greedy(20));
        });
        group.bench_function(BenchmarkId::new("lazy", n), |b| {
            b.iter(|| LazyGreedy::cardinality(20).maximize(&function));
        });
        if n <= 3_000 {
            group.bench_function(BenchmarkId::new("naive", n), |b| {
                b.iter(|| Greedy::cardinality(20).maximize(&function));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, facility_location);
criterion_main!(benches);
