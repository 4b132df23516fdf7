//! Distances and straight steps in ℝᴰ, always summed axis by axis, so that equal input gives equal bits.

/// A point of ℝᴰ: anything cheap to copy that converts to `[f64; D]`.
///
/// Implemented for every such type: arrays, tuples, the points and vectors of the linear algebra crates, and
/// your own types once they have a `From` into an array.
pub trait PointLike<const D: usize>: Copy + Into<[f64; D]> {}

impl<P: Copy + Into<[f64; D]>, const D: usize> PointLike<D> for P {}

pub(crate) fn squared_distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let mut sum = 0.0;
    for axis in 0..D {
        let gap = a[axis] - b[axis];
        sum += gap * gap;
    }
    sum
}

pub(crate) fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    squared_distance(a, b).sqrt()
}

/// The point `a + share (b - a)`; exactly `a` at 0 and exactly `b` at 1.
pub(crate) fn between<const D: usize>(a: &[f64; D], b: &[f64; D], share: f64) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] * (1.0 - share) + b[axis] * share)
}

/// `target` itself when it is at most `step` away from `from`, else the point `step` away on the straight way to it.
pub(crate) fn steer<const D: usize>(from: &[f64; D], target: &[f64; D], step: f64) -> [f64; D] {
    let gap = distance(from, target);
    if gap <= step {
        *target
    } else {
        between(from, target, step / gap)
    }
}

/// The first axis whose value is NaN or infinite.
pub(crate) fn first_non_finite<const D: usize>(point: &[f64; D]) -> Option<usize> {
    point.iter().position(|value| !value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steering_reaches_near_targets_exactly_and_stops_at_the_step() {
        assert_eq!(steer(&[0.0, 0.0], &[0.3, 0.4], 0.5), [0.3, 0.4]);
        let far = steer(&[0.0, 0.0], &[3.0, 4.0], 0.5);
        assert!((distance(&[0.0, 0.0], &far) - 0.5).abs() < 1e-12);
        assert_eq!(between(&[0.1], &[0.7], 1.0), [0.7]);
        assert_eq!(between(&[0.1], &[0.7], 0.0), [0.1]);
    }
}
