//! What holds for every refiner on every path: same ends, valid, never longer, idempotent; the DAG is optimal.

#![allow(
    clippy::expect_used,
    reason = "a broken expectation must fail the test"
)]

mod planar;

use planar::{DiscWorld, gap};
use proptest::prelude::*;
use rand_pcg::Pcg64;
use rrt_refine::refine::{
    ClearanceCost, RefineStop, Refined, RopeConfig, RoundingConfig, ShortcutConfig, TautConfig,
    dag, dag_by_cost, greedy, rope, round_corners, shortcut, taut,
};
use rrt_refine::{
    FindPathConfig, Path, Query, RrtConfig, RrtStarConfig, find_path, rrt, rrt_connect, rrt_star,
};

type Refiner<'a> = Box<dyn Fn(&Path<2>) -> Refined<2> + 'a>;

/// A free path through a random world, as RRT leaves it.
fn raw_path(seed: u64) -> Option<(DiscWorld, Path<2>)> {
    let (world, start, goal) = DiscWorld::random(seed, 20.0, 55);
    let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
    let config = RrtConfig {
        step_length: 0.8,
        ..RrtConfig::paper()
    };
    let mut rng = Pcg64::new(seed.into(), 5);
    let query = Query::new(start, goal, world.bounds());
    let plan = rrt(&query, &free, &config, &mut rng).expect("a fair question");
    plan.path.map(|path| (world, path))
}

/// Distance to the nearest disc, 0 inside.
fn clearance(world: &DiscWorld, p: &[f64; 2]) -> f64 {
    let nearest = world
        .discs
        .iter()
        .map(|(centre, radius)| gap(centre, p) - radius);
    nearest.fold(f64::INFINITY, f64::min).max(0.0)
}

fn lawful(world: &DiscWorld, path: &Path<2>, refined: &Refined<2>) {
    assert_eq!(refined.path.start(), path.start());
    assert_eq!(refined.path.end(), path.end());
    assert!(refined.path.length() <= path.length());
    assert_eq!(refined.length_before, path.length());
    let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
    assert_eq!(refined.path.first_blocked(&free), None);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn every_refiner_keeps_the_laws(seed in 0_u64..1_000_000) {
        let Some((world, path)) = raw_path(seed) else { return Ok(()) };
        let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
        let off = |p: &[f64; 2]| clearance(&world, p);
        let rounding = RoundingConfig { max_turn: 0.3, min_clearance: 0.05, ..Default::default() };
        let cost = ClearanceCost { comfort: 0.5, weight: 5.0, spacing: 0.2 };
        // One world in thousands needs more checks than the default allows.
        let rope_config = RopeConfig { max_checks: usize::MAX, ..Default::default() };
        let taut_config = TautConfig { max_rounds: 60, ..Default::default() };
        let all: [(&str, Refiner<'_>); 6] = [
            ("dag", Box::new(|p| dag(p, &free))),
            ("dag_by_cost", Box::new(|p| dag_by_cost(p, &free, &|a, b| cost.of(a, b, &off)))),
            ("greedy", Box::new(|p| greedy(p, &free))),
            ("rope", Box::new(|p| rope(p, &free, &rope_config).expect("good parameters"))),
            ("taut", Box::new(|p| taut(p, &free, &taut_config).expect("good parameters"))),
            ("round_corners", Box::new(|p| round_corners(p, &free, &off, &rounding).expect("good parameters"))),
        ];
        for (name, refiner) in &all {
            let refined = refiner(&path);
            lawful(&world, &path, &refined);
            prop_assert_eq!(refined.stop, RefineStop::Done, "{}", name);
            let again = refiner(&refined.path);
            prop_assert_eq!(&again.path, &refined.path, "{} is not idempotent", name);
        }
        let random = shortcut(&path, &free, &ShortcutConfig::default(), &mut Pcg64::new(seed.into(), 6));
        lawful(&world, &path, &random);
    }

    #[test]
    fn better_refiners_are_not_longer(seed in 0_u64..1_000_000) {
        let Some((world, path)) = raw_path(seed) else { return Ok(()) };
        let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
        let best = dag(&path, &free).path.length() * (1.0 + 1e-12);
        prop_assert!(best <= greedy(&path, &free).path.length() * (1.0 + 1e-9));
        prop_assert!(rope(&path, &free, &RopeConfig::default()).expect("good parameters").path.length() <= best);
        prop_assert!(taut(&path, &free, &TautConfig::default()).expect("good parameters").path.length() <= best);
    }

    #[test]
    fn every_plan_is_free_and_inside_and_joins_its_ends(seed in 0_u64..1_000_000) {
        let (world, start, goal) = DiscWorld::random(seed, 12.0, 20);
        let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
        let query = Query::new(start, goal, world.bounds());
        let config = RrtConfig { step_length: 0.8, max_iterations: 400, ..RrtConfig::default() };
        let star = RrtStarConfig { rrt: config, ..Default::default() };
        let informed = RrtStarConfig { rrt: config, ..RrtStarConfig::informed() };
        let rng = || Pcg64::new(seed.into(), 5);
        let plans = [
            rrt(&query, &free, &config, &mut rng()),
            rrt_connect(&query, &free, &config, &mut rng()),
            rrt_star(&query, &free, &star, &mut rng()),
            rrt_star(&query, &free, &informed, &mut rng()),
        ];
        let pipeline = FindPathConfig { rrt: config, ..FindPathConfig::default() };
        let found = find_path(&query, &free, &pipeline, &mut rng()).expect("a fair question");
        prop_assert_eq!(found.path.is_some(), found.plan.path.is_some());
        if let (Some(path), Some(raw)) = (found.path, found.plan.path) {
            prop_assert_eq!((path.start(), path.end()), (start, goal));
            prop_assert_eq!(path.first_blocked(&free), None);
            prop_assert!(path.length() <= raw.length());
        }
        for plan in plans {
            let plan = plan.expect("a fair question");
            prop_assert!(plan.iterations <= 400 && plan.nodes <= 802);
            prop_assert_eq!(plan.path.is_some(), plan.goal.is_some());
            let Some(path) = plan.path else { continue };
            prop_assert_eq!((path.start(), path.end()), (start, goal));
            prop_assert_eq!(path.first_blocked(&free), None);
            prop_assert!(path.points().iter().all(|point| query.bounds.contains(point)));
        }
    }

    /// Against every subset of the vertices, with an arbitrary table of free motions.
    #[test]
    fn the_dag_is_the_best_subset(
        points in prop::collection::vec([-5.0..5.0_f64, -5.0..5.0], 2..12),
        blocked in prop::collection::vec(any::<bool>(), 144),
    ) {
        let n = points.len();
        let place = |p: &[f64; 2]| points.iter().position(|q| q == p).expect("a vertex");
        let free = |a: &[f64; 2], b: &[f64; 2]| {
            let (i, j) = (place(a), place(b));
            j == i + 1 || !blocked[i * 12 + j]
        };
        let path = Path::new(&points).expect("finite points");
        let mut best = f64::INFINITY;
        for subset in 0_u32..1 << (n - 2) {
            let chosen: Vec<[f64; 2]> = (0..n)
                .filter(|&i| i == 0 || i == n - 1 || subset >> (i - 1) & 1 == 1)
                .map(|i| points[i])
                .collect();
            let way = Path::new(&chosen).expect("finite points");
            if way.first_blocked(&free).is_none() {
                best = best.min(way.length());
            }
        }
        let refined = dag(&path, &free);
        prop_assert!((refined.path.length() - best).abs() <= 1e-12 * best.max(1.0));
        prop_assert!(refined.checks <= n * (n - 1) / 2);
        // The same for a cost, here twice the length plus a price for each motion.
        let cost = |a: &[f64; 2], b: &[f64; 2]| 2.0 * Path::new(&[*a, *b]).expect("finite").length() + 1.0;
        let by_cost = dag_by_cost(&path, &free, &cost);
        let cheapest = cheapest_subset(&points, &free, &cost);
        let total: f64 = by_cost.path.segments().map(|(a, b)| cost(a, b)).sum();
        prop_assert!((total - cheapest).abs() <= 1e-9 * cheapest);
    }

    #[test]
    fn paths_of_equal_points_survive(count in 1_usize..6) {
        let path = Path::new(&vec![[1.0, 2.0]; count]).expect("finite points");
        let open = |_: &[f64; 2], _: &[f64; 2]| true;
        let mut rng = Pcg64::new(1, 1);
        for refined in [
            dag(&path, &open),
            greedy(&path, &open),
            rope(&path, &open, &RopeConfig::default()).expect("good parameters"),
            taut(&path, &open, &TautConfig::default()).expect("good parameters"),
            shortcut(&path, &open, &ShortcutConfig::default(), &mut rng),
            round_corners(&path, &open, &|_| 1.0, &RoundingConfig::default()).expect("good parameters"),
        ] {
            prop_assert_eq!(refined.path.length(), 0.0);
            prop_assert_eq!(refined.path.end(), [1.0, 2.0]);
            prop_assert_eq!(refined.ratio(), 1.0);
        }
    }
}

fn cheapest_subset(
    points: &[[f64; 2]],
    free: &impl Fn(&[f64; 2], &[f64; 2]) -> bool,
    cost: &impl Fn(&[f64; 2], &[f64; 2]) -> f64,
) -> f64 {
    let mut best = vec![f64::INFINITY; points.len()];
    best[0] = 0.0;
    for j in 1..points.len() {
        for i in 0..j {
            if free(&points[i], &points[j]) {
                best[j] = best[j].min(best[i] + cost(&points[i], &points[j]));
            }
        }
    }
    best[points.len() - 1]
}

#[test]
fn budgets_end_a_refinement_early_but_lawfully() {
    let Some((world, path)) = raw_path(3) else {
        panic!("seed 3 has a path")
    };
    let free = |a: &[f64; 2], b: &[f64; 2]| world.is_free(a, b);
    for max_checks in [0, 1, 10, 100] {
        let config = RopeConfig {
            max_checks,
            ..Default::default()
        };
        let refined = rope(&path, &free, &config).expect("good parameters");
        lawful(&world, &path, &refined);
        assert_eq!(refined.stop, RefineStop::Budget);
    }
    let one = TautConfig {
        max_rounds: 1,
        min_gain: 0.0,
        ..Default::default()
    };
    let refined = taut(&path, &free, &one).expect("good parameters");
    lawful(&world, &path, &refined);
    assert_eq!(refined.stop, RefineStop::Budget);
}

#[test]
fn parameters_out_of_range_are_refused() {
    let path = Path::new(&[[0.0, 0.0], [1.0, 1.0]]).expect("finite points");
    let open = |_: &[f64; 2], _: &[f64; 2]| true;
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        let config = RopeConfig {
            max_step: value,
            ..Default::default()
        };
        assert!(rope(&path, &open, &config).is_err(), "{value}");
        let config = RoundingConfig {
            max_turn: value,
            ..Default::default()
        };
        assert!(
            round_corners(&path, &open, &|_| 1.0, &config).is_err(),
            "{value}"
        );
    }
    let config = TautConfig {
        min_gain: f64::NAN,
        ..Default::default()
    };
    assert!(taut(&path, &open, &config).is_err());
}
