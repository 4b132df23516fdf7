//! Whatever numbers come in, nothing panics or hangs, and what cannot be measured is refused.
//!
//! A case has one size for most of its numbers, so that whole inputs lie where squares vanish or overflow, and a few of any kind.

use proptest::num::f64::ANY;
use proptest::prelude::*;
use proptest::sample::select;
use rand_pcg::Pcg64;
use rrt_refine::nearest::{KdTree, LinearScan};
use rrt_refine::refine::{
    ClearanceCost, RopeConfig, RoundingConfig, ShortcutConfig, TautConfig, dag, dag_by_cost,
    greedy, rope, round_corners, shortcut, taut,
};
use rrt_refine::{
    Bounds, FindPathConfig, Path, Query, RrtConfig, RrtStarConfig, find_path, rrt, rrt_connect,
    rrt_star,
};

type Point = [f64; 3];

const SIZES: [f64; 11] = [
    5e-324, 1e-310, 1e-200, 1e-160, 1e-150, 1.0, 1.0, 1e100, 1e149, 1e154, 1e300,
];

/// Mostly of the given size, some huge, tiny, infinite or NaN.
fn number(size: f64) -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        20 => (-5.0..5.0_f64).prop_map(move |value| value * size),
        2 => Just(0.0),
        1 => ANY,
        1 => select(SIZES.to_vec()),
        1 => select(SIZES.to_vec()).prop_map(|value| -value),
    ]
}

/// A few points and a few numbers of one size.
fn case() -> impl Strategy<Value = (Vec<Point>, [f64; 4])> {
    select(SIZES.to_vec()).prop_flat_map(|size| {
        (
            prop::collection::vec(prop::array::uniform3(number(size)), 0..9),
            prop::array::uniform4(number(size)),
        )
    })
}

/// A wall across the first axis with a gap.
fn free(a: &Point, b: &Point) -> bool {
    (a[0] < 1.0) == (b[0] < 1.0) || a[1] > 2.0 && b[1] > 2.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn paths((points, [a, b, ..]) in case()) {
        let Ok(path) = Path::new(&points) else { return Ok(()) };
        prop_assert!(path.length().is_finite());
        prop_assert!(path.point_at(a).iter().all(|value| value.is_finite()));
        let _ = (path.turns(), path.reversed(), path.first_blocked(&free));
        let _ = path.legs(a, b);
        let _ = path.densified(a);
        let _ = path.resampled(9);
        let _ = path.clearance_profile(a, |_| b);
    }

    #[test]
    fn refiners((points, [a, b, c, d]) in case()) {
        let Ok(path) = Path::new(&points) else { return Ok(()) };
        let cost = ClearanceCost { comfort: a, weight: b, spacing: c.abs().max(1e-3) };
        let endless_halves = TautConfig { bisections: usize::MAX, min_gain: a, ..TautConfig::default() };
        let endless_cuts = RoundingConfig {
            max_turn: a,
            max_radius: b,
            min_clearance: c,
            halvings: usize::MAX,
        };
        let blocked = |from: &Point, to: &Point| from == to;
        let shorter = [
            Some(dag(&path, &free)),
            Some(dag_by_cost(&path, &free, &|from, to| cost.of(from, to, &|_| d))),
            Some(greedy(&path, &free)),
            Some(shortcut(&path, &free, &ShortcutConfig::default(), &mut Pcg64::new(1, 1))),
            taut(&path, &free, &TautConfig::default()).ok(),
            taut(&path, &blocked, &endless_halves).ok(),
            rope(&path, &free, &RopeConfig { max_step: a, min_gain: b, max_checks: 500 }).ok(),
            round_corners(&path, &free, &|_| d, &RoundingConfig::default()).ok(),
            round_corners(&path, &blocked, &|_| d, &endless_cuts).ok(),
        ];
        for refined in shorter.into_iter().flatten() {
            prop_assert!(refined.path.length() <= path.length());
            prop_assert!(refined.ratio() <= 1.0);
            prop_assert_eq!(refined.path.start(), path.start());
            prop_assert_eq!(refined.path.end(), path.end());
        }
    }

    #[test]
    fn planners((points, [a, b, c, _]) in case()) {
        let [low, high, from, goals @ ..] = &points[..] else { return Ok(()) };
        // Two corners of a box in any order.
        let corner = |pick: fn(f64, f64) -> f64| -> Point { std::array::from_fn(|k| pick(low[k], high[k])) };
        let boxes = [Bounds::new(corner(f64::min), corner(f64::max)), Bounds::around(&points, a)];
        for bounds in boxes.into_iter().flatten() {
            prop_assert!(bounds.diagonal().is_finite());
            prop_assert!(bounds.contains(&bounds.sample(&mut Pcg64::new(1, 1))));
            let query = Query::to_any_of(*from, goals, bounds);
            for (goal_bias, rewire_factor) in [(0.05, 1.1), (b, c)] {
                let config = RrtConfig {
                    step_length: a,
                    goal_bias,
                    max_iterations: 60,
                    max_nodes: 100,
                    ..RrtConfig::default()
                };
                let star = RrtStarConfig { rrt: config, rewire_factor, ..RrtStarConfig::informed() };
                let pipeline = FindPathConfig { rrt: config, ..FindPathConfig::default() };
                let rng = || Pcg64::new(1, 1);
                let found = find_path(&query, &free, &pipeline, &mut rng());
                let plans = [
                    rrt(&query, &free, &config, &mut rng()),
                    rrt_connect(&query, &free, &config, &mut rng()),
                    rrt_star(&query, &free, &star, &mut rng()),
                ];
                let planned = plans.into_iter().flatten().filter_map(|plan| plan.path);
                let found = found.ok().and_then(|found| found.path);
                for path in planned.chain(found) {
                    prop_assert!(path.length().is_finite());
                    prop_assert_eq!(path.start(), *from);
                    prop_assert!(goals.contains(&path.end()));
                }
            }
        }
    }

    #[test]
    fn nearest_points((points, [a, b, c, radius]) in case()) {
        let (mut tree, mut scan) = (KdTree::new(), LinearScan::new());
        // Often enough to cut leaves.
        for point in points.iter().cycle().take(6 * points.len()) {
            tree.insert(*point);
            scan.insert(*point);
        }
        for query in points.iter().chain(&[[a, b, c]]) {
            prop_assert_eq!(tree.nearest(query), scan.nearest(query));
            prop_assert_eq!(tree.nearest_k(query, 5), scan.nearest_k(query, 5));
            prop_assert_eq!(tree.within(query, radius), scan.within(query, radius));
        }
    }
}
