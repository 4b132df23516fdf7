//! Principal axes of a point set by cyclic Jacobi rotations, and the extents along them.

use crate::vector::{Vec3, add, cross, dot, orthogonal, scale, sub, unit};

/// An orthonormal right-handed frame with the range of the points along each axis, widest first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    pub(super) origin: Vec3,
    pub(super) directions: [Vec3; 3],
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

impl Axes {
    /// `points` must not be empty.
    pub(super) fn of(points: &[Vec3]) -> Self {
        let origin = mean(points);
        let directions = right_handed(eigenvectors(covariance(points, origin)));
        let mut axes = Axes {
            origin,
            directions,
            low: [0.0; 3],
            high: [0.0; 3],
        };
        axes.measure(points);
        axes.sort();
        axes
    }

    pub(super) fn extent(&self) -> Vec3 {
        sub(self.high, self.low)
    }

    /// Coordinates of a point in this frame.
    pub(super) fn local(&self, point: Vec3) -> Vec3 {
        let offset = sub(point, self.origin);
        self.directions.map(|direction| dot(offset, direction))
    }

    /// The point with these coordinates in this frame.
    pub(super) fn global(&self, local: Vec3) -> Vec3 {
        let [x, y, z] = self.directions;
        add(
            self.origin,
            add(
                scale(x, local[0]),
                add(scale(y, local[1]), scale(z, local[2])),
            ),
        )
    }

    fn measure(&mut self, points: &[Vec3]) {
        (self.low, self.high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &point in points {
            let local = self.local(point);
            self.low = crate::vector::min(self.low, local);
            self.high = crate::vector::max(self.high, local);
        }
    }

    /// Widest first; flips the last axis if the order turned the frame left-handed.
    fn sort(&mut self) {
        let extent = self.extent();
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
        let [x, y, z] = order.map(|axis| self.directions[axis]);
        let [low, high] = [self.low, self.high].map(|bound| order.map(|axis| bound[axis]));
        let odd = dot(cross(x, y), z) < 0.0;
        self.directions = [x, y, if odd { scale(z, -1.0) } else { z }];
        (self.low, self.high) = (low, high);
        if odd {
            (self.low[2], self.high[2]) = (-high[2], -low[2]);
        }
    }
}

/// The first principal axis and the extent along it. `points` must not be empty.
pub(crate) fn longest_axis(points: &[Vec3]) -> (Vec3, f64) {
    let axes = Axes::of(points);
    (axes.directions[0], axes.extent()[0])
}

fn mean(points: &[Vec3]) -> Vec3 {
    // Relative to the first point, so that a far origin costs no digits.
    let first = points[0];
    let sum = points
        .iter()
        .fold([0.0; 3], |sum, &point| add(sum, sub(point, first)));
    add(first, scale(sum, 1.0 / points.len() as f64))
}

fn covariance(points: &[Vec3], origin: Vec3) -> [Vec3; 3] {
    let mut matrix = [[0.0; 3]; 3];
    for &point in points {
        let offset = sub(point, origin);
        for row in 0..3 {
            for column in 0..3 {
                matrix[row][column] += offset[row] * offset[column];
            }
        }
    }
    matrix
}

/// Orthonormal eigenvectors of a symmetric matrix. Eight sweeps reach machine precision in 3 x 3.
fn eigenvectors(mut matrix: [Vec3; 3]) -> [Vec3; 3] {
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..8 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = matrix[p][q];
            if off.abs() <= 1e-18 * (matrix[p][p].abs() + matrix[q][q].abs()) {
                continue;
            }
            let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * off);
            let sign = if theta < 0.0 { -1.0 } else { 1.0 };
            let tangent = sign / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            rotate(
                &mut matrix,
                &mut vectors,
                (p, q),
                (cosine, tangent * cosine),
            );
        }
    }
    vectors
}

/// One Jacobi rotation in the plane (p, q). `vectors` holds one eigenvector per row.
fn rotate(
    matrix: &mut [Vec3; 3],
    vectors: &mut [Vec3; 3],
    (p, q): (usize, usize),
    (cosine, sine): (f64, f64),
) {
    for row in matrix.iter_mut() {
        (row[p], row[q]) = (
            cosine * row[p] - sine * row[q],
            sine * row[p] + cosine * row[q],
        );
    }
    for k in 0..3 {
        let (a, b) = (matrix[p][k], matrix[q][k]);
        (matrix[p][k], matrix[q][k]) = (cosine * a - sine * b, sine * a + cosine * b);
        let (a, b) = (vectors[p][k], vectors[q][k]);
        (vectors[p][k], vectors[q][k]) = (cosine * a - sine * b, sine * a + cosine * b);
    }
}

/// Removes what rounding left of skew.
fn right_handed([x, y, _]: [Vec3; 3]) -> [Vec3; 3] {
    let x = unit(x).unwrap_or([1.0, 0.0, 0.0]);
    let y = unit(sub(y, scale(x, dot(x, y)))).unwrap_or_else(|| orthogonal(x));
    [x, y, cross(x, y)]
}
