//! The same seed gives the same bits; another seed gives another tree.

#![allow(
    clippy::expect_used,
    reason = "a broken expectation must fail the test"
)]

mod planar;

use planar::DiscWorld;
use rand_pcg::Pcg64;
use rrt_refine::refine::{ShortcutConfig, shortcut};
use rrt_refine::{
    FindPathConfig, Plan, Query, RrtConfig, RrtStarConfig, find_path, rrt, rrt_connect, rrt_star,
};

fn plans(seed: u128) -> [Plan<2>; 4] {
    let (world, start, goal) = DiscWorld::random(4, 12.0, 20);
    let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
    let query = Query::new(start, goal, world.bounds());
    let config = RrtConfig {
        step_length: 0.8,
        max_iterations: 800,
        ..RrtConfig::paper()
    };
    let star = RrtStarConfig {
        rrt: config,
        ..Default::default()
    };
    let informed = RrtStarConfig {
        rrt: config,
        ..RrtStarConfig::informed()
    };
    let rng = || Pcg64::new(seed, 9);
    [
        rrt(&query, &free, &config, &mut rng()),
        rrt_connect(&query, &free, &config, &mut rng()),
        rrt_star(&query, &free, &star, &mut rng()),
        rrt_star(&query, &free, &informed, &mut rng()),
    ]
    .map(|plan| plan.expect("a fair question"))
}

#[test]
fn one_seed_one_answer_on_any_thread() {
    let here = plans(1);
    let there: Vec<[Plan<2>; 4]> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| plans(1))).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().expect("no panic"))
            .collect()
    });
    for other in there {
        assert_eq!(here, other);
    }
    for (a, b) in here.iter().zip(&plans(2)) {
        assert_ne!(a.path, b.path);
    }
}

#[test]
fn the_default_pipeline_follows_its_seed() {
    let (world, start, goal) = DiscWorld::random(4, 12.0, 20);
    let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
    let query = Query::new(start, goal, world.bounds());
    let run = |seed| {
        let rng = &mut Pcg64::new(seed, 1);
        find_path(&query, &free, &FindPathConfig::default(), rng).expect("a fair question")
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).plan.path, run(2).plan.path);
}

#[test]
fn random_shortcuts_follow_their_seed() {
    let (world, ..) = DiscWorld::random(4, 12.0, 20);
    let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
    let [plan, ..] = plans(1);
    let path = plan.path.expect("a path");
    let run = |seed| {
        shortcut(
            &path,
            &free,
            &ShortcutConfig::default(),
            &mut Pcg64::new(seed, 1),
        )
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1).path, run(2).path);
}
