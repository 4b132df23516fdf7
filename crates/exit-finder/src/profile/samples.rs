//! A sorted sample of the ranges in each bin, to count what lies beyond a wall.
//!
//! A bin of a sparse map holds a few points, which are kept as they are. Of a fuller bin sixteen evenly
//! spaced ranks are kept, so that a query costs the same in a dense map.

const MOST: usize = 16;

/// Samples of all bins, ascending in each.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Samples {
    ranges: Vec<f64>,
    /// Where the samples of each bin end.
    ends: Vec<usize>,
    /// Points in each bin.
    counts: Vec<usize>,
}

impl Samples {
    pub(crate) fn with_capacity(n: usize) -> Self {
        Self {
            ranges: Vec::with_capacity(n * MOST / 2),
            ends: Vec::with_capacity(n),
            counts: Vec::with_capacity(n),
        }
    }

    /// Adds a bin with these ascending ranges, given as bit patterns.
    pub(crate) fn push_sorted(&mut self, ranges: &[u64]) {
        let kept = ranges.len().min(MOST);
        let rank = |k: usize| (2 * k + 1) * ranges.len() / (2 * kept);
        let sample = (0..kept).map(|k| f64::from_bits(ranges[rank(k)]));
        self.ranges.extend(sample);
        self.ends.push(self.ranges.len());
        self.counts.push(ranges.len());
    }

    /// Adds a bin with the ranges of two ascending lists, without merging them.
    pub(crate) fn push_union(&mut self, a: &[u64], b: &[u64]) {
        let len = a.len() + b.len();
        let kept = len.min(MOST);
        let rank = |k: usize| (2 * k + 1) * len / (2 * kept);
        let sample = (0..kept).map(|k| f64::from_bits(of_rank(a, b, rank(k))));
        self.ranges.extend(sample);
        self.ends.push(self.ranges.len());
        self.counts.push(len);
    }

    /// Points in a bin.
    pub(crate) fn count(&self, bin: usize) -> usize {
        self.counts[bin]
    }

    /// The sample of a bin, ascending.
    pub(crate) fn of(&self, bin: usize) -> &[f64] {
        let start = bin.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.ranges[start..self.ends[bin]]
    }
}

/// The number of this rank, below their joint length, in two ascending lists. O(log n).
fn of_rank(a: &[u64], b: &[u64], rank: usize) -> u64 {
    // How many of those before it are in `a`: the least number after which the next of `a` is no smaller than the last of `b`.
    let (mut low, mut high) = (rank.saturating_sub(b.len()), rank.min(a.len()));
    while low < high {
        let middle = usize::midpoint(low, high);
        let too_few = a[middle] < b[rank - middle - 1];
        low = if too_few { middle + 1 } else { low };
        high = if too_few { high } else { middle };
    }
    let next = |list: &[u64], index: usize| list.get(index).copied().unwrap_or(u64::MAX);
    next(a, low).min(next(b, rank - low))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rank_in_two_lists_is_that_in_the_merged_one() {
        let list = |n: u64, step: u64| -> Vec<u64> { (0..n).map(|i| i * step / 3).collect() };
        for (n, m) in [(0, 1), (1, 0), (5, 5), (17, 40), (40, 3), (100, 100)] {
            for (p, q) in [(1, 1), (2, 7), (9, 1)] {
                let (a, b) = (list(n, p), list(m, q));
                let mut merged = [&a[..], &b[..]].concat();
                merged.sort_unstable();
                for (rank, &expected) in merged.iter().enumerate() {
                    assert_eq!(of_rank(&a, &b, rank), expected);
                }
            }
        }
    }

    #[test]
    fn few_ranges_are_kept_and_many_are_thinned_evenly() {
        let mut samples = Samples::with_capacity(3);
        let bits = |n: u32| -> Vec<u64> { (0..n).map(|i| f64::from(i).to_bits()).collect() };
        samples.push_sorted(&bits(3));
        samples.push_sorted(&[]);
        samples.push_sorted(&bits(320));
        assert_eq!(samples.of(0), [0.0, 1.0, 2.0]);
        assert!(samples.of(1).is_empty() && samples.count(1) == 0);
        assert_eq!(samples.count(2), 320);
        let expected: Vec<f64> = (0..16).map(|k| f64::from(10 + 20 * k)).collect();
        assert_eq!(samples.of(2), expected);
    }
}
