//! Analytic rooms: dense straight walls with gaps, and what is seen through the gaps.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "shared by tests and examples, each uses its part"
)]

use std::f64::consts::TAU;

/// Wall segments in plan.
#[derive(Debug, Clone, Default)]
pub struct Walls(pub Vec<[[f64; 2]; 2]>);

impl Walls {
    pub fn wall(mut self, a: [f64; 2], b: [f64; 2]) -> Self {
        self.0.push([a, b]);
        self
    }

    /// A straight wall with a gap from `from` to `to`, measured from `a`.
    pub fn wall_with_gap(self, a: [f64; 2], b: [f64; 2], [from, to]: [f64; 2]) -> Self {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let at = |s: f64| {
            [
                a[0] + (b[0] - a[0]) * s / length,
                a[1] + (b[1] - a[1]) * s / length,
            ]
        };
        self.wall(a, at(from)).wall(at(to), b)
    }

    /// What a lidar-like eye sees: `rays` per turn, five heights each, up to `reach`.
    pub fn seen_from(&self, eye: [f64; 2], rays: u32, reach: f64) -> Vec<[f64; 3]> {
        let mut points = Vec::new();
        for ray in 0..rays {
            let bearing = (f64::from(ray) + 0.5) * TAU / f64::from(rays);
            let d = [bearing.cos(), bearing.sin()];
            let hit = self
                .0
                .iter()
                .filter_map(|wall| meet(eye, d, wall))
                .fold(reach, f64::min);
            if hit < reach {
                for level in -2..=2 {
                    let z = 1.0 + 0.1 * f64::from(level);
                    points.push([eye[0] + hit * d[0], eye[1] + hit * d[1], z]);
                }
            }
        }
        points
    }

    /// Whether a motion stays on one side of every wall.
    pub fn is_free(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        let d = [b[0] - a[0], b[1] - a[1]];
        !self
            .0
            .iter()
            .any(|wall| meet(a, d, wall).is_some_and(|s| s < 1.0))
    }
}

/// Distance along a ray to a wall, in lengths of `d`.
fn meet(eye: [f64; 2], d: [f64; 2], [a, b]: &[[f64; 2]; 2]) -> Option<f64> {
    let e = [b[0] - a[0], b[1] - a[1]];
    let cross = d[0] * e[1] - d[1] * e[0];
    let w = [a[0] - eye[0], a[1] - eye[1]];
    let s = (w[0] * e[1] - w[1] * e[0]) / cross;
    let t = (w[0] * d[1] - w[1] * d[0]) / cross;
    (s > 1e-9 && (-1e-9..=1.0 + 1e-9).contains(&t)).then_some(s)
}

/// The four sides of a rectangle, each with an optional gap, counter-clockwise from the low side.
pub fn room(low: [f64; 2], high: [f64; 2], gaps: [Option<[f64; 2]>; 4]) -> Walls {
    let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
    (0..4).fold(Walls::default(), |walls, i| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        match gaps[i] {
            Some(gap) => walls.wall_with_gap(a, b, gap),
            None => walls.wall(a, b),
        }
    })
}
