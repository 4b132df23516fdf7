//! A polyline of finite points with a finite length.

use crate::euclid::{PointLike, between, distance, first_non_finite};
use crate::motion::MotionValidator;

/// A polyline with at least one vertex; all coordinates and the length are finite.
///
/// ```
/// use rrt_refine::Path;
/// let path = Path::new(&[[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]])?;
/// assert_eq!(path.length(), 7.0);
/// assert_eq!(path.point_at(4.0), [3.0, 1.0]);
/// # Ok::<(), rrt_refine::PathError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Path<const D: usize> {
    points: Vec<[f64; D]>,
}

/// A point of a path and the segment that it lies on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<const D: usize> {
    pub(crate) segment: usize,
    pub(crate) point: [f64; D],
}

/// Why a list of points, or a request about a path, is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathError {
    /// No vertex was given.
    #[error("path: no vertex was given; a path has at least one")]
    Empty,
    /// A vertex has a coordinate that is NaN or infinite.
    #[error("path: vertex {index} has {value} on axis {axis}; coordinates must be finite")]
    NonFinite {
        /// Index of the vertex.
        index: usize,
        /// Index of the axis.
        axis: usize,
        /// The coordinate.
        value: f64,
    },
    /// The length overflows.
    #[error("path: the length overflows at vertex {index}; keep coordinates below 1e150")]
    TooLong {
        /// Index of the vertex at which it does.
        index: usize,
    },
    /// A step, spacing or limit is not a positive finite number.
    #[error("path: {name} is {value}; it must be positive and finite")]
    NotPositive {
        /// Which argument.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The request asks for more points than fit into memory reasonably.
    #[error(
        "path: the request needs about {needed:.0} points and {limit} are allowed; use a larger step"
    )]
    TooMany {
        /// About how many points were asked for.
        needed: f64,
        /// The most that are given.
        limit: usize,
    },
}

impl<const D: usize> Path<D> {
    /// A path through the given vertices, in order. Equal neighbours are kept.
    ///
    /// # Errors
    /// No vertex, a coordinate that is not finite, or a length that overflows.
    pub fn new<P: PointLike<D>>(points: &[P]) -> Result<Self, PathError> {
        let points: Vec<[f64; D]> = points.iter().map(|point| (*point).into()).collect();
        if points.is_empty() {
            return Err(PathError::Empty);
        }
        let mut length = 0.0;
        for (index, point) in points.iter().enumerate() {
            if let Some(axis) = first_non_finite(point) {
                let value = point[axis];
                return Err(PathError::NonFinite { index, axis, value });
            }
            if index > 0 {
                length += distance(&points[index - 1], point);
            }
            if !length.is_finite() {
                return Err(PathError::TooLong { index });
            }
        }
        Ok(Self { points })
    }

    /// For vertices that are known to be finite, at least one of them.
    pub(crate) fn from_vertices(points: Vec<[f64; D]>) -> Self {
        debug_assert!(!points.is_empty());
        Self { points }
    }

    /// The vertices in order; never empty.
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    /// The vertices in order, without a copy.
    pub fn into_points(self) -> Vec<[f64; D]> {
        self.points
    }

    /// First vertex.
    pub fn start(&self) -> [f64; D] {
        self.points[0]
    }

    /// Last vertex.
    pub fn end(&self) -> [f64; D] {
        self.points[self.points.len() - 1]
    }

    /// Sum of the lengths of the segments; 0 for one vertex.
    pub fn length(&self) -> f64 {
        self.segments().map(|(a, b)| distance(a, b)).sum()
    }

    /// The straight segments in order, as pairs of their ends.
    pub fn segments(&self) -> impl Iterator<Item = (&[f64; D], &[f64; D])> {
        self.points.windows(2).map(|pair| (&pair[0], &pair[1]))
    }

    /// The point `along` the path from its start; clamped to the two ends, and the start for a NaN.
    pub fn point_at(&self, along: f64) -> [f64; D] {
        self.place_at(along).point
    }

    pub(crate) fn place_at(&self, along: f64) -> Place<D> {
        let mut left = along.max(0.0);
        for (segment, (a, b)) in self.segments().enumerate() {
            let length = distance(a, b);
            if left < length {
                let point = between(a, b, left / length);
                return Place { segment, point };
            }
            left -= length;
        }
        Place {
            segment: self.points.len().saturating_sub(2),
            point: self.end(),
        }
    }

    /// Index of the first segment whose motion is not free; `None` when the whole path is free. One check a segment,
    /// or one for the point of a path without segments.
    pub fn first_blocked(&self, motion_is_free: &impl MotionValidator<D>) -> Option<usize> {
        if let [only] = self.points.as_slice() {
            return (!motion_is_free.is_free(only, only)).then_some(0);
        }
        self.segments()
            .position(|(a, b)| !motion_is_free.is_free(a, b))
    }

    /// The same path from its end to its start.
    pub fn reversed(&self) -> Self {
        let mut points = self.points.clone();
        points.reverse();
        Self { points }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_are_no_path_are_refused() {
        assert_eq!(Path::<2>::new::<[f64; 2]>(&[]), Err(PathError::Empty));
        assert!(matches!(
            Path::new(&[[0.0, 0.0], [0.0, f64::INFINITY]]),
            Err(PathError::NonFinite {
                index: 1,
                axis: 1,
                ..
            })
        ));
        assert_eq!(
            Path::new(&[[-1e300], [1e300]]),
            Err(PathError::TooLong { index: 1 })
        );
    }

    #[test]
    fn one_vertex_is_a_path_of_length_zero() -> Result<(), PathError> {
        let path = Path::new(&[[1.0, 2.0]])?;
        assert_eq!(path.length(), 0.0);
        assert_eq!(path.point_at(3.0), [1.0, 2.0]);
        assert_eq!(path.start(), path.end());
        Ok(())
    }

    #[test]
    fn positions_clamp_to_the_ends() -> Result<(), PathError> {
        let path = Path::new(&[[0.0], [1.0], [1.0], [3.0]])?;
        assert_eq!(path.point_at(-1.0), [0.0]);
        assert_eq!(path.point_at(f64::NAN), [0.0]);
        assert_eq!(path.point_at(1.0), [1.0]);
        assert_eq!(path.point_at(2.5), [2.5]);
        assert_eq!(path.point_at(9.0), [3.0]);
        Ok(())
    }

    #[test]
    fn the_first_blocked_segment_is_named() -> Result<(), PathError> {
        let path = Path::new(&[[0.0], [1.0], [2.0]])?;
        let below = |_: &[f64; 1], to: &[f64; 1]| to[0] < 1.5;
        assert_eq!(path.first_blocked(&below), Some(1));
        assert_eq!(path.first_blocked(&|_: &[f64; 1], _: &[f64; 1]| true), None);
        Ok(())
    }
}
