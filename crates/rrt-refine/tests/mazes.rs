//! Worlds with and without a way through: what every planner answers, and why it stopped.

#![allow(
    clippy::expect_used,
    reason = "a broken expectation must fail the test"
)]

use std::cell::{Cell, RefCell};

use rand_pcg::Pcg64;
use rrt_refine::refine::{TautConfig, taut};
use rrt_refine::{
    Bounds, FindPathConfig, Plan, PlanError, Query, Rrt, RrtConfig, RrtConnect, RrtStar,
    RrtStarConfig, Stop, find_path, rrt, rrt_connect, rrt_star,
};

type P = [f64; 2];
type Free<'a> = &'a dyn Fn(&P, &P) -> bool;

/// Walls at x = 1, 2, … that are open at the top and at the bottom in turn; the last has a gap of the given width.
fn serpentine(last_gap: f64) -> impl Fn(&P, &P) -> bool {
    move |a, b| {
        (1..=5).all(|wall| {
            let x = f64::from(wall);
            let crossing = (x - a[0]) / (b[0] - a[0]);
            let y = a[1] + crossing * (b[1] - a[1]);
            let gap = if wall == 5 { last_gap } else { 0.4 };
            let open = if wall % 2 == 0 {
                y < gap
            } else {
                y > 2.0 - gap
            };
            // A motion along the wall itself has a crossing that is NaN or infinite.
            (a[0] != x && b[0] != x) && (!(0.0..=1.0).contains(&crossing) || open)
        })
    }
}

fn bounds() -> Bounds<2> {
    Bounds::new([0.0, 0.0], [6.0, 2.0]).expect("a box")
}

const START: P = [0.5, 1.0];
const GOAL: P = [5.5, 1.0];

fn question() -> Query<2> {
    Query::new(START, GOAL, bounds())
}

/// All four planners with the same budget.
fn all(goals: &[P], free: Free<'_>, config: &RrtConfig) -> [Result<Plan<2>, PlanError>; 4] {
    let query = Query::to_any_of(START, goals, bounds());
    let star = RrtStarConfig {
        rrt: *config,
        ..Default::default()
    };
    let informed = RrtStarConfig {
        rrt: *config,
        ..RrtStarConfig::informed()
    };
    let rng = || Pcg64::new(11, 3);
    [
        rrt(&query, &free, config, &mut rng()),
        rrt_connect(&query, &free, config, &mut rng()),
        rrt_star(&query, &free, &star, &mut rng()),
        rrt_star(&query, &free, &informed, &mut rng()),
    ]
}

fn short_steps() -> RrtConfig {
    RrtConfig {
        step_length: 0.5,
        max_iterations: 3000,
        ..RrtConfig::default()
    }
}

/// Of the shortest way around the five tips (1, 1.6), (2, 0.4), (3, 1.6), (4, 0.4), (5, 1.6).
fn serpentine_length() -> f64 {
    2.0 * 0.5_f64.hypot(0.6) + 4.0 * 1.0_f64.hypot(1.2)
}

#[test]
fn every_planner_finds_its_way_through_a_serpentine() {
    let free = serpentine(0.4);
    for (k, plan) in all(&[GOAL], &free, &short_steps()).into_iter().enumerate() {
        let plan = plan.expect("a fair question");
        let path = plan.path.expect("a path");
        assert_eq!((path.start(), path.end()), (START, GOAL));
        assert_eq!(path.first_blocked(&free), None);
        assert_eq!(plan.goal, Some(0));
        let reason = if k < 2 {
            Stop::Reached
        } else {
            Stop::Iterations
        };
        assert_eq!(plan.stop, reason);
        assert!(plan.checks > plan.nodes / 2 && plan.nodes > 1);
    }
}

#[test]
fn star_planners_come_near_the_shortest_way() {
    let free = serpentine(0.4);
    let shortest = serpentine_length();
    let [_, _, star, informed] = all(&[GOAL], &free, &short_steps());
    let length =
        |plan: Result<Plan<2>, PlanError>| plan.ok().and_then(|p| p.length()).expect("a path");
    let (star, informed) = (length(star), length(informed));
    for (length, share) in [(star, 1.08), (informed, 1.05)] {
        assert!(length >= shortest - 1e-9, "{length} against {shortest}");
        assert!(length < share * shortest, "{length} against {shortest}");
    }
}

#[test]
fn no_planner_finds_a_way_through_a_closed_wall() {
    let free = serpentine(0.0);
    for plan in all(&[GOAL], &free, &short_steps()) {
        let plan = plan.expect("a fair question");
        assert_eq!(plan.path, None);
        assert_eq!((plan.goal, plan.length()), (None, None));
        assert_eq!(plan.stop, Stop::Iterations);
        assert_eq!(plan.iterations, 3000);
    }
}

#[test]
fn the_default_pipeline_says_how_often_it_planned() {
    let config = FindPathConfig {
        rrt: short_steps(),
        ..FindPathConfig::default()
    };
    let find = |free: Free<'_>| {
        find_path(&question(), &free, &config, &mut Pcg64::new(11, 3)).expect("a fair question")
    };
    let free = serpentine(0.4);
    let winding = find(&free);
    let (path, raw) = (
        winding.path.expect("a path"),
        winding.plan.path.expect("it"),
    );
    assert!(winding.attempts > 1 && winding.attempts <= 12);
    assert_eq!(winding.plan.stop, Stop::Reached);
    assert_eq!((path.start(), path.end()), (START, GOAL));
    assert_eq!(path.first_blocked(&free), None);
    assert!(path.length() < raw.length() && path.length() < 1.05 * serpentine_length());
    assert!(winding.checks > winding.plan.checks);
    let calls = Cell::new(0);
    let counted = find(&|a, b| {
        calls.set(calls.get() + 1);
        free(a, b)
    });
    assert!(counted.checks >= calls.get());
    // Without a way, or with the straight one, there is nothing to ask again for.
    let closed = find(&serpentine(0.0));
    assert_eq!((closed.attempts, closed.plan.stop), (1, Stop::Iterations));
    assert_eq!((closed.path, closed.plan.path), (None, None));
    let open = find(&|_, _| true);
    assert_eq!((open.attempts, open.plan.stop), (1, Stop::Straight));
    assert_eq!(open.path.expect("a path").points(), [START, GOAL]);
}

#[test]
fn further_searches_stay_where_a_shorter_path_can_lie_and_take_time_by_what_it_can_save() {
    let asked = |walls: Free<'_>, attempts, further_iterations| {
        let motions = RefCell::new(Vec::new());
        let free = |a: &P, b: &P| {
            motions.borrow_mut().push([*a, *b]);
            walls(a, b)
        };
        let config = FindPathConfig {
            rrt: short_steps(),
            attempts,
            further_iterations,
            min_gain: 0.0,
            ..FindPathConfig::default()
        };
        let found = find_path(&question(), &free, &config, &mut Pcg64::new(11, 3));
        let raw = found.expect("fair").plan.path.expect("a path");
        let once = TautConfig {
            max_rounds: 1,
            ..config.taut
        };
        let once = taut(&raw, &walls, &once).expect("good parameters");
        (once.path.length(), motions.into_inner())
    };
    let gap = |a: P, b: P| (a[0] - b[0]).hypot(a[1] - b[1]);
    // One wall that is open below: the ellipse is narrow, its box and the bounds are not.
    let wall: Free<'_> = &|a, b| {
        let crossing = (3.0 - a[0]) / (b[0] - a[0]);
        !(0.0..=1.0).contains(&crossing) || a[1] + crossing * (b[1] - a[1]) < 0.4
    };
    let (length, first) = asked(wall, 1, 0);
    let (_, both) = asked(wall, 2, 20_000);
    assert!(both.len() > first.len() + 10);
    for place in both[first.len()..].iter().flatten() {
        assert!(gap(START, *place) + gap(*place, GOAL) <= length + 1e-9);
    }
    let walls = serpentine(0.4);
    let (_, first) = asked(&walls, 1, 0);
    // The way is about twice as long as the straight line, so that all of the samples may be drawn.
    let (_, many) = asked(&walls, 6, 2_000);
    assert!(many.len() > first.len() + 1_000, "{}", many.len());
}

#[test]
fn the_default_pipeline_changes_to_the_nearer_goal() {
    // The first goal is seen, the second is just behind the first wall and nearer, around its tip at (1, 1.6).
    let free = serpentine(0.4);
    let goals = [[0.1, 0.05], [1.1, 1.5]];
    let query = Query::to_any_of([0.9, 1.5], &goals, bounds());
    let find = |attempts| {
        let config = FindPathConfig {
            attempts,
            ..FindPathConfig::default()
        };
        find_path(&query, &free, &config, &mut Pcg64::new(1, 3)).expect("a fair question")
    };
    let (first, best) = (find(1), find(6));
    assert_eq!(
        (first.plan.stop, first.plan.goal),
        (Stop::Straight, Some(0))
    );
    assert_eq!((best.plan.stop, best.plan.goal), (Stop::Reached, Some(1)));
    let path = best.path.expect("a path");
    assert_eq!(path.end(), goals[1]);
    assert!(path.length() < 0.5, "{}", path.length());
}

#[test]
fn more_attempts_find_the_shorter_side() {
    // A long block between start and goal: above it is the shorter way.
    let free: Free<'_> = &|a, b| {
        (0..=200).all(|k| {
            let t = f64::from(k) / 200.0;
            let p = [0, 1].map(|axis| a[axis] * (1.0 - t) + b[axis] * t);
            !((0.8..5.2).contains(&p[0]) && (0.5..1.1).contains(&p[1]))
        })
    };
    let length = |attempts: usize, seed: u128| {
        let config = FindPathConfig {
            attempts,
            further_iterations: 100_000,
            min_gain: 0.0,
            ..FindPathConfig::default()
        };
        let found = find_path(&question(), &free, &config, &mut Pcg64::new(seed, 3));
        found.expect("fair").path.expect("a path").length()
    };
    let lengths: Vec<[f64; 2]> = (0..20)
        .map(|seed| [length(1, seed), length(6, seed)])
        .collect();
    assert!(lengths.iter().all(|[once, best]| best <= once));
    // Each attempt begins as the one before: it finds something shorter, or nothing.
    for seed in 0..20 {
        let lengths: Vec<f64> = (1..=6).map(|attempts| length(attempts, seed)).collect();
        assert!(lengths.is_sorted_by(|a, b| a >= b), "{lengths:?}");
    }
    // Over the upper corners: 4.4 long, and two slopes of 0.3 along and 0.1 up; under the lower ones it is 11 % more.
    let shortest = 4.4 + 2.0 * 0.3_f64.hypot(0.1);
    assert!(lengths.iter().any(|[once, _]| *once > 1.1 * shortest));
    assert!(lengths.iter().all(|[_, best]| *best < 1.02 * shortest));
}

#[test]
fn full_trees_and_closures_stop_the_search() {
    let free = serpentine(0.0);
    let config = RrtConfig {
        max_nodes: 50,
        ..short_steps()
    };
    for plan in all(&[GOAL], &free, &config) {
        let plan = plan.expect("a fair question");
        assert_eq!(plan.stop, Stop::Nodes);
        assert!(plan.nodes <= 51, "{} nodes", plan.nodes);
    }
    let config = short_steps();
    let rng = &mut Pcg64::new(1, 1);
    let stop = |p: &rrt_refine::Progress| p.iterations >= 20;
    let mut single = Rrt::new(&question(), &free, &config).expect("fair");
    let mut double = RrtConnect::new(&question(), &free, &config).expect("fair");
    let star = RrtStarConfig {
        rrt: config,
        ..Default::default()
    };
    let mut star = RrtStar::new(&question(), &free, &star).expect("fair");
    for plan in [
        single.advance(rng, stop),
        double.advance(rng, stop),
        star.advance(rng, stop),
    ] {
        assert_eq!((plan.stop, plan.iterations), (Stop::Asked, 20));
    }
}

#[test]
fn a_search_goes_on_where_it_stopped() {
    let free = serpentine(0.4);
    let whole = RrtConfig {
        max_iterations: 4000,
        ..short_steps()
    };
    let part = RrtConfig {
        max_iterations: 1,
        ..whole
    };
    let mut rng = Pcg64::new(11, 3);
    let mut search = Rrt::new(&question(), &free, &part).expect("fair");
    let resumed = loop {
        let plan = search.advance(&mut rng, |_| false);
        if plan.stop != Stop::Iterations {
            break plan;
        }
    };
    let once = rrt(&question(), &free, &whole, &mut Pcg64::new(11, 3)).expect("fair");
    assert_eq!(resumed, once);
    // Asking again changes nothing.
    assert_eq!(search.advance(&mut rng, |_| false), once);
}

#[test]
fn more_time_never_makes_an_anytime_path_longer() {
    let free = serpentine(0.4);
    for informed in [false, true] {
        let rrt = RrtConfig {
            max_iterations: 500,
            ..short_steps()
        };
        let config = RrtStarConfig {
            rrt,
            informed,
            ..Default::default()
        };
        let mut search = RrtStar::new(&question(), &free, &config).expect("fair");
        let mut rng = Pcg64::new(2, 2);
        let mut last = f64::INFINITY;
        for _ in 0..8 {
            let plan = search.advance(&mut rng, |_| false);
            let Some(path) = plan.path else { continue };
            assert_eq!(path.first_blocked(&free), None);
            assert!(path.length() <= last);
            last = path.length();
        }
        assert!(last.is_finite());
    }
}

#[test]
fn a_search_that_was_stopped_before_it_began_is_asked_for_the_straight_motion_once() {
    let free = serpentine(0.0);
    // The nearer goal is behind a wall, the other one is seen: a path, but not the shortest there could be.
    let query = Query::to_any_of([0.9, 0.1], &[[1.1, 0.1], [0.1, 1.9]], bounds());
    let config = RrtStarConfig::default();
    let mut search = RrtStar::new(&query, &free, &config).expect("fair");
    let first = search.advance(&mut Pcg64::new(1, 1), |_| true);
    assert_eq!((first.stop, first.goal), (Stop::Asked, Some(1)));
    assert_eq!(search.advance(&mut Pcg64::new(1, 1), |_| true), first);
}

#[test]
fn of_several_goals_one_that_can_be_reached_is_taken() {
    let free = serpentine(0.0);
    let goals = [GOAL, [4.5, 1.9], [5.5, 0.2], [2.5, 0.1]];
    for (k, plan) in all(&goals, &free, &short_steps()).into_iter().enumerate() {
        let plan = plan.expect("a fair question");
        let goal = plan.goal.expect("a goal");
        assert!(goal == 1 || goal == 3, "goal {goal}");
        assert_eq!(plan.path.expect("a path").end(), goals[goal]);
        // The nearer of the two.
        assert!(k < 2 || goal == 3);
    }
    // A goal inside an obstacle is left out; indices still count it.
    let occupied = |a: &P, b: &P| b[0] < 5.9 && serpentine(0.4)(a, b);
    for plan in all(&[[6.0, 1.0], GOAL], &occupied, &short_steps()) {
        assert_eq!(plan.expect("a fair question").goal, Some(1));
    }
}

#[test]
fn the_straight_motion_ends_the_search_at_once() {
    let open: Free<'_> = &|_, _| true;
    for plan in all(&[GOAL, [0.5, 1.5]], open, &short_steps()) {
        let plan = plan.expect("a fair question");
        assert_eq!(
            (plan.stop, plan.iterations, plan.goal),
            (Stop::Straight, 0, Some(1))
        );
        assert_eq!(plan.path.expect("a path").points(), [START, [0.5, 1.5]]);
    }
    for plan in all(
        &[GOAL],
        open,
        &RrtConfig {
            try_straight: false,
            ..short_steps()
        },
    ) {
        assert!(plan.expect("a fair question").iterations > 0);
    }
}

#[test]
fn one_way_streets_are_respected() {
    // Only motions that do not go back in x are free.
    let forward: Free<'_> = &|a, b| b[0] >= a[0] && serpentine(2.0)(a, b);
    for plan in all(&[GOAL], forward, &short_steps()) {
        let path = plan.expect("a fair question").path.expect("a path");
        assert!(path.segments().all(|(a, b)| b[0] >= a[0]));
    }
}
