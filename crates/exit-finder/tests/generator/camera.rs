//! What a camera that turns on the spot maps of a plan: visibility, loss with range, depth noise.

use rand::RngExt;
use rand_pcg::Pcg64;

use super::plan::{CEILING, Panel, Plan};

/// Flying height, metres.
pub const HEIGHT: f64 = 1.2;
/// Half the vertical field of view: 25 degrees.
pub(super) const MAX_SLOPE: f64 = 0.466;
/// The densities of the plan hold for surfaces seen head on from here. A detector fills the image
/// evenly, so a surface yields features in proportion to the solid angle it fills.
const REFERENCE: f64 = 3.0;
/// Nearer surfaces than `REFERENCE / √CLOSEST` show no more detail.
const CLOSEST: f64 = 8.0;
/// Beyond this range parallax is short: features are triangulated with probability (reach / range)².
const REACH: f64 = 7.0;

/// A point of the sparse map and the feature it stands for, metres.
#[derive(Debug, Clone, Copy)]
pub struct Feature {
    pub mapped: [f64; 3],
    pub truth: [f64; 3],
}

/// The points of the sparse map.
pub fn features(plan: &Plan, rng: &mut Pcg64) -> Vec<Feature> {
    let texture = rng.random_range(0.6..2.5);
    let mut points = Vec::new();
    for panel in &plan.panels {
        let length = (panel.b[0] - panel.a[0]).hypot(panel.b[1] - panel.a[1]);
        let area = length * (panel.z[1] - panel.z[0]);
        let (s, height) = (panel.density * texture * area, panel.z[1] - panel.z[0]);
        let normal = [
            (panel.b[1] - panel.a[1]) / length,
            (panel.a[0] - panel.b[0]) / length,
            0.0,
        ];
        for _ in 0..whole(CLOSEST * s, rng) {
            let t: f64 = rng.random();
            let z = panel.z[0] + height * rng.random::<f64>();
            let p: [f64; 2] = std::array::from_fn(|i| panel.a[i] + t * (panel.b[i] - panel.a[i]));
            points.extend(observe(plan, [p[0], p[1], z], normal, rng));
        }
    }
    for &(low, high, density) in &plan.floors {
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        for level in [0.0, CEILING] {
            for _ in 0..whole(CLOSEST * density * texture * area, rng) {
                let p: [f64; 2] =
                    std::array::from_fn(|i| low[i] + rng.random::<f64>() * (high[i] - low[i]));
                points.extend(observe(plan, [p[0], p[1], level], [0.0, 0.0, 1.0], rng));
            }
        }
    }
    points
}

/// Rounds up or down at random, keeping the mean.
fn whole(expected: f64, rng: &mut Pcg64) -> usize {
    (expected + rng.random::<f64>()) as usize
}

/// The map point of a feature seen from two places near the agent, or nothing.
fn observe(plan: &Plan, p: [f64; 3], normal_to: [f64; 3], rng: &mut Pcg64) -> Option<Feature> {
    let eye = [plan.agent[0], plan.agent[1], HEIGHT];
    let ray: [f64; 3] = std::array::from_fn(|i| p[i] - eye[i]);
    let flat = ray[0].hypot(ray[1]);
    let range = flat.hypot(ray[2]);
    if flat < 0.2 || ray[2].abs() > MAX_SLOPE * flat || range > 14.0 {
        return None;
    }
    let incidence = (0..3).map(|i| ray[i] * normal_to[i]).sum::<f64>().abs() / range;
    let angle = ((REFERENCE / range).powi(2) / CLOSEST).min(1.0) * incidence;
    if rng.random::<f64>() > angle * (REACH / range).powi(2).min(1.0) {
        return None;
    }
    for _ in 0..2 {
        let place = [0, 1, 2].map(|i| eye[i] + 0.15 * rng.random_range(-1.0..1.0));
        if plan.panels.iter().any(|panel| hides(panel, place, p)) {
            return None;
        }
    }
    let sigma = 0.006 * range + 0.006 * range * range;
    let factor = 1.0 + sigma / range * normal(rng);
    Some(Feature {
        mapped: std::array::from_fn(|i| eye[i] + ray[i] * factor.max(0.2)),
        truth: p,
    })
}

/// Whether a panel lies between an eye and a point; the panel the point is on does not.
pub(super) fn hides(panel: &Panel, eye: [f64; 3], p: [f64; 3]) -> bool {
    let d = [p[0] - eye[0], p[1] - eye[1]];
    let e = [panel.b[0] - panel.a[0], panel.b[1] - panel.a[1]];
    let cross = d[0] * e[1] - d[1] * e[0];
    if cross.abs() < 1e-12 {
        return false;
    }
    let w = [panel.a[0] - eye[0], panel.a[1] - eye[1]];
    let s = (w[0] * e[1] - w[1] * e[0]) / cross;
    let t = (w[0] * d[1] - w[1] * d[0]) / cross;
    let z = eye[2] + s * (p[2] - eye[2]);
    s > 0.0 && s < 1.0 - 1e-6 && (0.0..=1.0).contains(&t) && z >= panel.z[0] && z <= panel.z[1]
}

/// A standard normal number (sum of twelve uniforms).
pub fn normal(rng: &mut Pcg64) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}
