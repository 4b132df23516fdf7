//! Random worlds of discs in a square, checked exactly.

#![allow(
    clippy::expect_used,
    reason = "a broken expectation must fail the test"
)]

use rand::RngExt;
use rand_pcg::Pcg64;
use rrt_refine::Bounds;

pub(crate) struct DiscWorld {
    pub(crate) side: f64,
    /// Centre and radius.
    pub(crate) discs: Vec<([f64; 2], f64)>,
}

impl DiscWorld {
    /// `count` discs of radius 0.5 to 1.2 that leave the lower left and the upper right corner free: start and goal.
    pub(crate) fn random(seed: u64, side: f64, count: usize) -> (Self, [f64; 2], [f64; 2]) {
        let mut rng = Pcg64::new(seed.into(), 17);
        let (start, goal) = ([0.5, 0.5], [side - 0.5, side - 0.5]);
        let mut discs = Vec::new();
        while discs.len() < count {
            let centre = [rng.random::<f64>() * side, rng.random::<f64>() * side];
            let radius = 0.5 + 0.7 * rng.random::<f64>();
            if gap(&centre, &start) > radius + 0.3 && gap(&centre, &goal) > radius + 0.3 {
                discs.push((centre, radius));
            }
        }
        (Self { side, discs }, start, goal)
    }

    pub(crate) fn bounds(&self) -> Bounds<2> {
        Bounds::new([0.0; 2], [self.side; 2]).expect("a square")
    }

    pub(crate) fn is_free(&self, a: &[f64; 2], b: &[f64; 2]) -> bool {
        self.discs.iter().all(|(centre, radius)| {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let squared = dx * dx + dy * dy;
            let along = (centre[0] - a[0]) * dx + (centre[1] - a[1]) * dy;
            let t = if squared > 0.0 {
                (along / squared).clamp(0.0, 1.0)
            } else {
                0.0
            };
            gap(centre, &[a[0] + t * dx, a[1] + t * dy]) >= *radius
        })
    }
}

pub(crate) fn gap(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt()
}
