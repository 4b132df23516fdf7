//! Rooms made from a seed: textured patches on walls and boxes, depth noise, three kinds of outliers.

use super::Labelled;
use rand::{Rng, RngExt};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;

/// What a generated cloud looks like.
pub struct Room {
    pub points: usize,
    /// Share of outliers, 0 to 1.
    pub outliers: f64,
    /// Textured patches that most of the points lie on.
    pub patches: usize,
    pub seed: u64,
}

impl Room {
    /// The cloud whose cleaning is timed: patches grow with the points, so that their density does not.
    pub fn for_timing(points: usize) -> Self {
        Self {
            points,
            outliers: 0.15,
            patches: 100 + points / 50,
            seed: 1,
        }
    }

    /// One floor of 12 x 7 x 2.6 m with a cross wall and furniture.
    pub fn make(&self) -> Labelled {
        let mut rng = Pcg64::seed_from_u64(self.seed);
        let boxes = furniture(&mut rng);
        let bad = (self.points as f64 * self.outliers) as usize;
        let mut points = Vec::with_capacity(self.points);
        let patches: Vec<Patch> = (0..self.patches)
            .map(|_| Patch::new(&boxes, &mut rng))
            .collect();
        while points.len() < self.points - bad {
            let textured = rng.random::<f64>() < 0.92;
            let patch = &patches[(rng.random::<f64>().powi(2) * patches.len() as f64) as usize];
            let at = if textured {
                patch.sample(&mut rng)
            } else {
                Patch::new(&boxes, &mut rng).center
            };
            points.push(noisy(at, camera_near(at, &mut rng), &mut rng));
        }
        let inliers = points.len();
        while points.len() < self.points {
            let kind = rng.random::<f64>();
            let far = |p: &[f64; 3], d: f64| boxes.iter().all(|b| b.distance(*p) > d);
            if kind < 0.3 {
                points.extend(Some(anywhere(&mut rng)).filter(|p| far(p, 0.2)));
            } else if kind < 0.97 {
                let at = points[rng.random_range(0..inliers)];
                let camera = camera_near(at, &mut rng);
                let near = rng.random::<bool>();
                let f = if near {
                    uniform(&mut rng, 0.25, 0.85)
                } else {
                    uniform(&mut rng, 1.2, 2.5)
                };
                let moved = [0, 1, 2].map(|i| camera[i] + (at[i] - camera[i]) * f);
                points.extend(Some(moved).filter(|p| far(p, 0.2)));
            } else {
                let center = anywhere(&mut rng);
                if far(&center, 0.45) {
                    let size = rng.random_range(4..13).min(self.points - points.len());
                    points.extend((0..size).map(|_| center.map(|c| c + 0.05 * normal(&mut rng))));
                }
            }
        }
        let outlier = (0..points.len()).map(|v| Some(v >= inliers)).collect();
        let name = format!(
            "room n={} outliers={:.0} %",
            self.points,
            100.0 * self.outliers
        );
        Labelled {
            name,
            points,
            views: None,
            outlier,
        }
    }
}

struct Block {
    low: [f64; 3],
    high: [f64; 3],
}

impl Block {
    fn distance(&self, p: [f64; 3]) -> f64 {
        let outside = |i: usize| (self.low[i] - p[i]).max(p[i] - self.high[i]).max(0.0);
        (0..3).map(|i| outside(i) * outside(i)).sum::<f64>().sqrt()
    }
}

/// Walls of 10 cm, floor and ceiling, a cross wall, and two dozen boxes.
fn furniture(rng: &mut impl Rng) -> Vec<Block> {
    let (x, y, z) = (SIZE[0], SIZE[1], SIZE[2]);
    let wall = |low: [f64; 3], high: [f64; 3]| Block { low, high };
    let mut boxes = vec![
        wall([0.0, -0.1, 0.0], [x, 0.0, z]),
        wall([0.0, y, 0.0], [x, y + 0.1, z]),
        wall([-0.1, 0.0, 0.0], [0.0, y, z]),
        wall([x, 0.0, 0.0], [x + 0.1, y, z]),
        wall([0.0, 0.0, -0.1], [x, y, 0.0]),
        wall([0.0, 0.0, z], [x, y, z + 0.1]),
        wall([x / 2.0, 1.0, 0.0], [x / 2.0 + 0.1, y, z]),
    ];
    for _ in 0..24 {
        let size = [
            uniform(rng, 0.3, 1.2),
            uniform(rng, 0.3, 1.2),
            uniform(rng, 0.4, 1.8),
        ];
        let low = [uniform(rng, 0.0, x - 1.2), uniform(rng, 0.0, y - 1.2), 0.0];
        boxes.push(wall(low, [0, 1, 2].map(|i| low[i] + size[i])));
    }
    boxes
}

struct Patch {
    center: [f64; 3],
    spread: [f64; 3],
}

impl Patch {
    /// On a random face of a random box.
    fn new(boxes: &[Block], rng: &mut impl Rng) -> Self {
        let b = &boxes[rng.random_range(0..boxes.len())];
        let axis = rng.random_range(0..3);
        let width = uniform(rng, 0.03, 0.25);
        let mut center = [0, 1, 2].map(|i| uniform(rng, b.low[i], b.high[i]));
        let mut spread = [width; 3];
        center[axis] = if rng.random::<bool>() {
            b.low[axis]
        } else {
            b.high[axis]
        };
        spread[axis] = 0.0;
        Self { center, spread }
    }

    fn sample(&self, rng: &mut impl Rng) -> [f64; 3] {
        [0, 1, 2].map(|i| self.center[i] + self.spread[i] * normal(rng))
    }
}

fn camera_near(at: [f64; 3], rng: &mut impl Rng) -> [f64; 3] {
    let near = |i: usize, rng: &mut _| (at[i] + 2.5 * normal(rng)).clamp(0.5, SIZE[i] - 0.5);
    [near(0, rng), near(1, rng), uniform(rng, 1.0, 1.5)]
}

/// Depth noise of 0.6 % z + 0.4 % z² along the ray.
fn noisy(at: [f64; 3], camera: [f64; 3], rng: &mut impl Rng) -> [f64; 3] {
    let z = (0..3)
        .map(|i| (at[i] - camera[i]).powi(2))
        .sum::<f64>()
        .sqrt()
        .min(4.6);
    let shift = (0.006 + 0.004 * z) * normal(rng);
    [0, 1, 2].map(|i| at[i] + (at[i] - camera[i]) * shift)
}

fn anywhere(rng: &mut impl Rng) -> [f64; 3] {
    [0, 1, 2].map(|i| uniform(rng, -1.0, SIZE[i] + 1.0))
}

fn uniform(rng: &mut impl Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.random::<f64>()
}

/// The sum of twelve uniform numbers: normal enough.
fn normal(rng: &mut impl Rng) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

const SIZE: [f64; 3] = [12.6, 7.2, 2.6];
