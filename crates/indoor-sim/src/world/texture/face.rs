//! One side of a solid box, and pieces of it.

use crate::world::solid::Solid;

/// One side of a solid: its fixed axis and value, and the ranges of the two others.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub(super) solid: usize,
    pub(super) axis: usize,
    pub(super) outward: f64,
    value: f64,
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

impl Face {
    /// The side of `solid`, number `index`, whose normal points along `axis` in the direction `outward` (±1).
    pub(super) fn of(index: usize, solid: &Solid, axis: usize, outward: f64) -> Self {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        let value = if outward < 0.0 {
            solid.min[axis]
        } else {
            solid.max[axis]
        };
        Self {
            solid: index,
            axis,
            outward,
            value,
            low: [solid.min[u], solid.min[v]],
            high: [solid.max[u], solid.max[v]],
        }
    }

    /// The two axes in the face's plane.
    pub(super) fn axes(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// The point with these in-plane coordinates.
    pub(super) fn point(&self, uv: [f64; 2]) -> [f64; 3] {
        let mut point = [0.0; 3];
        let [u, v] = self.axes();
        point[self.axis] = self.value;
        point[u] = uv[0];
        point[v] = uv[1];
        point
    }

    pub(super) fn normal(&self) -> [f64; 3] {
        let mut normal = [0.0; 3];
        normal[self.axis] = self.outward;
        normal
    }

    /// Half a decimetre in front of the middle.
    pub(super) fn front(&self) -> [f64; 3] {
        let mut front = self.point([0, 1].map(|side| 0.5 * (self.low[side] + self.high[side])));
        front[self.axis] += 0.05 * self.outward;
        front
    }

    /// The part of the face with these ranges.
    pub(super) fn part(&self, low: [f64; 2], high: [f64; 2]) -> Self {
        Self { low, high, ..*self }
    }
}
