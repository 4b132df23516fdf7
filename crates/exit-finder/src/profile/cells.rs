//! Counting into bins: statistics, and a sample of the ranges in each bin.

use super::samples::Samples;
use super::statistics::BinStats;

/// Everything that is kept per bin.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cells {
    pub(crate) bins: Vec<BinStats>,
    /// All points of the band.
    pub(crate) seen: Samples,
    /// Those at the flying height.
    pub(crate) level: Samples,
}

impl Cells {
    /// Statistics of points given as (bin, whether at flying height, range). O(n log(n / bins)).
    pub(crate) fn of(
        n: usize,
        quantile: f64,
        points: impl Iterator<Item = (usize, bool, f64)> + Clone,
    ) -> Self {
        // Within a bin, the points at flying height come first.
        let cell = |bin: usize, level: bool| 2 * bin + usize::from(!level);
        let mut ends = vec![0usize; 2 * n + 1];
        for (bin, level, _) in points.clone() {
            ends[cell(bin, level) + 1] += 1;
        }
        for cell in 0..2 * n {
            ends[cell + 1] += ends[cell];
        }
        let mut cursor = ends.clone();
        let mut ranges = vec![0u64; ends[2 * n]];
        for (bin, level, range) in points {
            let slot = &mut cursor[cell(bin, level)];
            ranges[*slot] = range.to_bits();
            *slot += 1;
        }
        let mut cells = Self::with_capacity(n);
        let mut merged = Vec::new();
        for bin in 0..n {
            let own = &mut ranges[ends[2 * bin]..ends[2 * bin + 2]];
            let (level, other) = own.split_at_mut(ends[2 * bin + 1] - ends[2 * bin]);
            level.sort_unstable();
            other.sort_unstable();
            merge(level, other, &mut merged);
            cells.level.push_sorted(level);
            cells.seen.push_sorted(&merged);
            cells.bins.push(BinStats::of_sorted(&merged, quantile));
        }
        cells
    }

    fn with_capacity(n: usize) -> Self {
        Self {
            bins: Vec::with_capacity(n),
            seen: Samples::with_capacity(n),
            level: Samples::with_capacity(n),
        }
    }
}

/// Merges two ascending lists.
fn merge(mut a: &[u64], mut b: &[u64], merged: &mut Vec<u64>) {
    merged.clear();
    while let ([first, rest_of_a @ ..], [second, rest_of_b @ ..]) = (a, b) {
        if first <= second {
            merged.push(*first);
            a = rest_of_a;
        } else {
            merged.push(*second);
            b = rest_of_b;
        }
    }
    merged.extend_from_slice(a);
    merged.extend_from_slice(b);
}
