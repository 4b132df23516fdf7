//! The convex outline of the points of a plane, seen along the axis that the plane faces.

/// Corners counter-clockwise; a parallel projection keeps what is inside.
pub(super) struct Outline {
    axes: [usize; 2],
    corners: Vec<[f64; 2]>,
}

impl Outline {
    /// Of points seen along `axis` (Andrew's monotone chain, Information Processing Letters 1979). O(n log n).
    pub(super) fn new(axis: usize, points: impl Iterator<Item = [f64; 3]>) -> Self {
        let axes = [(axis + 1) % 3, (axis + 2) % 3];
        let mut flat: Vec<[f64; 2]> = points.map(|p| axes.map(|axis| p[axis])).collect();
        flat.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let mut corners = half(flat.iter().copied());
        corners.extend(half(flat.into_iter().rev()));
        Self { axes, corners }
    }

    /// Whether a point lies inside or on the border, seen along the axis.
    pub(super) fn contains(&self, point: [f64; 3]) -> bool {
        let at = self.axes.map(|axis| point[axis]);
        let next = self.corners.iter().cycle().skip(1);
        let mut sides = self.corners.iter().zip(next);
        self.corners.len() > 2 && sides.all(|(&a, &b)| turn(a, b, at) >= 0.0)
    }
}

/// The lower half of the hull of points from left to right, without its last corner.
fn half(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut chain: Vec<[f64; 2]> = Vec::new();
    for point in points {
        while let [.., a, b] = chain[..] {
            if turn(a, b, point) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(point);
    }
    chain.pop();
    chain
}

/// Above 0 if the way over a and b to c turns left.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_with_points_inside_has_four_corners() {
        let points = (0..25).map(|i| [7.0, f64::from(i % 5), f64::from(i / 5)]);
        let outline = Outline::new(0, points);
        assert_eq!(outline.corners.len(), 4);
        for inside in [[0.0, 2.0, 2.0], [9.0, 0.0, 4.0], [0.0, 1.0, 0.0]] {
            assert!(outline.contains(inside), "{inside:?}");
        }
        for outside in [[0.0, -0.1, 2.0], [0.0, 4.1, 4.0], [0.0, 2.0, 9.0]] {
            assert!(!outline.contains(outside), "{outside:?}");
        }
    }

    #[test]
    fn points_on_a_line_and_few_points_enclose_nothing() {
        for count in [0, 1, 2, 9] {
            let line = (0..count).map(|i| [f64::from(i), f64::from(i), 0.0]);
            assert!(!Outline::new(2, line).contains([0.5, 0.5, 0.0]), "{count}");
        }
    }
}
