//! Sectors into which the camera never looked.

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
