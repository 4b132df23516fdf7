//! Sectors into which the camera never looked.

use super::smoothing::window_counts;
use crate::config::RangeAware;
use crate::profile::RangeProfile;
use crate::sector::{Run, circular_runs};
use crate::view::ExitView;

/// Flags the bins that were never looked at.
///
/// With gazes: bins that no gaze covers at the median range. Without: runs of empty bins wider than
/// `rule.unseen`, the border of a partial scan.
pub(super) fn unseen_bins(
    profile: &RangeProfile,
    ranges: &[Option<f64>],
    rule: &RangeAware,
    view: &ExitView<'_>,
) -> Vec<bool> {
    let n = ranges.len();
    let empty: Vec<bool> = ranges.iter().map(Option::is_none).collect();
    if view.gazes.is_empty() {
        let wide = |run: &Run| run.sector(n).width_rad > rule.unseen;
        return flags_of(n, circular_runs(&empty).into_iter().filter(wide));
    }
    let seen = |bin: usize| {
        let bearing = profile.centre_of(bin);
        let covers = |g: &crate::view::Gaze| {
            g.covers(&profile.plane, profile.agent, bearing, profile.median_range)
        };
        view.gazes.iter().any(covers)
    };
    (0..n).map(|bin| empty[bin] && !seen(bin)).collect()
}

/// Points expected in a run were it a wall like the rest: the median density of the windows seen.
pub(super) fn expected_points(profile: &RangeProfile, run: Run, half: usize) -> f64 {
    let mut counts = window_counts(&profile.bins, half);
    counts.retain(|&count| count > 0);
    counts.sort_unstable();
    let usual = counts.get(counts.len() / 2).copied().unwrap_or(0);
    usual as f64 / (2 * half + 1) as f64 * run.len as f64
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
