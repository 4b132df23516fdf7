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
    fit_weighted(first, second, |_, _| 1.0)
}

/// The rotation that leaves the least sum of distances (not of squares) between unit rays: a minority that parallax has
/// moved far does not pull it.
///
/// Ten rounds of reweighted least squares (Weiszfeld). `None` as for [`fit_rotation`].
pub(super) fn fit_rotation_robustly(
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
) -> Option<UnitQuaternion<f64>> {
    let mut rotation = fit_rotation(first, second)?;
    for _ in 0..10 {
        // A twentieth of a pixel of a usual camera: below, all matches count the same.
        let weight =
            |a: &Vector3<f64>, b: &Vector3<f64>| (rotation * a - b).norm().max(1e-4).recip();
        rotation = fit_weighted(first, second, weight)?;
    }
    Some(rotation)
}

fn fit_weighted(
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
    weight: impl Fn(&Vector3<f64>, &Vector3<f64>) -> f64,
) -> Option<UnitQuaternion<f64>> {
    let mut covariance = Matrix3::zeros();
    for (a, b) in first.iter().zip(second) {
        let (a, b) = (a.try_normalize(0.0)?, b.try_normalize(0.0)?);
        covariance += b * a.transpose() * weight(&a, &b);
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
    #[test]
    fn a_minority_does_not_pull_the_robust_rotation() {
        let truth = UnitQuaternion::from_scaled_axis(Vector3::new(0.1, -0.2, 0.05));
        let first: Vec<_> = (0..60)
            .map(|k| {
                let k = f64::from(k);
                Vector3::new((k * 1.7).sin() * 0.5, (k * 0.9).cos() * 0.4, 1.0)
            })
            .collect();
        let near = |(k, ray): (usize, &Vector3<f64>)| {
            let turned = truth * ray;
            let shift = if k % 3 == 0 { 0.05 } else { 0.0 };
            turned / turned.z + Vector3::new(shift, 0.0, 0.0)
        };
        let second: Vec<_> = first.iter().enumerate().map(near).collect();
        let robust = fit_rotation_robustly(&first, &second).unwrap();
        let squares = fit_rotation(&first, &second).unwrap();
        assert!(
            robust.angle_to(&truth) < 5e-4,
            "{}",
            robust.angle_to(&truth)
        );
        assert!(squares.angle_to(&truth) > 5e-3);
        assert!(fit_rotation_robustly(&[], &[]).is_none());
    }
}
