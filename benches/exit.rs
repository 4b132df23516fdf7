//! Ranked exits of a map: the range-aware rule, the paper's rule, and the naive form of the paper's
//! rule (one pass over all points per bin), at three sizes.
#![allow(
    clippy::expect_used,
    missing_docs,
    reason = "a benchmark has no caller"
)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use exit_finder::{AffinePlane, ExitConfig, ExitView, LiveProfile, RangeProfile, find_exits};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const AGENT: [f64; 3] = [0.0; 3];

/// Points on the walls of a 5 m × 4 m room with a door towards +x, through which a hall is seen.
fn room(n: usize) -> Vec<[f64; 3]> {
    let mut rng = Pcg64::seed_from_u64(7);
    (0..n)
        .map(|_| {
            let bearing = rng.random_range(0.0..std::f64::consts::TAU);
            let (sin, cos) = bearing.sin_cos();
            let door = cos > 0.0 && (2.5 * sin / cos).abs() < 0.5;
            let scale = if door { 3.0 } else { 1.0 };
            let range = scale * (2.5 / cos.abs()).min(2.0 / sin.abs());
            let noisy = range * (1.0 + 0.02 * rng.random_range(-1.0..1.0));
            [noisy * cos, noisy * sin, rng.random_range(-0.8..0.8)]
        })
        .collect()
}

/// Algorithm 2 by the book: for every degree, count the points whose angle lies in it.
fn naive(points: &[[f64; 3]]) -> usize {
    let filled = |degree: u32| {
        let inside =
            |p: &&[f64; 3]| p[1].atan2(p[0]).to_degrees().rem_euclid(360.0) as u32 == degree;
        points.iter().filter(inside).count() > 1
    };
    let (mut longest, mut run) = (0, 0);
    for degree in 0..720 {
        run = if filled(degree % 360) { 0 } else { run + 1 };
        longest = longest.max(run);
    }
    longest
}

fn exits(c: &mut Criterion) {
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], AGENT).expect("up is not zero");
    let mut group = c.benchmark_group("exit");
    for n in [1_000, 10_000, 100_000] {
        let points = room(n);
        group.throughput(Throughput::Elements(n as u64));
        for (name, config) in [
            ("range_aware", ExitConfig::default()),
            ("paper", ExitConfig::paper_repaired()),
        ] {
            group.bench_function(BenchmarkId::new(name, n), |b| {
                b.iter(|| {
                    find_exits(
                        black_box(&points),
                        AGENT,
                        &plane,
                        &ExitView::default(),
                        &config,
                    )
                });
            });
        }
        group.bench_function(BenchmarkId::new("profile", n), |b| {
            let config = ExitConfig::default();
            b.iter(|| RangeProfile::of_points(black_box(&points), &[], AGENT, &plane, &config));
        });
        let mut live = LiveProfile::new(&points, AGENT, &plane, &ExitConfig::default())
            .expect("the default config is valid");
        group.bench_function(BenchmarkId::new("move_one_point", n), |b| {
            b.iter(|| {
                live.relocate(points[0], black_box([1.0, 1.0, 0.0]));
                live.relocate([1.0, 1.0, 0.0], points[0])
            });
        });
        if n <= 1_000 {
            group.bench_function(BenchmarkId::new("paper_naive", n), |b| {
                b.iter(|| naive(black_box(&points)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, exits);
criterion_main!(benches);
