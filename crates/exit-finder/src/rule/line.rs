//! Straight walls around an agent at the origin.
//!
//! A line that misses the origin is a x + b y = 1, so its inverse range is linear in the direction:
//! 1 / r(θ) = a cos θ + b sin θ.

/// A straight wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line {
    a: f64,
    b: f64,
}

impl Line {
    /// The line through two points in plan; `None` when they and the agent are in line.
    pub(crate) fn through(p: [f64; 2], q: [f64; 2]) -> Option<Self> {
        let area = p[0] * q[1] - p[1] * q[0];
        let squares = (p[0] * p[0] + p[1] * p[1]) * (q[0] * q[0] + q[1] * q[1]);
        (area * area > 1e-18 * squares).then(|| Self {
            a: (q[1] - p[1]) / area,
            b: (p[0] - q[0]) / area,
        })
    }

    /// The line whose inverse range in direction d is a·d₀ + b·d₁.
    pub(crate) fn with_inverse(a: f64, b: f64) -> Self {
        Self { a, b }
    }

    /// Inverse range in a direction; zero or less where the line is never met.
    pub(crate) fn inverse_range(&self, direction: [f64; 2]) -> f64 {
        self.a * direction[0] + self.b * direction[1]
    }

    /// Whether [`Line::distance`] is larger than `least`. Its square root is taken only where the squares are too close to tell.
    pub(crate) fn is_farther_than(&self, least: f64) -> bool {
        let ratio = (self.a * self.a + self.b * self.b) * (least * least);
        ratio < 0.99 || (ratio < 1.01 && self.distance() > least)
    }

    /// Distance from the agent.
    pub(crate) fn distance(&self) -> f64 {
        1.0 / self.a.hypot(self.b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_continues_along_itself() {
        let line = Line::through([-1.0, 2.0], [3.0, 2.0]).unwrap();
        for degrees in [10.0f64, 45.0, 90.0, 170.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            assert!((line.inverse_range([cos, sin]) - sin / 2.0).abs() < 1e-12);
        }
        assert!(line.inverse_range([0.0, -1.0]) < 0.0);
        assert!((line.distance() - 2.0).abs() < 1e-12);
        let least = [1.0, 1.995, 2.0 - 1e-9, 2.0 + 1e-9, 2.005, 4.0];
        let farther = least.map(|least| line.is_farther_than(least));
        assert_eq!(farther, [true, true, true, false, false, false]);
        assert_eq!(Line::through([1.0, 1.0], [2.0, 2.0]), None);
    }
}
