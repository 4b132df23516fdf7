//! Openings in a stack of height bands: a door, a counter, a staircase.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod walls;

use exit_finder::{AffinePlane, ExitConfig, ExitView, Shape, find_exits};
use walls::{Walls, room};

/// The room with a door, without what is behind it, at all heights from the floor to the ceiling.
fn surroundings() -> Vec<[f64; 3]> {
    let walls = room([-2.0; 2], [2.0; 2], [Some([1.5, 2.5]), None, None, None]);
    at_heights(&walls.seen_from([0.0; 2], 1080, 20.0), 0..12, 0.2)
}

fn at_heights(points: &[[f64; 3]], levels: std::ops::Range<u32>, step: f64) -> Vec<[f64; 3]> {
    let lifted = |p: &[f64; 3], z: f64| [p[0], p[1], z];
    levels
        .flat_map(|k| {
            points
                .iter()
                .step_by(5)
                .map(move |p| lifted(p, step * f64::from(k) + 0.05))
        })
        .collect()
}

/// A strip of points across the door, `distance` behind the agent's y = 0.
fn across(distance: f64, heights: [f64; 2]) -> Vec<[f64; 3]> {
    let half = 0.24 * distance;
    (0..60)
        .flat_map(|i| {
            let x = half * (f64::from(i) / 29.5 - 1.0);
            (0..10).map(move |k| {
                [
                    x,
                    -distance,
                    heights[0] + (heights[1] - heights[0]) * f64::from(k) / 9.0,
                ]
            })
        })
        .collect()
}

fn shape_with(behind: &[[f64; 3]]) -> Shape {
    let points = [surroundings(), behind.to_vec()].concat();
    shape_in(&points, [0.0, 0.0, 1.2], [0.0, 0.0, 1.0])
}

fn shape_in(points: &[[f64; 3]], agent: [f64; 3], up: [f64; 3]) -> Shape {
    let plane = AffinePlane::from_up(up, agent).unwrap();
    let config = ExitConfig::default();
    let report = find_exits(points, agent, &plane, &ExitView::default(), &config).unwrap();
    let best = report.best().unwrap();
    assert!((best.bearing_rad - 1.5 * std::f64::consts::PI).abs() < 0.05);
    let bands = [
        [-1.2, -0.8],
        [-0.8, -0.4],
        [-0.4, 0.0],
        [0.0, 0.4],
        [0.4, 0.8],
    ];
    best.passage(points, &report, &bands).shape
}

#[test]
fn a_door_is_open_to_the_floor() {
    assert_eq!(shape_with(&across(5.0, [0.05, 2.3])), Shape::Door);
}

#[test]
fn an_opening_above_a_counter_is_raised() {
    let counter = [across(2.0, [0.05, 0.75]), across(5.0, [0.8, 2.3])].concat();
    assert_eq!(shape_with(&counter), Shape::Raised);
}

#[test]
fn a_staircase_recedes_as_it_rises() {
    let steps: Vec<[f64; 3]> = (0..5)
        .flat_map(|k| {
            let low = 0.4 * f64::from(k);
            across(2.4 + 0.6 * f64::from(k), [low + 0.02, low + 0.38])
        })
        .collect();
    assert_eq!(shape_with(&steps), Shape::Stairs);
}

#[test]
fn nothing_seen_below_is_unknown() {
    let points = at_heights(&Walls::default().seen_from([0.0; 2], 8, 1.0), 0..1, 1.0);
    assert!(points.is_empty());
    assert_eq!(shape_with(&across(5.0, [1.6, 2.3])), Shape::Unknown);
}

#[test]
fn the_callers_up_tells_a_counter_from_a_lintel() {
    let counter = [across(2.0, [0.05, 0.75]), across(5.0, [0.8, 2.3])].concat();
    let world = [surroundings(), counter].concat();
    // A SLAM map: y down, z forward. A proper rotation, so bearings keep their sense.
    let camera = |[x, y, z]: [f64; 3]| [x, -z, y];
    let points: Vec<[f64; 3]> = world.iter().map(|&point| camera(point)).collect();
    let agent = camera([0.0, 0.0, 1.2]);
    assert_eq!(shape_in(&points, agent, [0.0, -1.0, 0.0]), Shape::Raised);
}
