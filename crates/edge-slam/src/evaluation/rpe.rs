//! Relative pose error: drift over a fixed interval, which no alignment can hide.
//!
//! ```text
//! Eᵢ = (Qᵢ⁻¹ Qⱼ)⁻¹ (Pᵢ⁻¹ Pⱼ)    j = i + Δ
//! ```

use super::{ErrorStatistics, EvaluationError, TimedPose, associate};

/// How far apart the two poses of a pair are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RpeInterval {
    /// So many associated samples, > 0 (`evo_rpe --delta_unit f`).
    Frames(usize),
    /// So many seconds, > 0: the sample nearest to that time after the first (TUM's tool), not more
    /// than [`RpeConfig::max_difference`] or half a 30 Hz frame away from it, whichever is greater.
    Seconds(f64),
}

/// How the relative error is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RpeConfig {
    /// Δ. Default: one frame, as `evo_rpe`.
    pub interval: RpeInterval,
    /// Whether every sample starts a pair, or only each Δ-th one (`evo_rpe` without `--all_pairs`).
    pub all_pairs: bool,
    /// Greatest difference of stamps that count as simultaneous, seconds, >= 0.
    pub max_difference: f64,
    /// Multiplies the estimate's translations first; 1 for metric estimates, the scale of a Sim(3) alignment else.
    pub scale: f64,
}

impl Default for RpeConfig {
    fn default() -> Self {
        Self {
            interval: RpeInterval::Frames(1),
            all_pairs: false,
            max_difference: 0.01,
            scale: 1.0,
        }
    }
}

/// The relative error of a trajectory, per interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativePoseError {
    /// Translation part, the reference's unit per interval.
    pub translation: ErrorStatistics,
    /// Rotation part, radians per interval.
    pub rotation: ErrorStatistics,
    /// How many pairs of poses were compared.
    pub pairs: usize,
}

/// Associates two trajectories and compares their motions over an interval.
///
/// Cost: O((n + m) log m); for [`RpeInterval::Seconds`] and pairs that are not in the order of time O(n²).
///
/// ```
/// use edge_slam::evaluation::{RpeConfig, RpeInterval, TimedPose, relative_pose_error};
/// use edge_slam::nalgebra::Isometry3;
/// // The estimate runs a tenth too fast.
/// let path = |speed: f64| -> Vec<TimedPose> {
///     let pose = |k| TimedPose { time: f64::from(k), pose: Isometry3::translation(speed * f64::from(k), 0.0, 0.0) };
///     (0..9).map(pose).collect()
/// };
/// let config = RpeConfig { interval: RpeInterval::Seconds(2.0), all_pairs: true, ..Default::default() };
/// let drift = relative_pose_error(&path(1.1), &path(1.0), &config)?;
/// assert!((drift.translation.rmse - 0.2).abs() < 1e-9 && drift.pairs == 7);
/// # Ok::<(), edge_slam::evaluation::EvaluationError>(())
/// ```
///
/// # Errors
/// [`EvaluationError`]: no pair, values that are not finite, or an interval that is not positive.
pub fn relative_pose_error(
    estimate: &[TimedPose],
    reference: &[TimedPose],
    config: &RpeConfig,
) -> Result<RelativePoseError, EvaluationError> {
    check(config)?;
    let matched = associate(estimate, reference, config.max_difference)?;
    let steps = match config.interval {
        RpeInterval::Frames(count) => frame_steps(matched.len(), count, config.all_pairs),
        RpeInterval::Seconds(seconds) => {
            let times: Vec<f64> = matched.iter().map(|&(i, _)| estimate[i].time).collect();
            second_steps(&times, seconds, config)
        }
    };
    let mut lengths = Vec::with_capacity(steps.len());
    let mut angles = Vec::with_capacity(steps.len());
    for &(from, to) in &steps {
        let (p, q) = (matched[from], matched[to]);
        let truth = reference[p.1].pose.inv_mul(&reference[q.1].pose);
        let mut step = estimate[p.0].pose.inv_mul(&estimate[q.0].pose);
        step.translation.vector *= config.scale;
        let error = truth.inv_mul(&step);
        lengths.push(error.translation.vector.norm());
        angles.push(error.rotation.angle());
    }
    let none = EvaluationError::TooFewPairs {
        pairs: steps.len(),
        needed: 1,
    };
    Ok(RelativePoseError {
        translation: ErrorStatistics::of(&lengths).ok_or(none)?,
        rotation: ErrorStatistics::of(&angles).ok_or(none)?,
        pairs: steps.len(),
    })
}

fn check(config: &RpeConfig) -> Result<(), EvaluationError> {
    let (value, good) = match config.interval {
        #[expect(clippy::cast_precision_loss, reason = "only shown in a message")]
        RpeInterval::Frames(count) => (count as f64, count > 0),
        RpeInterval::Seconds(seconds) => (seconds, seconds > 0.0 && seconds.is_finite()),
    };
    if !good {
        return Err(EvaluationError::Parameter {
            name: "interval",
            value,
            range: "positive",
        });
    }
    if !(config.scale > 0.0 && config.scale.is_finite()) {
        let value = config.scale;
        return Err(EvaluationError::Parameter {
            name: "scale",
            value,
            range: "positive",
        });
    }
    Ok(())
}

fn frame_steps(samples: usize, interval: usize, all_pairs: bool) -> Vec<(usize, usize)> {
    let stride = if all_pairs { 1 } else { interval };
    (0..samples.saturating_sub(interval))
        .step_by(stride)
        .map(|i| (i, i + interval))
        .collect()
}

fn second_steps(times: &[f64], seconds: f64, config: &RpeConfig) -> Vec<(usize, usize)> {
    let mut steps = Vec::new();
    let mut from = 0;
    let is_ordered = times.is_sorted();
    while from < times.len() {
        let wanted = times[from] + seconds;
        let gap = |to: &usize| (times[*to] - wanted).abs();
        let candidates = if is_ordered {
            around(times, from + 1, wanted)
        } else {
            from + 1..times.len()
        };
        let nearest = candidates.min_by(|a, b| gap(a).total_cmp(&gap(b)));
        let hit = nearest.filter(|to| gap(to) <= config.max_difference.max(0.5 * MEAN_FRAME));
        if let Some(to) = hit {
            steps.push((from, to));
        }
        from = match hit {
            Some(to) if !config.all_pairs => to,
            _ => from + 1,
        };
    }
    steps
}

/// From the first of the latest stamps before `wanted` to the first one at or after it: the nearest is among them. `times` ascend;
/// those before `start` are left out.
fn around(times: &[f64], start: usize, wanted: f64) -> core::ops::Range<usize> {
    let after = times.partition_point(|&time| time < wanted);
    let before = after
        .checked_sub(1)
        .map_or(0, |last| times.partition_point(|&time| time < times[last]));
    before.max(start)..(after + 1).max(start + 1).min(times.len())
}

/// A 30 Hz camera's frame time, seconds: no sample lies nearer than half of it to a wanted time in general.
const MEAN_FRAME: f64 = 1.0 / 30.0;

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Isometry3, Vector3};
    use proptest::prelude::*;

    fn straight(n: u32, speed: f64) -> Vec<TimedPose> {
        (0..n)
            .map(|i| {
                let t = f64::from(i) * 0.1;
                let shift = Vector3::new(speed * t, 0.0, 0.0);
                TimedPose {
                    time: t,
                    pose: Isometry3::new(shift, Vector3::new(0.0, 0.0, 0.2 * t)),
                }
            })
            .collect()
    }

    #[test]
    fn a_trajectory_agrees_with_itself() {
        let truth = straight(50, 1.0);
        let rpe = relative_pose_error(&truth, &truth, &RpeConfig::default()).unwrap();
        assert_eq!(rpe.pairs, 49);
        assert!(rpe.translation.max < 1e-12 && rpe.rotation.max < 1e-7);
    }

    #[test]
    fn drift_per_second_is_measured() {
        let config = RpeConfig {
            interval: RpeInterval::Seconds(1.0),
            all_pairs: true,
            ..Default::default()
        };
        let mut slow = straight(50, 1.0);
        for sample in &mut slow {
            sample.pose.rotation = nalgebra::UnitQuaternion::identity();
        }
        let mut fast = slow.clone();
        for sample in &mut fast {
            sample.pose.translation.vector *= 1.1;
        }
        let rpe = relative_pose_error(&fast, &slow, &config).unwrap();
        assert_eq!(rpe.pairs, 40);
        assert!((rpe.translation.mean - 0.1).abs() < 1e-9);
        let scaled = RpeConfig {
            scale: 1.0 / 1.1,
            ..config
        };
        assert!(
            relative_pose_error(&fast, &slow, &scaled)
                .unwrap()
                .translation
                .max
                < 1e-9
        );
    }

    proptest! {
        #[test]
        fn pairs_over_seconds_are_those_of_looking_at_all(
            steps in prop::collection::vec(0_u8..4, 1..60), tenths in 1_u8..20, all_pairs in any::<bool>(),
        ) {
            // Stamps that repeat and leave gaps; then the same ones in another order.
            let mut time = 0.0;
            let mut times: Vec<f64> = steps.iter().map(|&step| { time += 0.1 * f64::from(step); time }).collect();
            let config = RpeConfig { all_pairs, max_difference: 0.11, ..Default::default() };
            let seconds = 0.1 * f64::from(tenths);
            for _ in 0..2 {
                let mut expected = Vec::new();
                let mut from = 0;
                while from < times.len() {
                    let gap = |to: usize| (times[to] - (times[from] + seconds)).abs();
                    let mut best = None;
                    for to in from + 1..times.len() {
                        best = best.filter(|&k| gap(k) <= gap(to)).or(Some(to));
                    }
                    let hit = best.filter(|&to| gap(to) <= 0.11);
                    expected.extend(hit.map(|to| (from, to)));
                    from = hit.filter(|_| !all_pairs).unwrap_or(from + 1);
                }
                prop_assert_eq!(second_steps(&times, seconds, &config), expected);
                times.reverse();
            }
        }
    }

    #[test]
    fn bad_parameters_are_refused() {
        let truth = straight(5, 1.0);
        for interval in [RpeInterval::Frames(0), RpeInterval::Seconds(f64::NAN)] {
            let config = RpeConfig {
                interval,
                ..Default::default()
            };
            assert!(relative_pose_error(&truth, &truth, &config).is_err());
        }
        let config = RpeConfig {
            interval: RpeInterval::Frames(9),
            ..Default::default()
        };
        assert!(relative_pose_error(&truth, &truth, &config).is_err());
    }
}
