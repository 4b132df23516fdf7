//! Count, mean, median, minimum and a low quantile of the ranges in one bin.

/// Statistics of one bin. An empty bin has count 0 and infinite ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BinStats {
    /// Points in the bin, virtual ones included.
    pub count: usize,
    /// Mean range, map units.
    pub mean: f64,
    /// Lower median of the ranges.
    pub median: f64,
    /// Smallest range.
    pub min: f64,
    /// The configured low quantile (nearest rank, rounded down).
    pub quantile: f64,
}

impl BinStats {
    pub(crate) const EMPTY: Self = Self {
        count: 0,
        mean: f64::INFINITY,
        median: f64::INFINITY,
        min: f64::INFINITY,
        quantile: f64::INFINITY,
    };

    /// Statistics of the ascending ranges of one bin. O(n).
    pub(crate) fn of_sorted(ranges: &[f64], quantile: f64) -> Self {
        let Some(last) = ranges.len().checked_sub(1) else {
            return Self::EMPTY;
        };
        let rank = (last as f64 * quantile) as usize;
        Self {
            count: ranges.len(),
            mean: ranges.iter().sum::<f64>() / ranges.len() as f64,
            median: ranges[last / 2],
            min: ranges[0],
            quantile: ranges[rank.min(last)],
        }
    }
}

/// Lower median of any numbers, reordering them; `None` for none. O(n).
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_a_short_list() {
        let stats = BinStats::of_sorted(&[1.0, 2.0, 3.0, 4.0, 5.0], 0.25);
        assert_eq!((stats.count, stats.mean, stats.median), (5, 3.0, 3.0));
        assert_eq!((stats.min, stats.quantile), (1.0, 2.0));
        assert_eq!(BinStats::of_sorted(&[], 0.5), BinStats::EMPTY);
        assert_eq!(BinStats::of_sorted(&[7.0], 1.0).quantile, 7.0);
    }

    #[test]
    fn the_median_of_an_even_list_is_the_lower_one() {
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut []), None);
    }
}
