//! The rigid motion or similarity that best maps one set of poses onto another: the rotation from orientations alone.
//!
//! ```text
//! R   minimises   Σᵢ ‖ R(Qᵢ) − R R(Pᵢ) ‖²_F              Q target, P source (the chordal mean of Qᵢ Pᵢ⁻¹)
//! s, t minimise   Σᵢ ‖ trans(Qᵢ) − (s R trans(Pᵢ) + t) ‖²
//! ```
//!
//! Positions alone fix a rotation only as well as the camera travelled: an error of e metres over a path that spans L turns the
//! alignment by about e / L, and what was seen r metres away moves by r e / L. Orientations do not know of L. The
//! price is that both trajectories must be of the same body: a fixed rotation between, say, an IMU and a camera is taken
//! for a rotation of the world.

use nalgebra::{Isometry3, Matrix3, Vector3};

use super::align::{count_pairs, is_rounding, mean, rotation_between, usable};
use super::{Alignment, EvaluationError, Similarity};

/// The [`Similarity`] that takes `source` onto `target`: rotation from orientations, then scale and translation from positions.
///
/// Scale is 1 unless `alignment` is [`Alignment::Sim3`]. Unlike with [`align_points`](super::align_points), positions on one
/// line are fine, and for [`Alignment::Se3`] in one place as well. Cost: O(n).
///
/// # Errors
/// [`EvaluationError::LengthMismatch`], [`EvaluationError::NonFinite`], [`EvaluationError::TooFewPairs`] without a pair,
/// [`EvaluationError::Degenerate`] for orientations that cancel or a scale of positions in one place, [`EvaluationError::Scale`]
/// when the positions run against the orientations.
///
/// ```
/// use edge_slam::evaluation::{Alignment, align_poses};
/// use edge_slam::nalgebra::{Isometry3, Vector3};
/// let world = Isometry3::new(Vector3::new(4.0, 0.0, 1.0), Vector3::new(0.0, 0.3, 0.0));
/// // A straight line, along which positions leave the rotation open.
/// let source: Vec<_> = (0..5).map(|k| Isometry3::translation(f64::from(k), 0.0, 0.0)).collect();
/// let target: Vec<_> = source.iter().map(|pose| world * pose).collect();
/// let similarity = align_poses(&source, &target, Alignment::Se3)?;
/// assert!(similarity.motion.rotation.angle_to(&world.rotation) < 1e-7);
/// # Ok::<(), edge_slam::evaluation::EvaluationError>(())
/// ```
pub fn align_poses(
    source: &[Isometry3<f64>],
    target: &[Isometry3<f64>],
    alignment: Alignment,
) -> Result<Similarity, EvaluationError> {
    if count_pairs([source.len(), target.len()], 1, alignment)? == 0 {
        return Ok(Similarity::identity());
    }
    let (from, to) = (positions(source)?, positions(target)?);
    let mut agreement = Matrix3::zeros();
    for (p, q) in source.iter().zip(target) {
        let [p, q] = [p, q].map(|pose| *pose.rotation.to_rotation_matrix().matrix());
        agreement += q * p.transpose();
    }
    // One rotation has norm √3: what rounding leaves of rotations that cancel is no direction.
    #[expect(
        clippy::cast_precision_loss,
        reason = "counts of samples stay far below 2^53"
    )]
    let ratio = agreement.norm() / source.len() as f64;
    if !(ratio > 1e-9) {
        return Err(EvaluationError::Degenerate { ratio });
    }
    let rotation = rotation_between(&agreement)?;
    let turned: Vec<_> = from.iter().map(|position| rotation * position).collect();
    let scale = match alignment {
        Alignment::Sim3 => stretch(&turned, &to)?,
        Alignment::Se3 | Alignment::None => 1.0,
    };
    let translation = mean(&to) - mean(&turned) * scale;
    Ok(Similarity {
        motion: Isometry3::from_parts(translation.into(), rotation),
        scale,
    })
}

/// The factor by which `from` fits `to` best, once both are moved to their means.
fn stretch(from: &[Vector3<f64>], to: &[Vector3<f64>]) -> Result<f64, EvaluationError> {
    let (centre, goal) = (mean(from), mean(to));
    let (mut along, mut variance, mut goal_variance) = (0.0, 0.0, 0.0);
    for (x, y) in from.iter().zip(to) {
        along += (x - centre).dot(&(y - goal));
        variance += (x - centre).norm_squared();
        goal_variance += (y - goal).norm_squared();
    }
    if is_rounding(from, variance) || is_rounding(to, goal_variance) {
        return Err(EvaluationError::Degenerate { ratio: 0.0 });
    }
    let scale = along / variance;
    if scale > 0.0 {
        Ok(scale)
    } else {
        Err(EvaluationError::Scale { scale })
    }
}

fn positions(poses: &[Isometry3<f64>]) -> Result<Vec<Vector3<f64>>, EvaluationError> {
    let position = |(index, pose): (usize, &Isometry3<f64>)| {
        let is_turn = pose.rotation.coords.iter().all(|part| part.is_finite());
        if is_turn && usable(&pose.translation.vector) {
            Ok(pose.translation.vector)
        } else {
            Err(EvaluationError::NonFinite { index })
        }
    };
    poses.iter().enumerate().map(position).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    fn poses() -> impl Strategy<Value = Vec<Isometry3<f64>>> {
        let number = || prop::array::uniform3(-2.0..2.0f64);
        let pose = (number(), number()).prop_map(|(t, r)| Isometry3::new(t.into(), r.into()));
        prop::collection::vec(pose, 3..20)
    }

    proptest! {
        #[test]
        fn recovers_a_known_similarity(
            source in poses(), scale in 0.1..9.0f64,
            axis in prop::array::uniform3(-3.0..3.0f64), shift in prop::array::uniform3(-9.0..9.0f64),
        ) {
            let truth = Similarity { motion: Isometry3::new(shift.into(), axis.into()), scale };
            let target: Vec<_> = source.iter().map(|pose| truth.apply_to_pose(pose)).collect();
            let found = align_poses(&source, &target, Alignment::Sim3)?;
            prop_assert!((found.scale - scale).abs() < 1e-9 * scale);
            prop_assert!(found.motion.rotation.angle_to(&truth.motion.rotation) < 1e-7);
            prop_assert!((found.motion.translation.vector - Vector3::from(shift)).norm() < 1e-7);
        }

        #[test]
        fn no_nearby_rotation_agrees_better(
            source in poses(), target in poses(), nudge in prop::array::uniform3(-0.01..0.01f64),
        ) {
            let n = source.len().min(target.len());
            let (source, target) = (&source[..n], &target[..n]);
            let cost = |r: &UnitQuaternion<f64>| -> f64 {
                source.iter().zip(target).map(|(p, q)| {
                    let [moved, goal] = [r * p.rotation, q.rotation].map(UnitQuaternion::to_rotation_matrix);
                    (moved.matrix() - goal.matrix()).norm_squared()
                }).sum()
            };
            if let Ok(best) = align_poses(source, target, Alignment::Se3) {
                let best = best.motion.rotation;
                prop_assert!(cost(&best) <= cost(&(UnitQuaternion::new(nudge.into()) * best)) + 1e-9);
            }
        }
    }

    #[test]
    fn noise_of_positions_does_not_turn_it() {
        // Ten centimetres of travel, errors of two: what positions say of the rotation is worth little.
        let place = |k: u32| {
            let k = f64::from(k);
            Vector3::new(0.01 * k, 0.01 * (1.3 * k).sin(), 0.0)
        };
        let pose = |k: u32, off: f64| {
            let error = Vector3::new(0.0, off * f64::from(k) / 10.0, 0.0);
            Isometry3::new(
                place(k) + error,
                Vector3::new(0.0, 0.02 * f64::from(k), 0.0),
            )
        };
        let truth: Vec<_> = (0..11).map(|k| pose(k, 0.0)).collect();
        let found: Vec<_> = (0..11).map(|k| pose(k, 0.02)).collect();
        let by_poses = align_poses(&found, &truth, Alignment::Se3).unwrap();
        assert!(by_poses.motion.rotation.angle() < 1e-7);
        let points = |poses: &[Isometry3<f64>]| -> Vec<[f64; 3]> {
            let point = |pose: &Isometry3<f64>| pose.translation.vector.into();
            poses.iter().map(point).collect()
        };
        let by_positions =
            crate::evaluation::align_points(&points(&found), &points(&truth), Alignment::Se3);
        assert!(by_positions.unwrap().motion.rotation.angle() > 5_f64.to_radians());
    }

    #[test]
    fn what_is_left_open_is_refused() {
        let still = [Isometry3::translation(1.0, 2.0, 3.0); 4];
        let run = |a: &[Isometry3<f64>], b: &[Isometry3<f64>], freedom| align_poses(a, b, freedom);
        assert!(run(&still, &still, Alignment::Se3).is_ok());
        assert!(run(&still[..1], &still[..1], Alignment::Se3).is_ok());
        assert_eq!(
            run(&still, &still, Alignment::Sim3),
            Err(EvaluationError::Degenerate { ratio: 0.0 })
        );
        let rounded = [Isometry3::translation(0.1, 0.7, -0.3); 80];
        assert_eq!(
            run(&rounded, &rounded, Alignment::Sim3),
            Err(EvaluationError::Degenerate { ratio: 0.0 })
        );
        let mut path = rounded;
        for (k, pose) in (0_u8..).zip(&mut path) {
            pose.translation.vector.x += f64::from(k);
        }
        assert!(run(&path, &rounded, Alignment::Se3).is_ok());
        for (source, target) in [(&path, &rounded), (&rounded, &path)] {
            assert!(run(source, target, Alignment::Sim3).is_err());
        }
        assert!(run(&[], &[], Alignment::Se3).is_err());
        assert!(run(&[], &[], Alignment::None).is_ok());
        assert!(run(&still[..2], &still[..3], Alignment::Se3).is_err());
        let mut bad = still;
        bad[2].translation.vector.x = f64::NAN;
        assert_eq!(
            run(&bad, &still, Alignment::Se3),
            Err(EvaluationError::NonFinite { index: 2 })
        );
        // Finite numbers that are no rotation.
        let huge = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(1e200, 1e200, 0.0, 1.0));
        let mut wild = still;
        wild[1].rotation = huge;
        assert!(run(&wild, &still, Alignment::Se3).is_err());
        // Forwards by one, backwards by the other.
        let line = |sign: f64| [0.0, 1.0, 2.0].map(|x| Isometry3::translation(sign * x, 0.0, 0.0));
        assert!(matches!(
            run(&line(1.0), &line(-1.0), Alignment::Sim3),
            Err(EvaluationError::Scale { .. })
        ));
        // Half a turn about each axis and none: no mean.
        let turns = [Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z()];
        let spread = turns.map(|axis| Isometry3::rotation(axis * core::f64::consts::PI));
        assert!(matches!(
            run(&[Isometry3::identity(); 4], &spread, Alignment::Se3),
            Err(EvaluationError::Degenerate { .. })
        ));
    }
}
