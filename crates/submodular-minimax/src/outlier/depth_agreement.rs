//! Does a point lie at the depth of what is seen next to it?
//!
//! A wrong triangulation moves a point along its viewing ray, where it leaves the surface that its
//! image neighbours lie on. For a point v and a camera c: the 20 points that c sees nearest to v in
//! direction, |ln(|cv| / |cu|)| for each, and of these the tenth smallest, so that one side of a depth
//! edge may disagree. The least over the first, the middle and the last observer counts.
//! Cost: three searches a point, O(log) each.

use super::sight::Sight;
use crate::neighbours::RangeTree;
use crate::points::{Cloud, median};

/// Image neighbours compared with.
const AROUND: usize = 20;
/// The rank of the disagreement that counts.
const RANK: usize = 10;
/// A camera that sees fewer points tells nothing.
const FEWEST: usize = 50;

/// The disagreement of every point, a log ratio at least 0; the median where no camera can tell.
pub(super) fn depth_disagreement(cloud: &Cloud, sight: &Sight<'_>) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; cloud.len()];
    for camera in 0..sight.cameras.len() {
        compare_in_camera(cloud, sight, camera, &mut least);
    }
    let mut known: Vec<f64> = least.iter().copied().filter(|d| d.is_finite()).collect();
    let typical = median(&mut known);
    least
        .into_iter()
        .map(|d| if d.is_finite() { d } else { typical })
        .collect()
}

fn compare_in_camera(cloud: &Cloud, sight: &Sight<'_>, camera: usize, least: &mut [f64]) {
    let seen = &sight.seen[camera];
    if seen.len() < FEWEST {
        return;
    }
    let (directions, depth): (Vec<[f64; 3]>, Vec<f64>) = seen
        .iter()
        .map(|&v| sight.bearing(cloud, camera, v as usize))
        .unzip();
    let tree = RangeTree::new(&directions, &[]);
    let (mut found, mut disagreements) = (Vec::new(), Vec::new());
    for (position, &at) in tree.order().iter().enumerate() {
        let v = seen[at as usize] as usize;
        if !asked(sight.views.row(v), camera) {
            continue;
        }
        tree.nearest(position, AROUND, f64::INFINITY, &mut found);
        let own = depth[at as usize];
        disagreements.clear();
        disagreements.extend(found.iter().map(|n| log_ratio(own, depth[n.1 as usize])));
        let (_, &mut middle, _) = disagreements.select_nth_unstable_by(RANK - 1, f64::total_cmp);
        least[v] = least[v].min(middle);
    }
}

/// Whether the camera is the first, the middle or the last observer.
fn asked(observers: &[u32], camera: usize) -> bool {
    let is = |at: usize| observers.get(at).is_some_and(|&c| c as usize == camera);
    is(0) || is(observers.len() / 2) || is(observers.len().saturating_sub(1))
}

fn log_ratio(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 {
        (a / b).ln().abs()
    } else {
        f64::MAX
    }
}
