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

#[cfg(test)]
mod tests {
    use super::*;

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
