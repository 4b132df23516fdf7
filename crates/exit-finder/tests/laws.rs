//! Equivariance, invariance and degenerate inputs.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod walls;

use exit_finder::{
    AffinePlane, ExitConfig, ExitError, ExitReport, ExitView, RangeProfile, find_exits,
};
use proptest::prelude::*;
use walls::{Walls, room};

fn scene() -> Vec<[f64; 3]> {
    let main = room(
        [-2.0, -1.5],
        [3.0, 2.5],
        [Some([1.0, 2.0]), None, Some([2.5, 3.6]), None],
    );
    let hall = room([-6.0, -5.0], [7.0, 6.0], [None; 4]);
    Walls([main.0, hall.0].concat()).seen_from([0.3, 0.2], 1080, 20.0)
}

const AGENT: [f64; 3] = [0.3, 0.2, 1.0];

fn search(
    points: &[[f64; 3]],
    agent: [f64; 3],
    plane: &AffinePlane,
    config: &ExitConfig,
) -> ExitReport {
    find_exits(points, agent, plane, &ExitView::default(), config).unwrap()
}

fn configs() -> [ExitConfig; 2] {
    [ExitConfig::default(), ExitConfig::paper_repaired()]
}

/// Rotation about z by whole bins, then scaling and a shift.
fn moved(p: [f64; 3], bins: u32, scale: f64, shift: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = f64::from(bins).to_radians().sin_cos();
    let turned = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
    std::array::from_fn(|i| scale * turned[i] + shift[i])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn turning_shifting_and_scaling_the_cloud_moves_the_exits(
        bins in 0u32..360, log_scale in -3.0f64..3.0, x in -50.0f64..50.0, y in -50.0f64..50.0,
    ) {
        let up = [0.0, 0.0, 1.0];
        let (scale, shift) = (log_scale.exp(), [x, y, 0.3 * x]);
        // The rays lie away from the edges of the bins, so that rounding moves no point across one.
        let before = scene();
        let after: Vec<[f64; 3]> = before.iter().map(|&p| moved(p, bins, scale, shift)).collect();
        for config in configs() {
            let plane = AffinePlane::from_up(up, AGENT).unwrap();
            let first = search(&before, AGENT, &plane, &config);
            let agent = moved(AGENT, bins, scale, shift);
            let plane = AffinePlane::from_up(up, agent).unwrap();
            let second = search(&after, agent, &plane, &config);
            prop_assert_eq!(first.exits.len(), second.exits.len());
            for (a, b) in first.exits.iter().zip(&second.exits) {
                let expected = moved(a.position, bins, scale, shift);
                let off = (0..3).map(|i| (expected[i] - b.position[i]).abs()).fold(0.0, f64::max);
                prop_assert!(off < 1e-5 * scale);
                prop_assert!((a.width * scale - b.width).abs() < 1e-6 * scale);
                prop_assert!((a.score - b.score).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn the_order_of_the_points_changes_no_bit(seed in 1usize..10_000) {
        let points = scene();
        let n = points.len();
        let step = (1..).map(|k| seed + k).find(|&step| gcd(step, n) == 1).unwrap();
        let shuffled: Vec<[f64; 3]> = (0..n).map(|i| points[(i * step) % n]).collect();
        let plane = AffinePlane::from_up([0.0, 0.0, 1.0], AGENT).unwrap();
        for config in [ExitConfig::default(), ExitConfig::paper()] {
            prop_assert_eq!(
                search(&points, AGENT, &plane, &config),
                search(&shuffled, AGENT, &plane, &config)
            );
        }
    }

    #[test]
    fn no_input_panics(
        points in prop::collection::vec(prop::array::uniform3(wild()), 0..80),
        agent in prop::array::uniform3(wild()), bins in 8usize..40, min_points in 0usize..40,
    ) {
        let plane = AffinePlane::from_up([0.0, -1.0, 0.2], [0.0; 3]).unwrap();
        for config in [ExitConfig::default(), ExitConfig::paper(), ExitConfig::paper_repaired()] {
            let config = ExitConfig { bins, min_points, ..config };
            if let Ok(report) = find_exits(&points, agent, &plane, &ExitView::default(), &config) {
                for exit in &report.exits {
                    prop_assert!(exit.score.is_finite() && exit.bearing_rad < std::f64::consts::TAU);
                }
            }
        }
    }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -3.0f64..3.0,
        1 => Just(0.0),
        1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, -1e308, 1e200, 1e-300]),
    ]
}

#[test]
fn a_mirrored_plane_finds_the_same_exits() {
    let points = scene();
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], AGENT).unwrap();
    let [x, y] = plane.axes();
    let mirrored = AffinePlane::from_basis(AGENT, [x, y.map(|c| -c)]).unwrap();
    assert!(mirrored.normal()[2] < 0.0);
    for config in configs() {
        let first = search(&points, AGENT, &plane, &config);
        let second = search(&points, AGENT, &mirrored, &config);
        assert_eq!(first.exits.len(), second.exits.len());
        for exit in &first.exits {
            let close = |other: &exit_finder::Exit| {
                (0..3).all(|i| (other.position[i] - exit.position[i]).abs() < 0.15)
            };
            assert!(second.exits.iter().any(close));
        }
    }
}

#[test]
fn thin_maps_are_insufficient_and_say_why() {
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    let search = |points: &[[f64; 3]]| {
        find_exits(
            points,
            [0.0; 3],
            &plane,
            &ExitView::default(),
            &ExitConfig::default(),
        )
    };
    assert!(matches!(
        search(&[]),
        Err(ExitError::InsufficientMap { given: 0, .. })
    ));
    let at_agent = vec![[0.0, 0.0, 0.5]; 100];
    assert!(matches!(
        search(&at_agent),
        Err(ExitError::InsufficientMap { at_agent: 100, .. })
    ));
    let broken = vec![[f64::NAN, 1.0, 0.0]; 100];
    assert!(matches!(
        search(&broken),
        Err(ExitError::InsufficientMap {
            non_finite: 100,
            ..
        })
    ));
    let few = vec![[1.0, 2.0, 0.0]; 29];
    assert!(matches!(
        search(&few),
        Err(ExitError::InsufficientMap { usable: 29, .. })
    ));
    let nowhere = find_exits(
        &few,
        [f64::NAN; 3],
        &plane,
        &ExitView::default(),
        &ExitConfig::default(),
    );
    assert!(matches!(nowhere, Err(ExitError::Agent { .. })));
}

#[test]
fn identical_points_leave_the_rest_unseen() {
    let points = vec![[1.0, 2.0, 0.0]; 300];
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
    let report = search(&points, [0.0; 3], &plane, &ExitConfig::default());
    assert!(report.exits.is_empty());
    assert!(report.unseen[0].width_rad > 6.0);
}

#[test]
fn the_profile_helpers_agree_with_each_other() {
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], AGENT).unwrap();
    let profile =
        RangeProfile::of_points(&scene(), &[], AGENT, &plane, &ExitConfig::default()).unwrap();
    for bin in 0..360 {
        assert_eq!(profile.bin_of(profile.centre_of(bin)), bin);
        assert_eq!(profile.bin_of(profile.start_of(bin) + 1e-9), bin);
        let stats = profile.bins[bin];
        assert!(stats.min <= stats.quantile && stats.quantile <= stats.median);
        let spoke = profile.spoke(bin).unwrap();
        let reach: f64 = (0..3)
            .map(|i| (spoke[i] - AGENT[i]).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!((reach - stats.mean).abs() < 1e-9);
    }
    assert_eq!(profile.counts.given, scene().len());
    let held = scene().iter().filter(|&&p| profile.holds(p)).count();
    assert_eq!(held, profile.counts.used);
    assert!(!profile.holds([0.4, 0.2, 9.0]));
}
