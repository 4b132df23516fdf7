//! An axis-aligned solid box, with exact distance and ray queries.

/// A solid axis-aligned box, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Lowest corner.
    pub min: [f64; 3],
    /// Highest corner; not below `min` in any axis.
    pub max: [f64; 3],
    /// What the box stands for.
    pub kind: SolidKind,
}

/// What a [`Solid`] stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SolidKind {
    /// The floor slab, its top at z = 0.
    Floor,
    /// The ceiling slab.
    Ceiling,
    /// A piece of wall of full height.
    Wall,
    /// The piece of wall above a door.
    Lintel,
    /// Anything that stands or hangs in a room.
    Furniture,
}

impl Solid {
    /// Whether the point is inside or on the surface.
    #[must_use]
    pub fn contains(&self, point: [f64; 3]) -> bool {
        (0..3).all(|axis| self.min[axis] <= point[axis] && point[axis] <= self.max[axis])
    }

    /// Euclidean distance to the box, zero inside, metres.
    #[must_use]
    pub fn distance(&self, point: [f64; 3]) -> f64 {
        self.squared_distance(point).sqrt()
    }

    fn squared_distance(&self, point: [f64; 3]) -> f64 {
        (0..3)
            .map(|axis| {
                let outside = (self.min[axis] - point[axis])
                    .max(point[axis] - self.max[axis])
                    .max(0.0);
                outside * outside
            })
            .sum()
    }

    /// Share t of the way from `start` to `end` where the segment enters the box; `None` when it misses. A start inside
    /// the box gives 0.
    #[must_use]
    pub fn enter(&self, start: [f64; 3], end: [f64; 3]) -> Option<f64> {
        let mut low = 0.0_f64;
        let mut high = 1.0_f64;
        for axis in 0..3 {
            let delta = end[axis] - start[axis];
            if delta == 0.0 {
                if start[axis] < self.min[axis] || start[axis] > self.max[axis] {
                    return None;
                }
                continue;
            }
            let inverse = 1.0 / delta;
            let a = (self.min[axis] - start[axis]) * inverse;
            let b = (self.max[axis] - start[axis]) * inverse;
            low = low.max(a.min(b));
            high = high.min(a.max(b));
            if low > high {
                return None;
            }
        }
        Some(low)
    }

    /// Exact distance between the segment and the box, metres: the squared distance is convex and piecewise quadratic
    /// along the segment, so its minimum lies at a knot or at a stationary point between two knots.
    #[must_use]
    pub fn segment_distance(&self, start: [f64; 3], end: [f64; 3]) -> f64 {
        let knots = self.knots(start, end);
        let at = |t: f64| self.squared_distance(along(start, end, t));
        let mut best = f64::INFINITY;
        for pair in knots.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let (fa, fm, fb) = (at(a), at(0.5 * (a + b)), at(b));
            best = best.min(fa).min(fb);
            let curvature = fa - 2.0 * fm + fb;
            if curvature > 0.0 && b > a {
                let t = a + (b - a) * (0.5 + 0.25 * (fa - fb) / curvature).clamp(0.0, 1.0);
                best = best.min(at(t));
            }
        }
        best.max(0.0).sqrt()
    }

    /// Where along the segment a coordinate passes a face plane, with both ends, ascending.
    fn knots(&self, start: [f64; 3], end: [f64; 3]) -> [f64; 8] {
        let mut knots = [0.0; 8];
        knots[7] = 1.0;
        for axis in 0..3 {
            let delta = end[axis] - start[axis];
            for (side, bound) in [self.min[axis], self.max[axis]].into_iter().enumerate() {
                let t = if delta == 0.0 {
                    0.0
                } else {
                    (bound - start[axis]) / delta
                };
                knots[1 + 2 * axis + side] = t.clamp(0.0, 1.0);
            }
        }
        knots.sort_unstable_by(f64::total_cmp);
        knots
    }
}

/// The point at share `t` of the way from `start` to `end`.
pub(crate) fn along(start: [f64; 3], end: [f64; 3], t: f64) -> [f64; 3] {
    core::array::from_fn(|axis| start[axis] + t * (end[axis] - start[axis]))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Solid, SolidKind, along};

    const BOX: Solid = Solid {
        min: [0.0, 0.0, 0.0],
        max: [2.0, 1.0, 3.0],
        kind: SolidKind::Furniture,
    };

    fn point() -> impl Strategy<Value = [f64; 3]> {
        [-4.0..6.0_f64, -4.0..6.0_f64, -4.0..6.0_f64]
    }

    proptest! {
        #[test]
        fn segment_distance_equals_the_densely_sampled_minimum(a in point(), b in point()) {
            let exact = BOX.segment_distance(a, b);
            let sampled = (0..=4000)
                .map(|i| BOX.distance(along(a, b, f64::from(i) / 4000.0)))
                .fold(f64::INFINITY, f64::min);
            prop_assert!(exact <= sampled + 1e-9);
            prop_assert!(sampled - exact < 6e-3, "{exact} {sampled}");
        }

        #[test]
        fn a_ray_enters_exactly_when_the_distance_is_zero(a in point(), b in point()) {
            let hit = BOX.enter(a, b);
            let distance = BOX.segment_distance(a, b);
            match hit {
                Some(t) => prop_assert!(BOX.distance(along(a, b, t)) < 1e-9 && distance < 1e-6),
                None => prop_assert!(distance > 0.0),
            }
        }
    }

    #[test]
    fn a_zero_length_segment_is_a_point() {
        assert!((BOX.segment_distance([3.0, 0.5, 1.0], [3.0, 0.5, 1.0]) - 1.0).abs() < 1e-12);
        assert_eq!(BOX.enter([3.0, 0.5, 1.0], [3.0, 0.5, 1.0]), None);
        assert_eq!(BOX.enter([1.0, 0.5, 1.0], [1.0, 0.5, 1.0]), Some(0.0));
    }
}
