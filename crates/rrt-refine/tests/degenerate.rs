//! Questions that make no sense are refused with the numbers; those that are trivial are answered.

#![allow(
    clippy::expect_used,
    reason = "a broken expectation must fail the test"
)]

use rand_pcg::Pcg64;
use rrt_refine::refine::TautConfig;
use rrt_refine::{
    Bounds, ConfigError, FindPathConfig, Plan, PlanError, Query, RrtConfig, RrtStarConfig, Stop,
    find_path, rrt, rrt_connect, rrt_star,
};

type P = [f64; 2];

fn ask(
    start: P,
    goals: &[P],
    bounds: &Bounds<2>,
    config: &RrtConfig,
) -> [Result<Plan<2>, PlanError>; 3] {
    let query = Query::to_any_of(start, goals, *bounds);
    // The upper half is an obstacle.
    let free = |a: &P, b: &P| a[1] < 0.5 && b[1] < 0.5;
    let star = RrtStarConfig {
        rrt: *config,
        ..Default::default()
    };
    let rng = || Pcg64::new(1, 1);
    [
        rrt(&query, &free, config, &mut rng()),
        rrt_connect(&query, &free, config, &mut rng()),
        rrt_star(&query, &free, &star, &mut rng()),
    ]
}

fn unit() -> Bounds<2> {
    Bounds::new([0.0; 2], [1.0; 2]).expect("a box")
}

fn refused(start: P, goals: &[P], config: &RrtConfig) -> PlanError {
    let [a, b, c] = ask(start, goals, &unit(), config).map(|answer| answer.expect_err("refused"));
    // By their words: a NaN does not equal itself.
    assert_eq!(
        [a.to_string(), a.to_string()],
        [b.to_string(), c.to_string()]
    );
    a
}

const INSIDE: P = [0.1, 0.1];

#[test]
fn starts_and_goals_that_make_no_sense_are_refused() {
    let config = RrtConfig::default();
    assert!(matches!(
        refused([f64::NAN, 0.0], &[INSIDE], &config),
        PlanError::StartNotFinite { axis: 0, .. }
    ));
    assert!(matches!(
        refused([0.0, f64::INFINITY], &[INSIDE], &config),
        PlanError::StartNotFinite { axis: 1, .. }
    ));
    assert!(matches!(
        refused([0.0, 1.5], &[INSIDE], &config),
        PlanError::StartOutside { axis: 1, .. }
    ));
    assert_eq!(
        refused([0.1, 0.9], &[INSIDE], &config),
        PlanError::StartNotFree
    );
    assert_eq!(refused(INSIDE, &[], &config), PlanError::NoGoal);
    assert!(matches!(
        refused(INSIDE, &[[0.2, f64::NAN]], &config),
        PlanError::GoalNotFinite {
            index: 0,
            axis: 1,
            ..
        }
    ));
    assert!(matches!(
        refused(INSIDE, &[[0.2, 0.2], [-0.1, 0.2]], &config),
        PlanError::GoalOutside {
            index: 1,
            axis: 0,
            ..
        }
    ));
    assert_eq!(
        refused(INSIDE, &[[0.2, 0.8], [0.3, 0.9]], &config),
        PlanError::NoFreeGoal { goals: 2 }
    );
}

#[test]
fn parameters_out_of_range_are_refused() {
    let good = RrtConfig::default();
    for step_length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refused(
            INSIDE,
            &[[0.2, 0.2]],
            &RrtConfig {
                step_length,
                ..good
            },
        );
        assert!(matches!(
            error,
            PlanError::Config(ConfigError::StepLength { .. })
        ));
    }
    for goal_bias in [-0.1, 1.1, f64::NAN] {
        let error = refused(INSIDE, &[[0.2, 0.2]], &RrtConfig { goal_bias, ..good });
        assert!(matches!(
            error,
            PlanError::Config(ConfigError::GoalBias { .. })
        ));
    }
    let error = refused(
        INSIDE,
        &[[0.2, 0.2]],
        &RrtConfig {
            max_nodes: 0,
            ..good
        },
    );
    assert!(matches!(
        error,
        PlanError::Config(ConfigError::MaxNodes { value: 0 })
    ));
    let pipeline = FindPathConfig::default();
    let broken = TautConfig {
        min_gain: -1.0,
        ..pipeline.taut
    };
    for (config, expected) in [
        (
            FindPathConfig {
                attempts: 0,
                ..pipeline
            },
            "attempts is 0",
        ),
        (
            FindPathConfig {
                taut: broken,
                ..pipeline
            },
            "min_gain is -1",
        ),
        (
            FindPathConfig {
                min_gain: 1.0,
                ..pipeline
            },
            "min_gain is 1",
        ),
        (
            FindPathConfig {
                first_gain: 1.0,
                ..pipeline
            },
            "first_gain is 1",
        ),
    ] {
        let query = Query::new(INSIDE, [0.2, 0.2], unit());
        let open = |_: &P, _: &P| true;
        let error = find_path(&query, &open, &config, &mut Pcg64::new(1, 1)).expect_err("refused");
        assert!(error.to_string().contains(expected), "{error}");
    }
    for rewire_factor in [0.0, 0.9, f64::NAN, f64::INFINITY] {
        let config = RrtStarConfig {
            rewire_factor,
            ..Default::default()
        };
        assert!(matches!(
            config.validate(),
            Err(ConfigError::RewireFactor { .. })
        ));
    }
}

#[test]
fn a_start_that_is_a_goal_is_a_path_of_one_vertex() {
    for config in [
        RrtConfig::default(),
        RrtConfig::paper(),
        RrtConfig {
            max_iterations: 0,
            ..RrtConfig::default()
        },
    ] {
        for plan in ask(INSIDE, &[[0.3, 0.3], INSIDE], &unit(), &config) {
            let plan = plan.expect("a fair question");
            assert_eq!((plan.stop, plan.goal), (Stop::Straight, Some(1)));
            assert_eq!(plan.path.expect("a path").points(), [INSIDE]);
        }
    }
}

#[test]
fn no_iterations_give_no_path() {
    let config = RrtConfig {
        max_iterations: 0,
        ..RrtConfig::default()
    };
    for plan in ask(INSIDE, &[[0.4, 0.4]], &unit(), &config) {
        let plan = plan.expect("a fair question");
        assert_eq!(
            (plan.path, plan.stop, plan.iterations),
            (None, Stop::Iterations, 0)
        );
    }
}

#[test]
fn bounds_without_width_are_planned_in() {
    // The only point there is.
    let point = Bounds::new(INSIDE, INSIDE).expect("a box");
    for plan in ask(INSIDE, &[INSIDE], &point, &RrtConfig::default()) {
        assert!(plan.expect("a fair question").path.is_some());
    }
    // A line: every sample lies on it.
    let line = Bounds::new([0.0, 0.1], [1.0, 0.1]).expect("a box");
    let config = RrtConfig {
        step_length: 0.1,
        ..RrtConfig::paper()
    };
    for plan in ask(INSIDE, &[[0.9, 0.1]], &line, &config) {
        let path = plan.expect("a fair question").path.expect("a path");
        assert!(path.points().iter().all(|p| p[1] == 0.1));
    }
}

#[test]
fn extreme_steps_neither_hang_nor_fail() {
    for step_length in [1e-300, 1e-17, 1e300] {
        let config = RrtConfig {
            step_length,
            max_iterations: 200,
            max_nodes: 200,
            ..RrtConfig::paper()
        };
        for plan in ask(INSIDE, &[[0.4, 0.4]], &unit(), &config) {
            let plan = plan.expect("a fair question");
            assert!(plan.iterations <= 200 && plan.nodes <= 201);
        }
    }
}

#[test]
fn a_goal_bias_of_one_is_trapped_but_ends() {
    // A wall that the straight way hits.
    let free = |a: &P, b: &P| (a[0] < 0.5) == (b[0] < 0.5);
    let config = RrtConfig {
        goal_bias: 1.0,
        max_iterations: 100,
        step_length: 0.1,
        ..Default::default()
    };
    let plan = rrt(
        &Query::new(INSIDE, [0.9, 0.1], unit()),
        &free,
        &config,
        &mut Pcg64::new(1, 1),
    )
    .expect("fair");
    assert_eq!((plan.path, plan.stop), (None, Stop::Iterations));
}
