//! The homography between two views of a plane (or of anything, under pure rotation).

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// H with x₂ ∝ H x₁ from four or more pairs of rays with z = 1, by normalised least squares (h₃₃ fixed in
/// normalised coordinates); `None` for fewer than four pairs, slices of different length, and points that leave it open, as four of
/// which three are collinear.
#[must_use]
pub fn homography_from_points(
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
) -> Option<Matrix3<f64>> {
    if first.len() < 4 || first.len() != second.len() {
        return None;
    }
    let (a, b) = (normaliser(first)?, normaliser(second)?);
    let mut normal = SMatrix::<f64, 8, 8>::zeros();
    let mut right = SVector::<f64, 8>::zeros();
    for (p, q) in first.iter().zip(second) {
        let (p, q) = (a * p, b * q);
        let u = SVector::<f64, 8>::from([p.x, p.y, 1.0, 0.0, 0.0, 0.0, -q.x * p.x, -q.x * p.y]);
        let v = SVector::<f64, 8>::from([0.0, 0.0, 0.0, p.x, p.y, 1.0, -q.y * p.x, -q.y * p.y]);
        normal += u * u.transpose() + v * v.transpose();
        right += u * q.x + v * q.y;
    }
    let factor = normal.cholesky()?;
    // What rounding leaves of a singular system has a pivot of about 1e-8.
    let pivots = factor.l_dirty().diagonal();
    if !(pivots.min() > 1e-6 * pivots.max()) {
        return None;
    }
    let h = factor.solve(&right);
    let matrix = Matrix3::new(h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1.0);
    let homography = b.try_inverse()? * matrix * a;
    let determinant = (homography / homography.norm()).determinant();
    (determinant.abs() > 1e-9).then_some(homography)
}

/// Moves the centroid to the origin and the mean distance to √2 (Hartley 1997).
fn normaliser(points: &[Vector3<f64>]) -> Option<Matrix3<f64>> {
    #[expect(clippy::cast_precision_loss, reason = "counts of matches are small")]
    let n = points.len() as f64;
    let centre = points.iter().sum::<Vector3<f64>>() / n;
    let spread = points.iter().map(|p| (p - centre).norm()).sum::<f64>() / n;
    if !(spread > 1e-12 && spread.is_finite()) {
        return None;
    }
    let s = core::f64::consts::SQRT_2 / spread;
    Some(Matrix3::new(
        s,
        0.0,
        -s * centre.x,
        0.0,
        s,
        -s * centre.y,
        0.0,
        0.0,
        1.0,
    ))
}

/// Squared transfer distance of x₁ to x₂ on the plane z = 1; infinite behind the camera.
pub(super) fn transfer(
    homography: &Matrix3<f64>,
    first: &Vector3<f64>,
    second: &Vector3<f64>,
) -> f64 {
    let moved = homography * first;
    if !(moved.z.abs() > 1e-12) {
        return f64::INFINITY;
    }
    (moved.x / moved.z - second.x).powi(2) + (moved.y / moved.z - second.y).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn exact_points_give_the_homography(
            h in prop::array::uniform9(-0.2..0.2f64),
            points in prop::collection::vec(prop::array::uniform2(-1.0..1.0f64), 8..20),
        ) {
            let truth = Matrix3::from_row_slice(&h) + Matrix3::identity();
            let first: Vec<_> = points.iter().map(|p| Vector3::new(p[0], p[1], 1.0)).collect();
            let second: Vec<_> = first.iter().map(|p| { let q = truth * p; q / q.z }).collect();
            let found = homography_from_points(&first, &second).unwrap();
            for (p, q) in first.iter().zip(&second) {
                prop_assert!(transfer(&found, p, q).sqrt() < 1e-5);
            }
        }
    }

    #[test]
    fn collinear_points_are_refused() {
        let line: Vec<_> = (0..6)
            .map(|k| Vector3::new(f64::from(k), 2.0, 1.0))
            .collect();
        assert!(homography_from_points(&line, &line).is_none());
        assert!(homography_from_points(&line[..3], &line[..3]).is_none());
        assert!(homography_from_points(&[Vector3::z(); 4], &[Vector3::z(); 4]).is_none());
    }
}
