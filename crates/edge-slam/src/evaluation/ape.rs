//! Absolute pose error (absolute trajectory error, ATE): distance to the reference after one alignment.
//!
//! ```text
//! Eᵢ = Qᵢ⁻¹ (S Pᵢ)    Q reference, P estimate, S the alignment
//! translation  ‖trans(Eᵢ)‖ (evo: ‖trans(S Pᵢ) − trans(Qᵢ)‖, the same number)
//! rotation     angle of rot(Eᵢ)
//! frobenius    ‖Eᵢ − I‖_F on 4x4 matrices: the paper's "ATE", which mixes metres and rotation
//! ```

use nalgebra::{Isometry3, Matrix4};

use super::{
    AlignBy, Alignment, ErrorStatistics, EvaluationError, Similarity, TimedPose, align_points,
    align_poses, associate,
};

/// How the absolute error is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ApeConfig {
    /// Freedom of the alignment; monocular estimates need [`Alignment::Sim3`].
    pub alignment: Alignment,
    /// What fixes the alignment's rotation. Default: positions, as in published figures.
    pub align_by: AlignBy,
    /// Greatest difference of two stamps that count as simultaneous, seconds, >= 0. `evo`: 0.01; TUM tools: 0.02.
    pub max_difference: f64,
}

impl Default for ApeConfig {
    fn default() -> Self {
        Self {
            alignment: Alignment::Sim3,
            align_by: AlignBy::default(),
            max_difference: 0.01,
        }
    }
}

/// The absolute error of a trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct AbsolutePoseError {
    /// Translation part, the reference's unit. Its `rmse` is what is published as ATE.
    pub translation: ErrorStatistics,
    /// Rotation part, radians.
    pub rotation: ErrorStatistics,
    /// The Frobenius norm of Eᵢ − I, no unit.
    pub frobenius: ErrorStatistics,
    /// The alignment that was applied to the estimate.
    pub alignment: Similarity,
    /// Which samples were compared: (estimate, reference).
    pub pairs: Vec<(usize, usize)>,
    /// Translation error of each pair, in the order of `pairs`.
    pub errors: Vec<f64>,
}

/// Associates, aligns and compares two trajectories.
///
/// # Errors
/// [`EvaluationError`]: no pair, values that are not finite, or an alignment that is not unique.
///
/// ```
/// use edge_slam::evaluation::{ApeConfig, TimedPose, absolute_pose_error};
/// use edge_slam::nalgebra::Isometry3;
/// let truth: Vec<_> = (0..9)
///     .map(|i| {
///         let s = f64::from(i) * 0.3;
///         TimedPose { time: s, pose: Isometry3::translation(s.sin(), s.cos(), s) }
///     })
///     .collect();
/// let mut half = truth.clone();
/// for sample in &mut half {
///     sample.pose.translation.vector *= 0.5;
/// }
/// let ape = absolute_pose_error(&half, &truth, &ApeConfig::default())?;
/// assert!(ape.translation.rmse < 1e-9);
/// assert!((ape.alignment.scale - 2.0).abs() < 1e-9);
/// # Ok::<(), edge_slam::evaluation::EvaluationError>(())
/// ```
pub fn absolute_pose_error(
    estimate: &[TimedPose],
    reference: &[TimedPose],
    config: &ApeConfig,
) -> Result<AbsolutePoseError, EvaluationError> {
    let pairs = associate(estimate, reference, config.max_difference)?;
    let alignment = align(estimate, reference, &pairs, config)?;
    let mut errors = Vec::with_capacity(pairs.len());
    let mut angles = Vec::with_capacity(pairs.len());
    let mut norms = Vec::with_capacity(pairs.len());
    for &(i, j) in &pairs {
        let moved = alignment.apply_to_pose(&estimate[i].pose);
        let error = reference[j].pose.inv_mul(&moved);
        errors.push(error.translation.vector.norm());
        angles.push(error.rotation.angle());
        norms.push((error.to_homogeneous() - Matrix4::identity()).norm());
    }
    let none = EvaluationError::TooFewPairs {
        pairs: pairs.len(),
        needed: 1,
    };
    Ok(AbsolutePoseError {
        translation: ErrorStatistics::of(&errors).ok_or(none)?,
        rotation: ErrorStatistics::of(&angles).ok_or(none)?,
        frobenius: ErrorStatistics::of(&norms).ok_or(none)?,
        alignment,
        pairs,
        errors,
    })
}

fn align(
    estimate: &[TimedPose],
    reference: &[TimedPose],
    pairs: &[(usize, usize)],
    config: &ApeConfig,
) -> Result<Similarity, EvaluationError> {
    let paired = pairs
        .iter()
        .map(|&(i, j)| (estimate[i].pose, reference[j].pose));
    let (source, target): (Vec<_>, Vec<_>) = paired.unzip();
    match config.align_by {
        AlignBy::Positions => {
            let [source, target] =
                [&source, &target].map(|poses| poses.iter().map(position).collect::<Vec<_>>());
            align_points(&source, &target, config.alignment)
        }
        AlignBy::Poses => align_poses(&source, &target, config.alignment),
    }
}

fn position(pose: &Isometry3<f64>) -> [f64; 3] {
    pose.translation.vector.into()
}
