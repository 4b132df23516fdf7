//! Seeded rooms with doors, seen by a turning camera: plans, features, outliers and the truth.
#![allow(
    dead_code,
    unused_imports,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "shared by tests and examples, each uses its part"
)]

mod camera;
mod corruption;
mod curved;
mod plan;

pub use corruption::{cleaned, corrupted};
pub use plan::{Kind, Plan};

use rand::RngExt;
use rand_pcg::Pcg64;

/// One scan of one room, in the map's frame (z up, random yaw, random scale).
pub struct Scan {
    /// Map points.
    pub points: Vec<[f64; 3]>,
    /// So many of them, the first ones, are genuine; outliers follow.
    pub genuine: usize,
    /// What a cleaning took out, if it is told to the search; genuine ones first.
    pub doubtful: Vec<[f64; 3]>,
    pub genuine_doubtful: usize,
    /// The agent.
    pub agent: [f64; 3],
    /// The true openings as (start bearing, angular width), radians, in the map's frame.
    pub openings: Vec<Opening>,
    /// Map units per metre.
    pub scale: f64,
    /// How far the map is turned against the plan, radians.
    pub yaw: f64,
    /// Length and width of the room, metres; it lies at `[0, length] × [0, width]` of the plan.
    pub size: [f64; 2],
    /// The agent in the plan, metres.
    pub place: [f64; 2],
}

impl Scan {
    /// Genuine points of the map as it is now, doubtful ones as well, at least half a metre behind the wall, seen
    /// through an opening.
    pub fn evidence(&self, opening: &Opening) -> usize {
        let (sin, cos) = self.yaw.sin_cos();
        let behind = |p: &&[f64; 3]| {
            let d = [p[0] - self.agent[0], p[1] - self.agent[1]];
            let turned = [cos * d[0] + sin * d[1], cos * d[1] - sin * d[0]];
            let off = (d[1].atan2(d[0]) - opening.start).rem_euclid(std::f64::consts::TAU);
            let outside = |i: usize| {
                let x = self.place[i] + turned[i] / self.scale;
                (-x).max(x - self.size[i])
            };
            off < opening.width && outside(0).max(outside(1)) > 0.5
        };
        let doubtful = &self.doubtful[..self.genuine_doubtful];
        let genuine = self.points[..self.genuine].iter().chain(doubtful);
        genuine.filter(behind).count()
    }

    /// Keeps the points with these ascending indices.
    pub fn keep(&mut self, kept: &[usize]) {
        self.genuine = kept.partition_point(|&index| index < self.genuine);
        self.points = kept.iter().map(|&index| self.points[index]).collect();
    }

    /// Keeps the points with these ascending indices and has the search doubt the others.
    pub fn keep_and_doubt(&mut self, kept: &[usize]) {
        let is_kept = |index: &usize| kept.binary_search(index).is_ok();
        let taken_out: Vec<usize> = (0..self.points.len()).filter(|i| !is_kept(i)).collect();
        self.genuine_doubtful = taken_out.partition_point(|&index| index < self.genuine);
        self.doubtful = taken_out.iter().map(|&index| self.points[index]).collect();
        self.keep(kept);
    }
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
pub fn scan(kind: Kind, doors: usize, dark: bool, rng: &mut Pcg64) -> Scan {
    let plan = Plan::random(kind, doors, dark, rng);
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
        genuine: points.len(),
        doubtful: Vec::new(),
        genuine_doubtful: 0,
        points: points.into_iter().map(to_map).collect(),
        agent,
        openings,
        scale,
        yaw,
        size: plan.size,
        place: plan.agent,
    }
}
