//! Cost of planning, and of the nearest-neighbour query inside it, against the size of the tree.
//!
//! `nearest`: the incremental k-d tree beside the linear scan, one query among n random points of the unit cube.
//! `grow`: n iterations of RRT in a world without a way to the goal, so the tree only grows; reported per iteration.
//! `solve`: each planner on ten worlds of discs.

#![allow(clippy::expect_used, reason = "inputs are made here and must be good")]
#![allow(
    missing_docs,
    reason = "criterion_group! writes a public function without one"
)]

#[path = "inputs/discs.rs"]
mod discs;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use discs::{World, discs, is_free};
use rand::RngExt;
use rand_pcg::Pcg64;
use rrt_refine::nearest::{KdTree, LinearScan};
use rrt_refine::{
    Bounds, FindPathConfig, Query, RrtConfig, RrtStarConfig, find_path, rrt, rrt_connect, rrt_star,
};

type P = [f64; 2];
type Free<'a> = dyn Fn(&P, &P) -> bool + 'a;

fn points(count: usize) -> Vec<[f64; 3]> {
    let mut rng = Pcg64::new(1, 1);
    (0..count)
        .map(|_| std::array::from_fn(|_| rng.random()))
        .collect()
}

fn nearest(c: &mut Criterion) {
    let mut group = c.benchmark_group("rrt/nearest");
    let queries = points(256);
    group.throughput(Throughput::Elements(queries.len() as u64));
    for count in [100, 1_000, 10_000, 100_000] {
        let (mut tree, mut scan) = (KdTree::new(), LinearScan::new());
        for point in points(count) {
            tree.insert(point);
            scan.insert(point);
        }
        group.bench_function(BenchmarkId::new("kd_tree", count), |b| {
            b.iter(|| {
                queries
                    .iter()
                    .filter_map(|q| tree.nearest(q))
                    .map(|n| n.0)
                    .sum::<usize>()
            });
        });
        group.bench_function(BenchmarkId::new("linear_scan", count), |b| {
            b.iter(|| {
                queries
                    .iter()
                    .filter_map(|q| scan.nearest(q))
                    .map(|n| n.0)
                    .sum::<usize>()
            });
        });
    }
    group.finish();
}

fn insert(c: &mut Criterion) {
    let mut group = c.benchmark_group("rrt/insert");
    for count in [1_000, 10_000, 100_000] {
        let points = points(count);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::new("kd_tree", count), |b| {
            b.iter(|| {
                let mut tree = KdTree::new();
                points.iter().for_each(|point| tree.insert(*point));
                tree
            });
        });
    }
    group.finish();
}

fn grow(c: &mut Criterion) {
    let mut group = c.benchmark_group("rrt/grow");
    let bounds = Bounds::new([0.0; 2], [20.0; 2]).expect("a box");
    let query = Query::new([1.0; 2], [19.5; 2], bounds);
    let closed = |a: &P, b: &P| (a[0] < 19.0) == (b[0] < 19.0);
    for count in [1_000, 4_000, 16_000, 64_000] {
        let config = RrtConfig {
            step_length: 0.8,
            max_iterations: count,
            max_nodes: usize::MAX,
            ..RrtConfig::default()
        };
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::new("rrt", count), |b| {
            b.iter(|| rrt(&query, &closed, &config, &mut Pcg64::new(1, 1)));
        });
        if count <= 4_000 {
            let config = RrtStarConfig {
                rrt: config,
                ..Default::default()
            };
            group.bench_function(BenchmarkId::new("rrt_star", count), |b| {
                b.iter(|| rrt_star(&query, &closed, &config, &mut Pcg64::new(1, 1)));
            });
        }
    }
    group.finish();
}

fn solve(c: &mut Criterion) {
    let mut group = c.benchmark_group("rrt/solve");
    let worlds: Vec<World> = (1..=10).map(discs).collect();
    let bounds = Bounds::new([0.0; 2], [20.0; 2]).expect("a box");
    let config = RrtConfig {
        step_length: 0.8,
        ..RrtConfig::default()
    };
    let mut star = RrtStarConfig {
        rrt: config,
        ..Default::default()
    };
    star.rrt.max_iterations = 1_000;
    let informed = RrtStarConfig {
        informed: true,
        ..star
    };
    let query = Query::new([0.5; 2], [19.5; 2], bounds);
    group.throughput(Throughput::Elements(worlds.len() as u64));
    group.sample_size(20);
    let mut each = |name: &str, plan: &dyn Fn(&Free<'_>) -> bool| {
        group.bench_function(name, |b| {
            b.iter(|| {
                worlds
                    .iter()
                    .filter(|w| plan(&|a, b| is_free(w, a, b)))
                    .count()
            });
        });
    };
    let rng = || Pcg64::new(5, 5);
    each("rrt", &|free| {
        rrt(&query, &free, &config, &mut rng()).is_ok()
    });
    each("rrt_connect", &|free| {
        rrt_connect(&query, &free, &config, &mut rng()).is_ok()
    });
    each("find_path", &|free| {
        let config = FindPathConfig {
            rrt: config,
            ..FindPathConfig::default()
        };
        find_path(&query, &free, &config, &mut rng()).is_ok()
    });
    each("rrt_star, 1000", &|free| {
        rrt_star(&query, &free, &star, &mut rng()).is_ok()
    });
    each("informed_rrt_star, 1000", &|free| {
        rrt_star(&query, &free, &informed, &mut rng()).is_ok()
    });
    group.finish();
}

criterion_group!(benches, nearest, insert, grow, solve);
criterion_main!(benches);
