//! Cost of proving free space against the number of rays, with and without the space between them, and the size of voxels, and
//! of its queries against the length of the motion.

#![allow(clippy::expect_used, reason = "inputs are made here and must be good")]
#![allow(
    missing_docs,
    reason = "criterion_group! writes a public function without one"
)]

#[path = "inputs/rooms.rs"]
#[allow(dead_code, reason = "each bench uses a part of the shared inputs")]
mod rooms;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rand::RngExt;
use rand_pcg::Pcg64;
use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, Ray};

const RADIUS: f64 = 0.15;

/// Rays of 2 to 4 m from 100 keyframes into all directions, more along the floor.
fn rays(count: usize) -> Vec<Ray> {
    let mut rng = Pcg64::new(5, 1);
    let keyframes: Vec<[f64; 3]> = (0..100)
        .map(|_| {
            [
                2.0 + 8.0 * rng.random::<f64>(),
                1.5 + 4.0 * rng.random::<f64>(),
                1.2,
            ]
        })
        .collect();
    (0..count)
        .map(|i| {
            let origin = keyframes[i * keyframes.len() / count];
            let turn = std::f64::consts::TAU * rng.random::<f64>();
            let length = 2.0 + 2.0 * rng.random::<f64>();
            let rise = 0.7 * (rng.random::<f64>() - 0.5);
            let end = [
                origin[0] + length * turn.cos(),
                origin[1] + length * turn.sin(),
                origin[2] + length * rise,
            ];
            Ray { origin, end }
        })
        .collect()
}

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("free_space/from_rays");
    group.sample_size(10);
    let surface = rooms::points(3_000, 1);
    for count in [10_000, 30_000, 100_000] {
        let rays = rays(count);
        group.throughput(Throughput::Elements(count as u64));
        for (name, max_triangle_angle) in [("rays", 0.0), ("between", 0.1)] {
            let config = FreeSpaceConfig {
                max_triangle_angle,
                ..FreeSpaceConfig::default()
            };
            group.bench_function(BenchmarkId::new(name, count), |b| {
                b.iter(|| {
                    FreeSpace::from_rays(rays.iter().copied(), &surface, &config)
                        .expect("good input")
                });
            });
        }
    }
    group.finish();
}

/// Against the voxels' size: the same rays, eight times as many voxels a step.
fn resolution(c: &mut Criterion) {
    let mut group = c.benchmark_group("free_space/resolution");
    group.sample_size(10);
    let surface = rooms::points(3_000, 1);
    let (rays, motions) = (rays(30_000), rooms::motions(1_000, 1.0, 2));
    for resolution in [0.2, 0.1, 0.05] {
        let config = FreeSpaceConfig {
            resolution,
            ..FreeSpaceConfig::default()
        };
        let build =
            || FreeSpace::from_rays(rays.iter().copied(), &surface, &config).expect("good input");
        group.bench_function(BenchmarkId::new("from_rays", resolution), |b| b.iter(build));
        let space = build();
        group.bench_function(BenchmarkId::new("motion_is_free", resolution), |b| {
            b.iter(|| {
                let free = motions
                    .iter()
                    .filter(|m| space.motion_is_free(m.0, m.1, RADIUS));
                free.count()
            });
        });
    }
    group.finish();
}

fn queries(c: &mut Criterion) {
    let mut group = c.benchmark_group("free_space/query");
    let surface = rooms::points(3_000, 1);
    let space = FreeSpace::from_rays(rays(100_000), &surface, &FreeSpaceConfig::default())
        .expect("good input");
    for length in [0.0, 0.5, 1.0, 3.0] {
        let motions = rooms::motions(1_000, length, 2);
        group.throughput(Throughput::Elements(motions.len() as u64));
        group.bench_function(BenchmarkId::new("motion_is_free", length), |b| {
            b.iter(|| {
                motions
                    .iter()
                    .filter(|m| space.motion_is_free(m.0, m.1, RADIUS))
                    .count()
            });
        });
    }
    group.bench_function("frontier", |b| b.iter(|| space.frontier().len()));
    group.finish();
}

criterion_group!(benches, build, resolution, queries);
criterion_main!(benches);
