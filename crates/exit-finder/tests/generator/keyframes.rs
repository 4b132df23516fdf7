//! The keyframes of a scan and of the flown triangle, and which of them observe which point.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_pcg::Pcg64;

use super::camera::{HEIGHT, MAX_SLOPE, hides};
use super::plan::Plan;

/// A keyframe, in the frame of the plan or of the map.
#[derive(Debug, Clone, Copy)]
pub struct Keyframe {
    pub position: [f64; 3],
    /// Where the camera looks, radians.
    pub yaw: f64,
}

/// Half the horizontal field of view of a Tello.
pub const HALF_VIEW: f64 = 27.5 / 360.0 * TAU;
/// Keyframes of a full turn: every 9 degrees.
const SCAN: usize = 40;
/// The turn drifts and climbs so far to either side, metres: what the features are triangulated from.
const DRIFT: f64 = 0.15;
const CLIMB: f64 = 0.2;
/// A climb and a descent take a turn of so many radians.
const CLIMB_TURN: f64 = 0.5 * std::f64::consts::PI;
/// Side of the flown triangle, metres, along which the camera does not turn, and keyframes on each side.
const TRIANGLE: f64 = 0.4;
const LEG: usize = 2;
/// Chance that a keyframe which could see a point is matched to it.
const MATCH: f64 = 0.85;
/// How many keyframes see a wrong point, from two on, percent. As many as on a real map, `ORB-SLAM3` on 500 pictures of a kitchen, where
/// 418 of 4,393 points are off by more than 20 % in depth: those have 4 to 5, the others 6 in the median.
const OF_WRONG: [f64; 13] = [
    6.0, 17.0, 26.0, 19.0, 8.0, 5.0, 5.0, 2.0, 2.0, 1.0, 3.0, 3.0, 3.0,
];

/// The keyframes of a scan at the agent's place in the plan, then those of the triangle.
pub fn flown(plan: &Plan, rng: &mut Pcg64) -> Vec<Keyframe> {
    let first: f64 = rng.random_range(0.0..TAU);
    // A hovering drone wanders; from one keyframe to the next it is nearly where it was.
    let phases: [f64; 4] = std::array::from_fn(|_| rng.random_range(0.0..TAU));
    let drift = |axis: usize, turned: f64| {
        let wave = |k: usize| ((k + 1) as f64 * turned + phases[2 * axis + k]).sin();
        0.7 * DRIFT * (wave(0) + wave(1))
    };
    let mut keyframes: Vec<Keyframe> = (0..SCAN)
        .map(|k| {
            let turned = TAU * k as f64 / SCAN as f64;
            let climb = CLIMB * (4.0 * ((turned / CLIMB_TURN).fract() - 0.5).abs() - 1.0);
            let at = [0, 1].map(|axis| plan.agent[axis] + drift(axis, turned));
            Keyframe {
                position: [at[0], at[1], HEIGHT + climb],
                yaw: first + turned,
            }
        })
        .collect();
    let (sin, cos) = first.sin_cos();
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    for (from, to) in corners.iter().zip(&corners[1..]) {
        for k in 1..=LEG {
            let share = k as f64 / LEG as f64;
            let [x, y] = [0, 1].map(|i| TRIANGLE * (from[i] + share * (to[i] - from[i])));
            let offset = [cos * x - sin * y, sin * x + cos * y];
            keyframes.push(Keyframe {
                position: [plan.agent[0] + offset[0], plan.agent[1] + offset[1], HEIGHT],
                yaw: first,
            });
        }
    }
    keyframes
}

/// The keyframes that observe a feature of the plan: unhidden in the picture and matched, two at least.
pub fn of_feature(
    plan: &Plan,
    keyframes: &[Keyframe],
    feature: [f64; 3],
    rng: &mut Pcg64,
) -> Vec<usize> {
    let sees = |keyframe: &Keyframe| {
        let seen = |panel| hides(panel, keyframe.position, feature);
        in_picture(keyframe, feature) && !plan.panels.iter().any(seen)
    };
    let mut observers: Vec<usize> = (0..keyframes.len())
        .filter(|&k| sees(&keyframes[k]) && rng.random_bool(MATCH))
        .collect();
    if observers.len() < 2 {
        // It is in the map, so something between the keyframes saw it: the two that look towards it.
        observers = towards(keyframes, feature);
    }
    observers
}

/// The keyframes that observe a wrong point: neighbours in time, as many as on a real map.
pub fn of_wrong(keyframes: &[Keyframe], point: [f64; 3], rng: &mut Pcg64) -> Vec<usize> {
    let mut draw = rng.random::<f64>() * OF_WRONG.iter().sum::<f64>();
    let more = OF_WRONG.iter().position(|share| {
        draw -= share;
        draw < 0.0
    });
    let wanted = 2 + more.unwrap_or(0);
    let could: Vec<usize> = (0..keyframes.len())
        .filter(|&k| in_picture(&keyframes[k], point))
        .collect();
    if could.len() < 2 {
        return towards(keyframes, point);
    }
    let len = wanted.min(could.len());
    let first = rng.random_range(0..=could.len() - len);
    could[first..first + len].to_vec()
}

/// The two keyframes of the scan that look most nearly towards a point.
fn towards(keyframes: &[Keyframe], point: [f64; 3]) -> Vec<usize> {
    let mut all: Vec<usize> = (0..SCAN).collect();
    all.sort_by(|&a, &b| {
        let [a, b] = [a, b].map(|k| off_axis(&keyframes[k], point));
        a.total_cmp(&b)
    });
    all.truncate(2);
    all.sort_unstable();
    all
}

fn off_axis(keyframe: &Keyframe, point: [f64; 3]) -> f64 {
    let [dx, dy] = [0, 1].map(|i| point[i] - keyframe.position[i]);
    let off = dy.atan2(dx) - keyframe.yaw + 0.5 * TAU;
    (off.rem_euclid(TAU) - 0.5 * TAU).abs()
}

fn in_picture(keyframe: &Keyframe, point: [f64; 3]) -> bool {
    let d: [f64; 3] = std::array::from_fn(|i| point[i] - keyframe.position[i]);
    off_axis(keyframe, point) <= HALF_VIEW && d[2].abs() <= MAX_SLOPE * d[0].hypot(d[1])
}
