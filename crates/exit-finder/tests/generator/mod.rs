//! Seeded rooms with doors, seen by a turning camera: plans, features, outliers and the truth.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "shared by tests and examples, each uses its part"
)]

mod camera;
mod corruption;
mod plan;

pub use corruption::{cleaned, corrupted};
pub use plan::Plan;

use rand::RngExt;
use rand_pcg::Pcg64;

/// One scan of one room, in the map's frame (z up, random yaw, random scale).
pub struct Scan {
    /// Map points without outliers.
    pub points: Vec<[f64; 3]>,
    /// The agent.
    pub agent: [f64; 3],
    /// The true openings as (start bearing, angular width), radians, in the map's frame.
    pub openings: Vec<Opening>,
    /// Map units per metre.
    pub scale: f64,
}

/// A true opening as the agent sees it.
#[derive(Debug, Clone, Copy)]
pub struct Opening {
    pub start: f64,
    pub width: f64,
    /// At least 10 degrees and half a metre wide as seen, and not hidden by furniture: must be found. Otherwise
    /// finding it is neither right nor wrong.
    pub fair: bool,
    /// Whether features beyond were there to be seen.
    pub seen_through: bool,
    /// Map points of what lies at least half a metre behind the wall, seen through this opening.
    pub behind: usize,
    /// Mean distance of those points behind the wall, metres.
    pub depth: f64,
}

/// Builds a plan with `doors` doors, scans it and moves it into an arbitrary map frame.
pub fn scan(doors: usize, dark: bool, rng: &mut Pcg64) -> Scan {
    let plan = Plan::random(doors, dark, rng);
    let points = camera::features(&plan, rng);
    let scale = rng.random_range(-1.6f64..1.6).exp();
    let yaw = rng.random_range(0.0..std::f64::consts::TAU);
    let shift: [f64; 3] = std::array::from_fn(|_| rng.random_range(-5.0..5.0));
    let (sin, cos) = yaw.sin_cos();
    let to_map = |p: [f64; 3]| {
        let turned = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
        std::array::from_fn(|i| scale * turned[i] + shift[i])
    };
    let openings = plan.openings(yaw, &points);
    let agent = to_map([plan.agent[0], plan.agent[1], camera::HEIGHT]);
    Scan {
        points: points.into_iter().map(to_map).collect(),
        agent,
        openings,
        scale,
    }
}
