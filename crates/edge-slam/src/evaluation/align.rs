//! The rigid motion or similarity that best maps one point set onto another (Umeyama 1991).
//!
//! ```text
//! minimise over R, t, s   Σᵢ ‖ yᵢ − (s R xᵢ + t) ‖²
//! ```
//!
//! The rotation is the eigenvector of Horn's 4x4 matrix (Horn 1987), which gives the same minimum as
//! Umeyama's singular value decomposition, needs no special case for reflections and keeps full precision.

use nalgebra::{
    Isometry3, Matrix3, Matrix4, Point3, Quaternion, SymmetricEigen, UnitQuaternion, Vector3,
};

use super::EvaluationError;

/// Which freedom an alignment has. What fixes its rotation is [`AlignBy`]'s matter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Alignment {
    /// None: the two trajectories share a frame already.
    None,
    /// Rotation and translation, for metric estimates (`evo -a`).
    Se3,
    /// Rotation, translation and scale, for monocular estimates (`evo -as`).
    #[default]
    Sim3,
}

/// What fixes the rotation of an alignment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AlignBy {
    /// Positions, which fix it together with scale and translation ([`align_points`]). The default, because published trajectory
    /// errors are measured so.
    #[default]
    Positions,
    /// Orientations; then scale and translation by positions ([`align_poses`](super::align_poses)). For whatever hangs on the poses
    /// far from them, such as a map, and for paths that are straight or short against their error.
    Poses,
}

/// x -> s R x + t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// R and t.
    pub motion: Isometry3<f64>,
    /// s, positive.
    pub scale: f64,
}

impl Similarity {
    /// Changes nothing.
    #[must_use]
    pub fn identity() -> Self {
        Self {
            motion: Isometry3::identity(),
            scale: 1.0,
        }
    }

    /// s R x + t.
    #[must_use]
    pub fn apply(&self, point: &Point3<f64>) -> Point3<f64> {
        self.motion * Point3::from(point.coords * self.scale)
    }

    /// The pose whose position is moved and scaled and whose orientation is turned.
    #[must_use]
    pub fn apply_to_pose(&self, pose: &Isometry3<f64>) -> Isometry3<f64> {
        let mut scaled = *pose;
        scaled.translation.vector *= self.scale;
        self.motion * scaled
    }
}

/// The [`Similarity`] that takes `source` onto `target` with the least sum of squared distances.
///
/// Scale is 1 unless `alignment` is [`Alignment::Sim3`]. Points in a plane are fine; points on one line leave
/// the rotation undetermined and are an error. Cost: O(n).
///
/// # Errors
/// [`EvaluationError::LengthMismatch`], [`EvaluationError::NonFinite`], [`EvaluationError::TooFewPairs`]
/// under three points, [`EvaluationError::Degenerate`] for coincident or collinear points.
///
/// ```
/// use edge_slam::evaluation::{Alignment, align_points};
/// let source = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let target = [[5.0, 0.0, 0.0], [7.0, 0.0, 0.0], [5.0, 2.0, 0.0]];
/// let similarity = align_points(&source, &target, Alignment::Sim3)?;
/// assert!((similarity.scale - 2.0).abs() < 1e-12);
/// # Ok::<(), edge_slam::evaluation::EvaluationError>(())
/// ```
pub fn align_points<P: Copy + Into<[f64; 3]>>(
    source: &[P],
    target: &[P],
    alignment: Alignment,
) -> Result<Similarity, EvaluationError> {
    if count_pairs([source.len(), target.len()], 3, alignment)? == 0 {
        return Ok(Similarity::identity());
    }
    let (source, target) = (columns(source)?, columns(target)?);
    let (source_mean, target_mean) = (mean(&source), mean(&target));
    let mut covariance = Matrix3::zeros();
    let (mut variance, mut target_variance) = (0.0, 0.0);
    for (x, y) in source.iter().zip(&target) {
        covariance += (y - target_mean) * (x - source_mean).transpose();
        variance += (x - source_mean).norm_squared();
        target_variance += (y - target_mean).norm_squared();
    }
    for (points, variance) in [(&source, variance), (&target, target_variance)] {
        if is_rounding(points, variance) {
            return Err(EvaluationError::Degenerate { ratio: 0.0 });
        }
    }
    let rotation = rotation_between(&covariance)?;
    let scale = match alignment {
        Alignment::Sim3 => {
            rotation
                .to_rotation_matrix()
                .matrix()
                .component_mul(&covariance)
                .sum()
                / variance
        }
        Alignment::Se3 | Alignment::None => 1.0,
    };
    let translation = target_mean - rotation * source_mean * scale;
    Ok(Similarity {
        motion: Isometry3::from_parts(translation.into(), rotation),
        scale,
    })
}

/// Whether a sum of squared distances from the mean is no more than what rounding leaves of points in one place: their mean is not
/// exactly that place.
pub(super) fn is_rounding(points: &[Vector3<f64>], variance: f64) -> bool {
    let size: f64 = points.iter().map(Vector3::norm_squared).sum();
    !(variance > 1e-26 * size)
}

/// How many pairs there are to align, at least `needed`; 0 when there is nothing to align.
pub(super) fn count_pairs(
    [source_len, target_len]: [usize; 2],
    needed: usize,
    alignment: Alignment,
) -> Result<usize, EvaluationError> {
    if source_len != target_len {
        return Err(EvaluationError::LengthMismatch {
            source_len,
            target_len,
        });
    }
    match alignment {
        Alignment::None => Ok(0),
        Alignment::Se3 | Alignment::Sim3 if source_len >= needed => Ok(source_len),
        Alignment::Se3 | Alignment::Sim3 => Err(EvaluationError::TooFewPairs {
            pairs: source_len,
            needed,
        }),
    }
}

fn columns<P: Copy + Into<[f64; 3]>>(points: &[P]) -> Result<Vec<Vector3<f64>>, EvaluationError> {
    points
        .iter()
        .enumerate()
        .map(|(index, &point)| {
            let vector = Vector3::from(point.into());
            if usable(&vector) {
                Ok(vector)
            } else {
                Err(EvaluationError::NonFinite { index })
            }
        })
        .collect()
}

/// Finite, and small enough to be squared and summed.
pub(super) fn usable(position: &Vector3<f64>) -> bool {
    position.iter().all(|value| value.abs() < 1e100)
}

#[expect(
    clippy::cast_precision_loss,
    reason = "counts of samples stay far below 2^53"
)]
pub(super) fn mean(points: &[Vector3<f64>]) -> Vector3<f64> {
    points.iter().sum::<Vector3<f64>>() / points.len() as f64
}

/// The rotation that maximises tr(Rᵀ covariance): Horn 1987, the eigenvector of the greatest eigenvalue.
pub(crate) fn rotation_between(
    covariance: &Matrix3<f64>,
) -> Result<UnitQuaternion<f64>, EvaluationError> {
    let size = covariance.norm();
    // Eigenvalues of what is not finite are sought without end.
    if !(size > f64::MIN_POSITIVE && size.is_finite()) {
        return Err(EvaluationError::Degenerate { ratio: 0.0 });
    }
    let c = covariance / size;
    let (xx, xy, xz) = (c[(0, 0)], c[(1, 0)], c[(2, 0)]);
    let (yx, yy, yz) = (c[(0, 1)], c[(1, 1)], c[(2, 1)]);
    let (zx, zy, zz) = (c[(0, 2)], c[(1, 2)], c[(2, 2)]);
    #[rustfmt::skip]
    let horn = Matrix4::new(
        xx + yy + zz, yz - zy,       zx - xz,        xy - yx,
        yz - zy,      xx - yy - zz,  xy + yx,        zx + xz,
        zx - xz,      xy + yx,       yy - xx - zz,   yz + zy,
        xy - yx,      zx + xz,       yz + zy,        zz - xx - yy,
    );
    let eigen = SymmetricEigen::new(horn);
    let mut order = [0, 1, 2, 3];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    // λ₁ − λ₂ = 2 (σ₂ ± σ₃): no gap means that turning about one line costs nothing.
    let ratio = (eigen.eigenvalues[order[0]] - eigen.eigenvalues[order[1]]) / 2.0;
    if !(ratio > 1e-10) {
        return Err(EvaluationError::Degenerate { ratio });
    }
    let q = eigen.eigenvectors.column(order[0]);
    Ok(UnitQuaternion::from_quaternion(Quaternion::new(
        q[0], q[1], q[2], q[3],
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cloud() -> impl Strategy<Value = Vec<[f64; 3]>> {
        prop::collection::vec(prop::array::uniform3(-3.0..3.0f64), 6..30)
    }

    proptest! {
        #[test]
        fn recovers_a_known_similarity(
            points in cloud(),
            axis in prop::array::uniform3(-3.0..3.0f64),
            shift in prop::array::uniform3(-9.0..9.0f64),
            scale in 0.1..9.0f64,
        ) {
            let truth = Similarity {
                motion: Isometry3::new(shift.into(), axis.into()),
                scale,
            };
            let moved: Vec<[f64; 3]> =
                points.iter().map(|&p| truth.apply(&p.into()).into()).collect();
            let found = align_points(&points, &moved, Alignment::Sim3)?;
            prop_assert!((found.scale - scale).abs() < 1e-9 * scale);
            prop_assert!(found.motion.rotation.angle_to(&truth.motion.rotation) < 1e-7);
            prop_assert!((found.motion.translation.vector - Vector3::from(shift)).norm() < 1e-8);
        }

        #[test]
        fn no_nearby_motion_is_better(
            points in cloud(),
            other in cloud(),
            nudge in prop::array::uniform3(-0.01..0.01f64),
        ) {
            let n = points.len().min(other.len());
            let (points, other) = (&points[..n], &other[..n]);
            let cost = |s: &Similarity| -> f64 {
                points.iter().zip(other).map(|(&x, &y)| {
                    (s.apply(&x.into()) - Point3::from(y)).norm_squared()
                }).sum()
            };
            if let Ok(best) = align_points(points, other, Alignment::Sim3) {
                let mut near = best;
                near.motion.rotation = UnitQuaternion::new(nudge.into()) * near.motion.rotation;
                prop_assert!(cost(&best) <= cost(&near) + 1e-9);
                near = best;
                near.motion.translation.vector += Vector3::from(nudge);
                near.scale *= 1.0 + nudge[0];
                prop_assert!(cost(&best) <= cost(&near) + 1e-9);
            }
        }
    }

    #[test]
    fn planar_points_keep_a_proper_rotation() {
        let source = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [2.0, 1.0, 0.0],
        ];
        let mirrored = source.map(|[x, y, z]| [-x, y, z]);
        let found = align_points(&source, &mirrored, Alignment::Se3).unwrap();
        assert!(
            (found
                .motion
                .rotation
                .to_rotation_matrix()
                .matrix()
                .determinant()
                - 1.0)
                .abs()
                < 1e-12
        );
        assert!(
            (found.apply(&Point3::new(2.0, 1.0, 0.0)) - Point3::new(-2.0, 1.0, 0.0)).norm() < 1e-9
        );
    }

    #[test]
    fn lines_and_lumps_are_refused() {
        let line: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let lump = [[1.0, 2.0, 3.0]; 5];
        assert!(matches!(
            align_points(&line, &line, Alignment::Sim3),
            Err(EvaluationError::Degenerate { .. })
        ));
        assert!(matches!(
            align_points(&lump, &lump, Alignment::Se3),
            Err(EvaluationError::Degenerate { .. })
        ));
        assert!(align_points(&lump[..2], &lump[..2], Alignment::Se3).is_err());
        // The mean of these is not exactly 0.1: what rounding leaves is no shape.
        let still = [[0.1, 0.7, -0.3]; 80];
        let bent: Vec<[f64; 3]> = (0..80)
            .map(|i| [f64::from(i), f64::from(i * i % 7), f64::from(i % 5)])
            .collect();
        for alignment in [Alignment::Se3, Alignment::Sim3] {
            for (source, target) in [(&bent[..], &still[..]), (&still, &bent)] {
                let found = align_points(source, target, alignment);
                let is_refused = matches!(found, Err(EvaluationError::Degenerate { .. }));
                assert!(is_refused, "{found:?}");
            }
        }
        // Millimetres far from the origin are a shape.
        let far = |p: &[f64; 3]| [1e6 + 1e-3 * p[0], 5e6 + 1e-3 * p[1], 1e-3 * p[2]];
        let far: Vec<[f64; 3]> = bent.iter().map(far).collect();
        let found = align_points(&bent, &far, Alignment::Sim3).unwrap();
        assert!((found.scale / 1e-3 - 1.0).abs() < 1e-6, "{}", found.scale);
        assert!(align_points(&lump[..2], &lump[..3], Alignment::Se3).is_err());
        let bad = [[f64::INFINITY, 0.0, 0.0]; 4];
        assert!(align_points(&bad, &bad, Alignment::Se3).is_err());
        assert!(align_points(&line, &line, Alignment::None).is_ok());
    }
}
