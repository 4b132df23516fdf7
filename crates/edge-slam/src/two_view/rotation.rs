//! The pure rotation that best explains matched rays.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::evaluation::rotation_between;

/// The rotation R with second ≈ R first (directions), least squares over unit rays.
///
/// `None` for fewer than two rays, rays that are not finite, or all rays on one line.
#[must_use]
pub fn fit_rotation(
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
) -> Option<UnitQuaternion<f64>> {
    let mut covariance = Matrix3::zeros();
    for (a, b) in first.iter().zip(second) {
        covariance += b.try_normalize(0.0)? * a.try_normalize(0.0)?.transpose();
    }
    let finite = covariance.iter().all(|value| value.is_finite());
    if finite {
        rotation_between(&covariance).ok()
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_rays_fix_a_rotation() {
        let truth = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.2, 0.5));
        let first = [Vector3::new(0.3, 0.1, 1.0), Vector3::new(-0.4, 0.2, 1.0)];
        let second = first.map(|ray| truth * ray * 2.0);
        assert!(fit_rotation(&first, &second).unwrap().angle_to(&truth) < 1e-7);
        assert!(fit_rotation(&first[..1], &second[..1]).is_none());
        assert!(fit_rotation(&[], &[]).is_none());
    }
}
