//! One goal or several: a planner stops at the first that it reaches, or keeps the nearest one by path.

use crate::euclid::PointLike;

/// The places that a path may end at, in the caller's order.
///
/// ```
/// use rrt_refine::Goals;
/// let one: Goals<2> = [1.0, 2.0].into();
/// let several = Goals::from_points(&[[1.0, 2.0], [3.0, 4.0]]);
/// assert_eq!((one.points().len(), several.points().len()), (1, 2));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Goals<const D: usize> {
    points: Vec<[f64; D]>,
}

impl<const D: usize> Goals<D> {
    /// Several goals. An empty list is refused by the planners, not here.
    pub fn from_points<P: PointLike<D>>(points: &[P]) -> Self {
        Self {
            points: points.iter().map(|point| (*point).into()).collect(),
        }
    }

    /// The goals in the caller's order.
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }
}

impl<const D: usize> From<[f64; D]> for Goals<D> {
    fn from(point: [f64; D]) -> Self {
        Self {
            points: vec![point],
        }
    }
}

impl<const D: usize> From<&[f64; D]> for Goals<D> {
    fn from(point: &[f64; D]) -> Self {
        (*point).into()
    }
}

impl<const D: usize> From<Vec<[f64; D]>> for Goals<D> {
    fn from(points: Vec<[f64; D]>) -> Self {
        Self { points }
    }
}

impl<const D: usize> From<&[[f64; D]]> for Goals<D> {
    fn from(points: &[[f64; D]]) -> Self {
        Self::from_points(points)
    }
}
