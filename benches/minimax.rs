//! The minimax algorithms and the exact minimiser on the function of Eq. (1) and on graph cuts.
#![allow(missing_docs, reason = "criterion's macros make undocumented items")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark's input is right by construction"
)]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use submodular_minimax::MinimaxConfig;
use submodular_minimax::functions::{
    Dense, GraphCut, Modular, Representation, Sparse, WeightedSum,
};
use submodular_minimax::maximize::LazyGreedy;
use submodular_minimax::minimax::{best_response, iterative_x_growing, min_by_singletons};
use submodular_minimax::minimize::{BruteForce, MinNormPoint, Minimizer, ModularMinimizer};

fn eq_1(n: usize) -> Representation<Dense> {
    let mut rng = Pcg64::seed_from_u64(2);
    let at: Vec<f64> = (0..n).map(|_| rng.random()).collect();
    let similarity = Dense::from_fn(n, n, |u, v| (1.0 - 8.0 * (at[u] - at[v]).abs()).max(0.0));
    Representation::new(similarity.unwrap(), vec![0.2; n], 1.0 / n as f64).unwrap()
}

fn minimax(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("minimax");
    group.sample_size(10);
    for n in [100, 300, 1_000] {
        let f = eq_1(n);
        let config = MinimaxConfig::default();
        let mut oracle = LazyGreedy::cardinality(n / 10);
        group.bench_function(BenchmarkId::new("iterative_x_growing", n), |b| {
            b.iter(|| iterative_x_growing(&f, &mut oracle, &ModularMinimizer, &config));
        });
        group.bench_function(BenchmarkId::new("min_by_singletons", n), |b| {
            b.iter(|| min_by_singletons(&f, &mut oracle, &ModularMinimizer));
        });
        group.bench_function(BenchmarkId::new("best_response", n), |b| {
            b.iter(|| best_response(&f, &mut oracle, &ModularMinimizer, &config));
        });
    }
    group.finish();
}

fn minimisers(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("minimise");
    group.sample_size(10);
    for n in [14, 50, 100] {
        let mut rng = Pcg64::seed_from_u64(3);
        let mut rows = vec![Vec::new(); n];
        for a in 0..n {
            for b in (a + 1..n).filter(|_| rng.random::<f64>() < 0.2) {
                rows[a].push((b, 1.0));
                rows[b].push((a, 1.0));
            }
        }
        let cut = GraphCut::new(Sparse::new(rows, n).unwrap()).unwrap();
        let weights = (0..n).map(|_| 4.0 * rng.random::<f64>() - 2.0).collect();
        let modular = Modular {
            constant: 0.0,
            weights,
        };
        let sum = WeightedSum::new(vec![(1.0, Box::new(&cut)), (1.0, Box::new(&modular))]).unwrap();
        group.bench_function(BenchmarkId::new("min_norm_point", n), |b| {
            b.iter(|| MinNormPoint::default().minimize(&sum));
        });
        if n <= 14 {
            group.bench_function(BenchmarkId::new("brute_force", n), |b| {
                b.iter(|| BruteForce.minimize(&sum));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, minimax, minimisers);
criterion_main!(benches);
