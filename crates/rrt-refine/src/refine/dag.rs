//! The shortest path over a path's own vertices: the paper's sub-path replacement done optimally.
//!
//! Paper: Tukan et al. 2023, path refinement: "replace the sub-path A..B by the segment AB where it is free". Done one by
//! one, as printed, the outcome depends on the order; the shortest path of the visibility DAG on the vertices does not.

use super::visibility_graph::{Known, cheapest_way};
use super::{RefineStop, Refined};
use crate::euclid::distance;
use crate::motion::MotionValidator;
use crate::path::Path;

/// Shortest path over a subset of the vertices of `path`, its two ends always among them.
///
/// Never longer than the input, idempotent, and valid wherever the segments of the input are: those are trusted, every
/// other motion is checked, lazily: some 60 % of all n(n−1)/2 pairs in clutter, one where the straight way is free. O(n² log n) besides.
///
/// ```
/// use rrt_refine::{Path, refine};
/// let zigzag = Path::new(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0], [4.0, 0.0]])?;
/// let refined = refine::dag(&zigzag, &|_: &[f64; 2], _: &[f64; 2]| true);
/// assert_eq!(refined.path.points(), [[0.0, 0.0], [4.0, 0.0]]);
/// assert_eq!(refined.checks, 1);
/// # Ok::<(), rrt_refine::PathError>(())
/// ```
pub fn dag<const D: usize>(path: &Path<D>, motion_is_free: &impl MotionValidator<D>) -> Refined<D> {
    dag_by_cost(path, motion_is_free, &distance)
}

/// As [`dag()`], with a cost of motions in place of their length.
///
/// The cost of a motion must be at least its length; where it is less, or NaN, the length counts. Since a subset of the
/// vertices is chosen, the length never grows either, even where the cost prefers a detour of the input. See
/// [`ClearanceCost`](super::ClearanceCost).
///
/// ```
/// use rrt_refine::{Path, refine};
/// // Ground above y = 0.5 is three times as dear, so the corner stays.
/// let corner = Path::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])?;
/// let dear = |a: &[f64; 2], b: &[f64; 2]| {
///     let length = ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt();
///     if a[1] != b[1] && a[0] != b[0] { 3.0 * length } else { length }
/// };
/// let refined = refine::dag_by_cost(&corner, &|_: &[f64; 2], _: &[f64; 2]| true, &dear);
/// assert_eq!(refined.path, corner);
/// # Ok::<(), rrt_refine::PathError>(())
/// ```
pub fn dag_by_cost<const D: usize>(
    path: &Path<D>,
    motion_is_free: &impl MotionValidator<D>,
    cost: &impl Fn(&[f64; D], &[f64; D]) -> f64,
) -> Refined<D> {
    let points = path.points();
    let way = cheapest_way(
        points,
        motion_is_free,
        Known::SegmentsFree,
        usize::MAX,
        cost,
    );
    let refined = match way.vertices {
        Some(way) => Path::from_vertices(way.into_iter().map(|vertex| points[vertex]).collect()),
        // Only where a cost is infinite everywhere.
        None => path.clone(),
    };
    Refined {
        path: refined,
        checks: way.checks,
        length_before: path.length(),
        stop: RefineStop::Done,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cost_below_the_length_or_that_is_none_counts_as_the_length() -> Result<(), crate::PathError>
    {
        let corner = Path::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])?;
        for cost in [-1.0, 0.0, f64::NAN] {
            let refined = dag_by_cost(&corner, &|_: &[f64; 2], _: &[f64; 2]| true, &|_, _| cost);
            assert_eq!(refined.path.points(), [[0.0, 0.0], [1.0, 1.0]], "{cost}");
        }
        Ok(())
    }
}
