//! The axis-aligned box that a planner samples in.

use rand::{Rng, RngExt};

use crate::euclid::{PointLike, distance};

/// A closed axis-aligned box of ℝᴰ. An axis may have zero width: planning then happens in that plane.
///
/// ```
/// let bounds = rrt_refine::Bounds::new([0.0, 0.0], [4.0, 3.0])?;
/// assert!(bounds.contains(&[4.0, 0.0]));
/// assert_eq!(bounds.diagonal(), 5.0);
/// # Ok::<(), rrt_refine::BoundsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<const D: usize> {
    min: [f64; D],
    max: [f64; D],
}

/// Why two corners are not a box.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BoundsError {
    /// A corner has a coordinate that is NaN or infinite.
    #[error("bounds: axis {axis} goes from {min} to {max}; both ends must be finite")]
    NonFinite {
        /// Index of the axis.
        axis: usize,
        /// Lower end as given.
        min: f64,
        /// Upper end as given.
        max: f64,
    },
    /// The lower end is above the upper end.
    #[error("bounds: axis {axis} goes from {min} down to {max}; swap the two corners on this axis")]
    Inverted {
        /// Index of the axis.
        axis: usize,
        /// Lower end as given.
        min: f64,
        /// Upper end as given.
        max: f64,
    },
    /// The box is so large that the square of its diagonal overflows.
    #[error("bounds: the diagonal of the box overflows; keep coordinates below 1e150")]
    TooLarge,
    /// No point was given to put a box around.
    #[error("bounds: no point was given to put a box around; give at least one")]
    Empty,
}

impl<const D: usize> Bounds<D> {
    /// The box between two corners.
    ///
    /// # Errors
    /// A coordinate that is not finite, a lower end above the upper end, or a diagonal that overflows.
    pub fn new(min: impl PointLike<D>, max: impl PointLike<D>) -> Result<Self, BoundsError> {
        let (min, max): ([f64; D], [f64; D]) = (min.into(), max.into());
        for axis in 0..D {
            let (min, max) = (min[axis], max[axis]);
            if !(min.is_finite() && max.is_finite()) {
                return Err(BoundsError::NonFinite { axis, min, max });
            }
            if min > max {
                return Err(BoundsError::Inverted { axis, min, max });
            }
        }
        if !distance(&min, &max).is_finite() {
            return Err(BoundsError::TooLarge);
        }
        Ok(Self { min, max })
    }

    /// The smallest box around `points`, grown by `margin` (in the unit of the points) on every side.
    ///
    /// # Errors
    /// No point, a coordinate that is not finite, or a negative margin that turns an axis over.
    pub fn around<P: PointLike<D>>(points: &[P], margin: f64) -> Result<Self, BoundsError> {
        let Some((first, rest)) = points.split_first() else {
            return Err(BoundsError::Empty);
        };
        let mut min: [f64; D] = (*first).into();
        let mut max = min;
        for point in rest {
            let point: [f64; D] = (*point).into();
            for axis in 0..D {
                // Not `f64::min`: it would silently drop a NaN.
                if !point[axis].is_finite() || point[axis] < min[axis] {
                    min[axis] = point[axis];
                }
                if point[axis] > max[axis] {
                    max[axis] = point[axis];
                }
            }
        }
        Self::new(min.map(|low| low - margin), max.map(|high| high + margin))
    }

    /// Lower corner.
    pub fn min(&self) -> [f64; D] {
        self.min
    }

    /// Upper corner.
    pub fn max(&self) -> [f64; D] {
        self.max
    }

    /// Whether the point lies in the box or on its border. A point with a NaN lies nowhere.
    pub fn contains(&self, point: &[f64; D]) -> bool {
        (0..D).all(|axis| self.min[axis] <= point[axis] && point[axis] <= self.max[axis])
    }

    /// Distance between the two corners.
    pub fn diagonal(&self) -> f64 {
        distance(&self.min, &self.max)
    }

    /// A point drawn uniformly from the box: one `f64` of `rng` per axis, in the order of the axes.
    pub fn sample(&self, rng: &mut impl Rng) -> [f64; D] {
        std::array::from_fn(|axis| {
            let share: f64 = rng.random();
            let (min, max) = (self.min[axis], self.max[axis]);
            (min * (1.0 - share) + max * share).clamp(min, max)
        })
    }
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn corners_that_are_no_box_are_refused() {
        assert!(matches!(
            Bounds::new([0.0, f64::NAN], [1.0, 1.0]),
            Err(BoundsError::NonFinite { axis: 1, .. })
        ));
        assert!(matches!(
            Bounds::new([2.0], [1.0]),
            Err(BoundsError::Inverted { axis: 0, .. })
        ));
        assert_eq!(Bounds::new([-1e200], [1e200]), Err(BoundsError::TooLarge));
        assert_eq!(
            Bounds::<2>::around::<[f64; 2]>(&[], 0.0),
            Err(BoundsError::Empty)
        );
        assert!(Bounds::around(&[[0.0], [f64::NAN], [1.0]], 0.0).is_err());
    }

    #[test]
    fn samples_stay_inside_even_on_an_axis_without_width() -> Result<(), BoundsError> {
        let bounds = Bounds::new([-1.0, 0.1], [2.0, 0.1])?;
        let mut rng = Pcg64::new(1, 1);
        for _ in 0..1000 {
            assert!(bounds.contains(&bounds.sample(&mut rng)));
        }
        Ok(())
    }
}
