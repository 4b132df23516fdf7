//! Empty-cluster repair: an empty cluster takes the point that fits its own cluster worst.

use super::iterate::Assignment;
use crate::vector::{Vec3, distance_squared};

/// Gives each empty cluster the point farthest from its centroid (ties to the lowest index) among the
/// clusters that keep at least one point. There are at least as many points as clusters.
pub(super) fn fill_empty(
    points: &[Vec3],
    centroids: &[Vec3],
    labels: &mut [usize],
    assignment: &mut impl Assignment,
) {
    let mut sizes = vec![0_usize; centroids.len()];
    for &label in labels.iter() {
        sizes[label] += 1;
    }
    if !sizes.contains(&0) {
        return;
    }
    let mut farthest: Vec<(f64, usize)> = points
        .iter()
        .zip(labels.iter())
        .enumerate()
        .map(|(index, (point, &label))| (distance_squared(*point, centroids[label]), index))
        .collect();
    farthest.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut farthest = farthest.into_iter();
    for empty in 0..sizes.len() {
        if sizes[empty] > 0 {
            continue;
        }
        for (_, index) in farthest.by_ref() {
            if sizes[labels[index]] > 1 {
                sizes[labels[index]] -= 1;
                labels[index] = empty;
                sizes[empty] = 1;
                assignment.relabelled(index);
                break;
            }
        }
    }
}
