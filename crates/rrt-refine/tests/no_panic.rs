//! Whatever numbers come in, nothing panics or hangs, and what cannot be measured is refused.

use proptest::num::f64::ANY;
use proptest::prelude::*;
use rand_pcg::Pcg64;
use rrt_refine::refine::{
    RopeConfig, RoundingConfig, ShortcutConfig, TautConfig, dag, greedy, rope, round_corners,
    shortcut, taut,
};
use rrt_refine::{Bounds, Path, RrtConfig, RrtStarConfig, rrt, rrt_connect, rrt_star};

type Point = [f64; 3];

/// Ordinary coordinates with a few of any kind: huge, tiny, infinite, NaN.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        20 => -5.0..5.0_f64,
        2 => Just(0.0),
        1 => ANY,
        1 => Just(1e149),
        1 => Just(1e200),
        1 => Just(-1e200),
        1 => Just(1e-200),
    ]
}

fn point() -> impl Strategy<Value = Point> {
    prop::array::uniform3(coordinate())
}

/// A wall across the first axis with a gap.
fn free(a: &Point, b: &Point) -> bool {
    (a[0] < 1.0) == (b[0] < 1.0) || a[1] > 2.0 && b[1] > 2.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn paths(points in prop::collection::vec(point(), 0..7), size in coordinate()) {
        let Ok(path) = Path::new(&points) else { return Ok(()) };
        prop_assert!(path.length().is_finite());
        let _ = (path.turns(), path.point_at(size), path.reversed(), path.first_blocked(&free));
        let _ = path.legs(size, 0.5);
        let _ = path.densified(size);
        let _ = path.resampled(9);
        let _ = path.clearance_profile(size, |_| 1.0);
    }

    #[test]
    fn refiners(points in prop::collection::vec(point(), 0..7), size in coordinate()) {
        let Ok(path) = Path::new(&points) else { return Ok(()) };
        let shorter = [
            Some(dag(&path, &free)),
            Some(greedy(&path, &free)),
            Some(shortcut(&path, &free, &ShortcutConfig::default(), &mut Pcg64::new(1, 1))),
            taut(&path, &free, &TautConfig::default()).ok(),
            rope(&path, &free, &RopeConfig { max_step: size, ..RopeConfig::default() }).ok(),
            round_corners(&path, &free, &|_| size, &RoundingConfig::default()).ok(),
        ];
        for refined in shorter.into_iter().flatten() {
            prop_assert!(refined.path.length() <= path.length());
            prop_assert_eq!(refined.path.end(), path.end());
        }
    }

    #[test]
    fn planners((low, high) in (point(), point()), (from, to) in (point(), point()), step in coordinate()) {
        let Ok(bounds) = Bounds::new(low, high) else { return Ok(()) };
        let config = RrtConfig {
            step_length: step,
            max_iterations: 100,
            max_nodes: 100,
            ..RrtConfig::default()
        };
        let star = RrtStarConfig { rrt: config, ..RrtStarConfig::informed() };
        let rng = || Pcg64::new(1, 1);
        let plans = [
            rrt(from, to, &bounds, &free, &config, &mut rng()),
            rrt_connect(from, to, &bounds, &free, &config, &mut rng()),
            rrt_star(from, to, &bounds, &free, &star, &mut rng()),
        ];
        for path in plans.into_iter().flatten().filter_map(|plan| plan.path) {
            prop_assert!(path.length().is_finite());
        }
    }
}
