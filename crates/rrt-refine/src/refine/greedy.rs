//! From each kept vertex to the farthest later one in sight: cheap, and up to a tenth longer than the best choice.

use super::{RefineStop, Refined};
use crate::euclid::distance;
use crate::motion::MotionValidator;
use crate::path::Path;

/// Replaces sub-paths by straight motions, farthest first, once from the start to the end.
///
/// Uses vertices of the input only. The segments of the input are trusted, every other motion is checked. Repeats on its own
/// result until nothing changes, so it is idempotent. O(n²) checks at most.
pub fn greedy<const D: usize>(
    path: &Path<D>,
    motion_is_free: &impl MotionValidator<D>,
) -> Refined<D> {
    let mut points = path.points().to_vec();
    let mut checks = 0;
    loop {
        let kept = pass(&points, motion_is_free, &mut checks);
        // Rounding may make collinear vertices a hair shorter than none.
        if kept.len() == points.len() || length(&kept) > length(&points) {
            break;
        }
        points = kept;
    }
    Refined {
        path: Path::from_vertices(points),
        checks,
        length_before: path.length(),
        stop: RefineStop::Done,
    }
}

fn pass<const D: usize>(
    points: &[[f64; D]],
    motion_is_free: &impl MotionValidator<D>,
    checks: &mut usize,
) -> Vec<[f64; D]> {
    let mut kept = vec![points[0]];
    let mut at = 0;
    while at + 1 < points.len() {
        let farthest = (at + 2..points.len()).rev().find(|&to| {
            *checks += 1;
            motion_is_free.is_free(&points[at], &points[to])
        });
        at = farthest.unwrap_or(at + 1);
        kept.push(points[at]);
    }
    kept
}

fn length<const D: usize>(points: &[[f64; D]]) -> f64 {
    points
        .windows(2)
        .map(|pair| distance(&pair[0], &pair[1]))
        .sum()
}
