//! A robust range per bin: the median of the nearest bins in bearing, and of the whole surroundings.

use crate::profile::{BinStats, RangeProfile};

/// A window stops growing once it holds this many points.
const ENOUGH: usize = 6;
/// No bin has more votes than this in its window, so that one poster does not outvote a doorway.
const MOST_VOTES: usize = 4;
/// A window that holds less than this share of the points of a usual window holds strays.
const STRAY_SHARE: f64 = 0.05;

/// Smoothed range per bin, `None` where (almost) nothing was seen.
///
/// The window around a bin grows from the bin itself to `half` bins on either side until it holds
/// six points; the result is the median of the bins' medians, each with up to four votes.
pub(super) fn smoothed(profile: &RangeProfile, half: usize, min_count: usize) -> Vec<Option<f64>> {
    let bins = &profile.bins;
    let least = stray_limit(bins, half).max(min_count);
    (0..bins.len())
        .map(|bin| window_median(bins, bin, half, least))
        .collect()
}

/// Points in the window of `half` bins on either side of each bin.
pub(super) fn window_counts(bins: &[BinStats], half: usize) -> Vec<usize> {
    (0..bins.len())
        .map(|bin| window(bins, bin, half).map(|stats| stats.count).sum())
        .collect()
}

fn stray_limit(bins: &[BinStats], half: usize) -> usize {
    let mut counts = window_counts(bins, half);
    counts.retain(|&count| count > 0);
    counts.sort_unstable();
    let usual = counts.get(counts.len() / 2).copied().unwrap_or(0);
    (STRAY_SHARE * usual as f64).ceil() as usize
}

fn window(bins: &[BinStats], bin: usize, half: usize) -> impl Iterator<Item = &BinStats> {
    let n = bins.len();
    let half = half.min((n - 1) / 2);
    (bin + n - half..=bin + n + half).map(move |i| &bins[i % n])
}

fn window_median(bins: &[BinStats], bin: usize, half: usize, least: usize) -> Option<f64> {
    let mut grown = 0;
    let count = |grown| {
        window(bins, bin, grown)
            .map(|stats| stats.count)
            .sum::<usize>()
    };
    while grown < half && count(grown) < ENOUGH.max(least) {
        grown += 1;
    }
    if count(grown) < least {
        return None;
    }
    let mut votes: Vec<f64> = window(bins, bin, grown)
        .flat_map(|stats| std::iter::repeat_n(stats.median, stats.count.min(MOST_VOTES)))
        .collect();
    crate::profile::median(&mut votes)
}
