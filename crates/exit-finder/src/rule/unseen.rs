//! Sectors into which the camera never looked.

use crate::angle::turn;
use crate::config::RangeAware;
use crate::plane::AffinePlane;
use crate::profile::RangeProfile;
use crate::sector::{Run, circular_runs};
use crate::vector::{add, is_finite, sub, unit};
use crate::view::{ExitView, Gaze, Ray};

/// Flags the bins that were never looked at.
///
/// With gazes: empty bins that no gaze covers at the median range. With rays alone, each keyframe looked from the outermost of its rays
/// on one side to that on the other. With neither: runs of empty bins wider than
/// `rule.unseen`, the border of a partial scan.
pub(super) fn unseen_bins(
    profile: &RangeProfile,
    ranges: &[Option<f64>],
    rule: &RangeAware,
    view: &ExitView<'_>,
) -> Vec<bool> {
    let n = ranges.len();
    let empty: Vec<bool> = ranges.iter().map(Option::is_none).collect();
    let looks;
    let gazes = if view.gazes.is_empty() {
        looks = gazes_of(view.rays, profile);
        &looks[..]
    } else {
        view.gazes
    };
    if gazes.is_empty() {
        let wide = |run: &Run| run.sector(n).width_rad > rule.unseen;
        return flags_of(n, circular_runs(&empty).into_iter().filter(wide));
    }
    let seen = |bin: usize| {
        let bearing = profile.centre_of(bin);
        let covers =
            |g: &Gaze| g.covers(&profile.plane, profile.agent, bearing, profile.median_range);
        gazes.iter().any(covers)
    };
    (0..n).map(|bin| empty[bin] && !seen(bin)).collect()
}

/// Where the keyframes looked, as far as their rays tell; keyframes with fewer than [`FEWEST`] rays tell nothing. O(rays · log).
fn gazes_of(rays: &[Ray], profile: &RangeProfile) -> Vec<Gaze> {
    let finite = rays.iter().filter(|ray| is_finite(ray.origin));
    let mut by_keyframe: Vec<&Ray> = finite.collect();
    let key = |ray: &Ray| ray.origin.map(f64::to_bits);
    by_keyframe.sort_by_key(|ray| key(ray));
    by_keyframe
        .chunk_by(|a, b| key(a) == key(b))
        .filter_map(|rays| gaze_of(rays, &profile.plane))
        .collect()
}

fn gaze_of(rays: &[&Ray], plane: &AffinePlane) -> Option<Gaze> {
    if rays.len() < FEWEST {
        return None;
    }
    let position = rays.first()?.origin;
    let mean = rays.iter().filter_map(|ray| unit(sub(ray.end, position)));
    let forward = mean.fold([0.0; 3], add);
    let middle = plane.bearing(forward)?;
    let bearings = rays
        .iter()
        .filter_map(|ray| plane.bearing(sub(ray.end, position)));
    // A twentieth of the rays on either side may go astray.
    let mut off: Vec<f64> = bearings.map(|bearing| turn(middle, bearing)).collect();
    off.sort_unstable_by(f64::total_cmp);
    let astray = off.len() / 20;
    let (left, right) = (*off.get(astray)?, *off.get(off.len() - 1 - astray)?);
    let bearing = middle + 0.5 * (left + right);
    Some(Gaze {
        position,
        forward: plane.direction([bearing.cos(), bearing.sin()]),
        half_fov_rad: 0.5 * (right - left),
    })
}

/// A keyframe with fewer rays does not tell where it looked.
const FEWEST: usize = 10;

/// Points that a run of this length holds elsewhere: in the poorest tenth of such runs, and on average.
///
/// Runs that touch a gap at least half as long are left out: other doors say nothing about walls.
pub(super) fn points_elsewhere(profile: &RangeProfile, run: Run, gaps: &[Run]) -> (f64, f64) {
    let n = profile.bins.len();
    let mut blocked = vec![false; n];
    for gap in gaps.iter().filter(|gap| 2 * gap.len >= run.len) {
        gap.bins(n).for_each(|bin| blocked[bin] = true);
    }
    let mut counts: Vec<usize> = (0..n)
        .map(|start| Run { start, ..run })
        .filter(|other| other.bins(n).all(|bin| !blocked[bin]))
        .map(|other| other.bins(n).map(|bin| profile.bins[bin].count).sum())
        .collect();
    counts.sort_unstable();
    let mean = counts.iter().sum::<usize>() as f64 / counts.len().max(1) as f64;
    (
        counts
            .get(counts.len() / 10)
            .map_or(0.0, |&count| count as f64),
        mean,
    )
}

fn flags_of(n: usize, runs: impl Iterator<Item = Run>) -> Vec<bool> {
    let mut flags = vec![false; n];
    for run in runs {
        for bin in run.bins(n) {
            flags[bin] = true;
        }
    }
    flags
}
