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
mod keyframes;
mod plan;

pub use corruption::{cleaned, corrupted};
pub use keyframes::{HALF_VIEW, Keyframe};
pub use plan::{Kind, Plan};

use exit_finder::Ray;
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
    /// The keyframes, in the map's frame, and which of them observe which point and which doubtful point; none before
    /// [`Scan::observe`].
    pub keyframes: Vec<Keyframe>,
    pub observers: Vec<Vec<usize>>,
    pub doubtful_observers: Vec<Vec<usize>>,
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
    plan: Plan,
    /// Where the genuine points truly lie, in the plan, before any cleaning.
    truths: Vec<[f64; 3]>,
    shift: [f64; 3],
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

    /// Flies the scan and the triangle and notes which keyframe observes which point, wrong ones too. To be called before
    /// any cleaning.
    pub fn observe(&mut self, rng: &mut Pcg64) {
        let keyframes = keyframes::flown(&self.plan, rng);
        let observers = self.points.iter().enumerate().map(|(index, &point)| {
            if index < self.genuine {
                keyframes::of_feature(&self.plan, &keyframes, self.truths[index], rng)
            } else {
                keyframes::of_wrong(&keyframes, self.in_plan(point), rng)
            }
        });
        self.observers = observers.collect();
        let mapped = keyframes.into_iter().map(|keyframe| Keyframe {
            position: in_map(keyframe.position, self.yaw, self.scale, self.shift),
            yaw: keyframe.yaw + self.yaw,
        });
        self.keyframes = mapped.collect();
    }

    /// Where the keyframes are.
    pub fn viewpoints(&self) -> Vec<[f64; 3]> {
        let places = self.keyframes.iter().map(|keyframe| keyframe.position);
        places.collect()
    }

    /// A ray from every keyframe to every point that it observes, doubtful ones too; none before [`Scan::observe`].
    pub fn rays(&self) -> Vec<Ray> {
        let kept = self.points.iter().zip(&self.observers);
        let doubtful = self.doubtful.iter().zip(&self.doubtful_observers);
        kept.chain(doubtful)
            .flat_map(|(&end, observers)| self.rays_of(end, observers))
            .collect()
    }

    /// A ray from every keyframe that observes a point of the map.
    pub fn rays_to(&self, index: usize) -> impl Iterator<Item = Ray> + '_ {
        self.rays_of(self.points[index], &self.observers[index])
    }

    fn rays_of<'a>(
        &'a self,
        end: [f64; 3],
        observers: &'a [usize],
    ) -> impl Iterator<Item = Ray> + 'a {
        observers.iter().map(move |&k| Ray {
            origin: self.keyframes[k].position,
            end,
        })
    }

    fn in_plan(&self, p: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = self.yaw.sin_cos();
        let [x, y, z] = std::array::from_fn(|i| (p[i] - self.shift[i]) / self.scale);
        [cos * x + sin * y, cos * y - sin * x, z]
    }

    /// Keeps the points with these ascending indices.
    pub fn keep(&mut self, kept: &[usize]) {
        self.genuine = kept.partition_point(|&index| index < self.genuine);
        self.points = kept.iter().map(|&index| self.points[index]).collect();
        if !self.observers.is_empty() {
            let observers = kept.iter().map(|&index| self.observers[index].clone());
            self.observers = observers.collect();
        }
    }

    /// Keeps the points with these ascending indices and has the search doubt the others.
    pub fn keep_and_doubt(&mut self, kept: &[usize]) {
        let is_kept = |index: &usize| kept.binary_search(index).is_ok();
        let taken_out: Vec<usize> = (0..self.points.len()).filter(|i| !is_kept(i)).collect();
        self.genuine_doubtful = taken_out.partition_point(|&index| index < self.genuine);
        self.doubtful = taken_out.iter().map(|&index| self.points[index]).collect();
        if !self.observers.is_empty() {
            let observers = taken_out.iter().map(|&index| self.observers[index].clone());
            self.doubtful_observers = observers.collect();
        }
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
    let features = camera::features(&plan, rng);
    let points: Vec<[f64; 3]> = features.iter().map(|feature| feature.mapped).collect();
    let scale = rng.random_range(-1.6f64..1.6).exp();
    let yaw = rng.random_range(0.0..std::f64::consts::TAU);
    let shift: [f64; 3] = std::array::from_fn(|_| rng.random_range(-5.0..5.0));
    let to_map = |p: [f64; 3]| in_map(p, yaw, scale, shift);
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
        keyframes: Vec::new(),
        observers: Vec::new(),
        doubtful_observers: Vec::new(),
        truths: features.iter().map(|feature| feature.truth).collect(),
        plan,
        shift,
    }
}

/// A place of the plan in the map's frame.
fn in_map(p: [f64; 3], yaw: f64, scale: f64, shift: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = yaw.sin_cos();
    let turned = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]];
    std::array::from_fn(|i| scale * turned[i] + shift[i])
}
