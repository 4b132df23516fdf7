//! Which samples of two trajectories belong together: nearest time stamps, as `evo` pairs them.

use super::{EvaluationError, TimedPose};

/// Pairs `(index into estimate, index into reference)` whose stamps differ by at most `max_difference` seconds.
///
/// For each sample of the shorter trajectory (the estimate when both are equally long) the sample of the
/// longer one with the nearest stamp is taken, the earlier on a tie. Pairs come in the order of the shorter
/// trajectory; a sample of the longer one may be used more than once, as in `evo`.
/// Cost: O((n + m) log m).
///
/// # Errors
/// [`EvaluationError::NonFinite`], and [`EvaluationError::Parameter`] when `max_difference` is negative or NaN.
///
/// ```
/// use edge_slam::evaluation::{TimedPose, associate};
/// use edge_slam::nalgebra::Isometry3;
/// let at = |time| TimedPose { time, pose: Isometry3::identity() };
/// let pairs = associate(&[at(1.004), at(9.0)], &[at(0.99), at(1.0), at(1.02)], 0.01)?;
/// assert_eq!(pairs, [(0, 1)]);
/// # Ok::<(), edge_slam::evaluation::EvaluationError>(())
/// ```
pub fn associate(
    estimate: &[TimedPose],
    reference: &[TimedPose],
    max_difference: f64,
) -> Result<Vec<(usize, usize)>, EvaluationError> {
    check_finite(estimate)?;
    check_finite(reference)?;
    if !(max_difference >= 0.0) {
        return Err(EvaluationError::Parameter {
            name: "max_difference",
            value: max_difference,
            range: "0 or more seconds",
        });
    }
    let estimate_is_shorter = estimate.len() <= reference.len();
    let (short, long) = if estimate_is_shorter {
        (estimate, reference)
    } else {
        (reference, estimate)
    };
    let order = by_time(long);
    let mut pairs = Vec::with_capacity(short.len());
    for (index, sample) in short.iter().enumerate() {
        let Some(other) = nearest(long, &order, sample.time) else {
            break;
        };
        if (long[other].time - sample.time).abs() <= max_difference {
            pairs.push(if estimate_is_shorter {
                (index, other)
            } else {
                (other, index)
            });
        }
    }
    Ok(pairs)
}

/// Coordinates beyond this would overflow when squared and summed.
const LARGEST: f64 = 1e100;

/// Errs at the first sample that holds NaN, infinity or an absurd coordinate.
fn check_finite(trajectory: &[TimedPose]) -> Result<(), EvaluationError> {
    let usable = |sample: &TimedPose| {
        sample.time.is_finite()
            && sample
                .pose
                .translation
                .vector
                .iter()
                .all(|value| value.abs() < LARGEST)
            && sample
                .pose
                .rotation
                .coords
                .iter()
                .all(|value| value.is_finite())
    };
    match trajectory.iter().position(|sample| !usable(sample)) {
        Some(index) => Err(EvaluationError::NonFinite { index }),
        None => Ok(()),
    }
}

fn by_time(trajectory: &[TimedPose]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..trajectory.len()).collect();
    order.sort_by(|&a, &b| trajectory[a].time.total_cmp(&trajectory[b].time));
    order
}

fn nearest(trajectory: &[TimedPose], order: &[usize], time: f64) -> Option<usize> {
    let after = order.partition_point(|&index| trajectory[index].time < time);
    let later = order.get(after).copied();
    let earlier = after.checked_sub(1).and_then(|before| {
        // The first of several equal stamps, so that ties go to the lowest index.
        let stamp = trajectory[order[before]].time;
        order
            .get(order.partition_point(|&index| trajectory[index].time < stamp))
            .copied()
    });
    match (earlier, later) {
        (Some(a), Some(b)) => {
            let (before, behind) = (
                (trajectory[a].time - time).abs(),
                (trajectory[b].time - time).abs(),
            );
            Some(if before < behind || (before == behind && a < b) {
                a
            } else {
                b
            })
        }
        (one, other) => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Isometry3;
    use proptest::prelude::*;

    fn stamps(times: &[f64]) -> Vec<TimedPose> {
        times
            .iter()
            .map(|&time| TimedPose {
                time,
                pose: Isometry3::identity(),
            })
            .collect()
    }

    #[test]
    fn empty_gives_no_pair() {
        assert_eq!(associate(&[], &stamps(&[1.0]), 1.0), Ok(Vec::new()));
        assert_eq!(associate(&stamps(&[1.0]), &[], 1.0), Ok(Vec::new()));
    }

    #[test]
    fn nan_is_an_error() {
        let result = associate(&stamps(&[0.0, f64::NAN]), &stamps(&[1.0]), 1.0);
        assert_eq!(result, Err(EvaluationError::NonFinite { index: 1 }));
        assert!(associate(&[], &[], f64::NAN).is_err());
    }

    proptest! {
        #[test]
        fn agrees_with_brute_force(
            short in prop::collection::vec(0u8..40, 0..20),
            long in prop::collection::vec(0u8..40, 20..40),
        ) {
            let short = stamps(&short.iter().map(|&t| f64::from(t) * 0.5).collect::<Vec<_>>());
            let long = stamps(&long.iter().map(|&t| f64::from(t) * 0.5).collect::<Vec<_>>());
            let mut expected = Vec::new();
            for (i, a) in short.iter().enumerate() {
                let mut best = 0;
                for (j, b) in long.iter().enumerate() {
                    if (b.time - a.time).abs() < (long[best].time - a.time).abs() {
                        best = j;
                    }
                }
                if (long[best].time - a.time).abs() <= 0.5 {
                    expected.push((i, best));
                }
            }
            prop_assert_eq!(associate(&short, &long, 0.5)?, expected);
        }
    }
}
