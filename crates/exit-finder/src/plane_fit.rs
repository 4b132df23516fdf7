//! The plane of many flown positions: singular value decomposition of the centred positions.

use nalgebra::DMatrix;

use crate::error::PlaneError;
use crate::plane::{AffinePlane, MIN_SPREAD_RATIO, direction, finite};
use crate::points::PointLike;
use crate::vector::{dot, scale};

/// Smallest |cos| between `up` and the fitted normal that still tells the two sides apart.
const MIN_UP_COSINE: f64 = 0.1;

/// A fitted plane with the quality of the fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneFit {
    /// The plane; its origin is the mean of the points.
    pub plane: AffinePlane,
    /// Root mean square distance of the points from the plane, map units.
    pub residual: f64,
    /// Singular values of the centred points, descending, divided by √n (map units).
    pub spread: [f64; 3],
}

impl AffinePlane {
    /// The least-squares plane of at least three positions, its normal on the side of `up`.
    ///
    /// The first axis is chosen as in [`AffinePlane::from_up`], so two fits of nearby planes have
    /// nearby coordinates. Cost: one SVD of an n × 3 matrix, O(n).
    ///
    /// # Errors
    /// [`PlaneError::TooFewPoints`], [`PlaneError::NonFinite`], [`PlaneError::Degenerate`] when
    /// σ₂/σ₁ < 0.05 (one point, duplicates, a line), [`PlaneError::UpInPlane`].
    pub fn from_points<P: PointLike>(points: &[P], up: [f64; 3]) -> Result<PlaneFit, PlaneError> {
        let up = direction(up, "up")?;
        let n = points.len();
        if n < 3 {
            return Err(PlaneError::TooFewPoints { count: n });
        }
        let mean = mean_of(points)?;
        let (spread, normal) = smallest_direction(points, mean)?;
        if spread[0] <= 0.0 || spread[1] < MIN_SPREAD_RATIO * spread[0] {
            return Err(PlaneError::Degenerate {
                spread,
                min_ratio: MIN_SPREAD_RATIO,
            });
        }
        let cosine = dot(normal, up);
        if cosine.abs() < MIN_UP_COSINE {
            return Err(PlaneError::UpInPlane { cosine });
        }
        let plane = AffinePlane::from_up(scale(normal, cosine.signum()), mean)?;
        Ok(PlaneFit {
            plane,
            residual: spread[2],
            spread,
        })
    }
}

fn mean_of<P: PointLike>(points: &[P]) -> Result<[f64; 3], PlaneError> {
    let mut mean = [0.0; 3];
    for &point in points {
        let p: [f64; 3] = point.into();
        finite(p, "point")?;
        for axis in 0..3 {
            mean[axis] += p[axis] / points.len() as f64;
        }
    }
    Ok(mean)
}

/// Root-mean-square spreads, descending, and the direction of the smallest.
fn smallest_direction<P: PointLike>(
    points: &[P],
    mean: [f64; 3],
) -> Result<([f64; 3], [f64; 3]), PlaneError> {
    let n = points.len();
    let mut rows = DMatrix::from_fn(n, 3, |row, axis| points[row].into()[axis] - mean[axis]);
    let extent = rows.amax();
    finite([extent; 3], "extent of the points")?;
    if extent > 0.0 {
        rows /= extent;
    }
    let svd = rows.svd(false, true);
    let Some(v_t) = svd.v_t else {
        return Err(PlaneError::Degenerate {
            spread: [0.0; 3],
            min_ratio: MIN_SPREAD_RATIO,
        });
    };
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| svd.singular_values[b].total_cmp(&svd.singular_values[a]));
    let spread = order.map(|i| svd.singular_values[i] * extent / (n as f64).sqrt());
    Ok((spread, [0, 1, 2].map(|axis| v_t[(order[2], axis)])))
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: [f64; 3] = [0.0, 0.0, 1.0];

    #[test]
    fn a_noisy_triangle_flight_gives_plane_and_residual() {
        let points: Vec<[f64; 3]> = (0..30)
            .map(|i| {
                let t = f64::from(i);
                [
                    t.sin(),
                    (1.3 * t).cos(),
                    0.2 * t.sin() + 0.01 * (7.0 * t).sin(),
                ]
            })
            .collect();
        let fit = AffinePlane::from_points(&points, UP).unwrap();
        let expected = crate::vector::unit([-0.2, 0.0, 1.0]).unwrap();
        assert!(dot(fit.plane.normal(), expected) > 0.9999);
        assert!(
            fit.residual > 1e-3 && fit.residual < 0.01,
            "{}",
            fit.residual
        );
    }

    #[test]
    fn degenerate_flights_are_named() {
        let same = [[1.0, 2.0, 3.0]; 5];
        assert!(matches!(
            AffinePlane::from_points(&same, UP),
            Err(PlaneError::Degenerate { .. })
        ));
        let two = [[0.0; 3], [1.0, 0.0, 0.0]];
        assert_eq!(
            AffinePlane::from_points(&two, UP).unwrap_err(),
            PlaneError::TooFewPoints { count: 2 }
        );
        let wall = [[0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0]];
        assert!(matches!(
            AffinePlane::from_points(&wall, UP),
            Err(PlaneError::UpInPlane { .. })
        ));
        let broken = [[0.0; 3], [f64::NAN, 0.0, 1.0], [1.0, 0.0, 0.0]];
        assert!(matches!(
            AffinePlane::from_points(&broken, UP),
            Err(PlaneError::NonFinite { .. })
        ));
        let huge = [[-1e308, 0.0, 0.0], [1e308, 0.0, 1.0], [1.7e308, 1.0, 0.0]];
        assert!(AffinePlane::from_points(&huge, UP).is_err());
    }
}
