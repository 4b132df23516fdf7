//! What every planner is asked: from where, to where, and inside which box.

use crate::bounds::Bounds;
use crate::euclid::PointLike;

/// A planning question: a path from `start` to one of `goals`, inside `bounds`.
///
/// The planners refuse a question that makes no sense; making one checks nothing.
///
/// ```
/// use rrt_refine::{Bounds, Query};
/// let bounds = Bounds::new([0.0, 0.0], [10.0, 10.0])?;
/// let one = Query::new([1.0, 1.0], [9.0, 1.0], bounds);
/// let several = Query::to_any_of([1.0, 1.0], &[[9.0, 1.0], [9.0, 9.0]], bounds);
/// assert_eq!((one.goals.len(), several.goals.len()), (1, 2));
/// # Ok::<(), rrt_refine::BoundsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Query<const D: usize> {
    /// Where the path begins; finite, inside the bounds, free.
    pub start: [f64; D],
    /// Where it may end, at least one; finite and inside the bounds. Goals that are not free are left out of the search.
    pub goals: Vec<[f64; D]>,
    /// Where samples are drawn; the whole path stays inside, since a box is convex.
    pub bounds: Bounds<D>,
}

impl<const D: usize> Query<D> {
    /// A path from `start` to `goal`.
    pub fn new(start: impl PointLike<D>, goal: impl PointLike<D>, bounds: Bounds<D>) -> Self {
        Self::to_any_of(start, &[goal], bounds)
    }

    /// A path from `start` to whichever of `goals` is reached first, or over the shortest path by the planners that improve theirs.
    pub fn to_any_of<P: PointLike<D>>(
        start: impl PointLike<D>,
        goals: &[P],
        bounds: Bounds<D>,
    ) -> Self {
        Self {
            start: start.into(),
            goals: goals.iter().map(|goal| (*goal).into()).collect(),
            bounds,
        }
    }
}
