//! Rooms whose walls follow a superellipse |x/a|^p + |y/b|^p = 1: round and oval ones (p = 2) up to rounded corners (p = 6).

use std::f64::consts::TAU;

use rand::RngExt;
use rand_pcg::Pcg64;

use super::plan::{Kind, Plan, shuffled_sides};

/// Pieces of wall of one texture, and straight pieces in each.
const PATCHES: usize = 20;
const PIECES: usize = 4;

impl Plan {
    pub(super) fn curved(doors: usize, dark: bool, rng: &mut Pcg64) -> Self {
        let length = rng.random_range(3.5..7.0);
        let size = [length, length * rng.random_range(0.6..1.0)];
        let mut plan = Self::empty(Kind::Curved, size, dark, rng);
        plan.exponent = rng.random_range(2.0..6.0);
        let sides = shuffled_sides(rng);
        let mut gaps = [None; 4];
        for &side in &sides[..doors] {
            let width = rng.random_range(0.8..1.3);
            let middle = plan.size[side % 2] * rng.random_range(0.42..0.58);
            gaps[side] = Some([middle - 0.5 * width, middle + 0.5 * width]);
        }
        plan.trace(&gaps, rng);
        for side in sides {
            if let Some(gap) = gaps[side] {
                let lintel = gap.map(|along| plan.on_curve(side, along));
                plan.door(side, gap, lintel, rng);
            }
        }
        plan.agent = plan.place_inside(rng);
        plan
    }

    /// The wall, but for its gaps.
    fn trace(&mut self, gaps: &[Option<[f64; 2]>; 4], rng: &mut Pcg64) {
        let pieces = PATCHES * PIECES;
        for patch in 0..PATCHES {
            let first = self.panels.len();
            let [a, b] = [patch, patch + 1].map(|k| self.at_angle(TAU * k as f64 / PATCHES as f64));
            self.patches([a, b], rng);
            let density = self.panels[first].density;
            self.panels.truncate(first);
            for piece in patch * PIECES..(patch + 1) * PIECES {
                let ends =
                    [piece, piece + 1].map(|k| self.at_angle(TAU * k as f64 / pieces as f64));
                self.around_gaps(ends, gaps, density);
            }
        }
    }

    /// A straight piece of the wall without what lies in a gap.
    fn around_gaps(&mut self, [a, b]: [[f64; 2]; 2], gaps: &[Option<[f64; 2]>; 4], density: f64) {
        const STEPS: usize = 8;
        let at = |s: usize| {
            let s = s as f64 / STEPS as f64;
            [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
        };
        for step in 0..STEPS {
            let (p, q) = (at(step), at(step + 1));
            let middle = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
            let open = gaps.iter().enumerate().any(|(side, gap)| {
                let along = middle[side % 2];
                let across = middle[1 - side % 2] - 0.5 * self.size[1 - side % 2];
                let far = side == 1 || side == 2;
                gap.is_some_and(|[from, to]| along > from && along < to) && far == (across > 0.0)
            });
            if !open {
                self.panel([p, q], [0.0, super::plan::CEILING], density);
            }
        }
    }

    fn at_angle(&self, angle: f64) -> [f64; 2] {
        let power = |x: f64| x.signum() * x.abs().powf(2.0 / self.exponent);
        let (sin, cos) = angle.sin_cos();
        [
            0.5 * self.size[0] * (1.0 + power(cos)),
            0.5 * self.size[1] * (1.0 + power(sin)),
        ]
    }

    /// The point of the wall at this place along a side of the rectangle around it.
    fn on_curve(&self, side: usize, along: f64) -> [f64; 2] {
        let [half, across] = [side % 2, 1 - side % 2].map(|axis| 0.5 * self.size[axis]);
        let share = 1.0 - ((along - half).abs() / half).powf(self.exponent);
        self.on_side(
            side,
            along,
            across * (share.powf(1.0 / self.exponent) - 1.0),
        )
    }

    fn place_inside(&self, rng: &mut Pcg64) -> [f64; 2] {
        loop {
            let at: [f64; 2] = std::array::from_fn(|i| rng.random_range(0.0..self.size[i]));
            let share = |i: usize| {
                let half = 0.5 * self.size[i];
                ((at[i] - half).abs() / (half - 0.7)).powf(self.exponent)
            };
            if share(0) + share(1) < 1.0 {
                return at;
            }
        }
    }
}
