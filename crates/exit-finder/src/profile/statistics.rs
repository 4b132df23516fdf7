//! Count, mean, median, minimum and a low quantile of the ranges in one bin.
//!
//! Ranges are positive, so their bit patterns are ordered as they are and are sorted as integers.
//! Sums run over fixed point, which is associative: no result depends on the order of the points.

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

    /// Statistics of the ascending ranges of one bin, given as bit patterns. O(n).
    pub(crate) fn of_sorted(ranges: &[u64], quantile: f64) -> Self {
        let Some(last) = ranges.len().checked_sub(1) else {
            return Self::EMPTY;
        };
        let rank = ((last as f64 * quantile) as usize).min(last);
        Self {
            count: ranges.len(),
            mean: mean(ranges.iter().copied()),
            median: f64::from_bits(ranges[last / 2]),
            min: f64::from_bits(ranges[0]),
            quantile: f64::from_bits(ranges[rank]),
        }
    }
}

/// So many numbers below 2⁴¹ are summed in 64 bits.
const FITTING: u64 = 1 << 22;

/// Mean of positive numbers given as bit patterns, in fixed point of 2⁻⁴⁰ of the largest.
pub(crate) fn mean(ranges: impl Iterator<Item = u64> + Clone) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let largest = ranges.clone().max().unwrap_or(0);
    // Below this size, 10⁻²⁷⁰, the inverse would overflow.
    let power = f64::from_bits((largest & EXPONENT).max(0x080 << 52));
    let unit = power * (-40f64).exp2();
    let inverse = 1.0 / unit;
    // Each is below 2⁴¹, so some millions of them fit into 64 bits. By way of i64, which takes half the instructions of u64.
    let (mut sum, mut part, mut count) = (0u128, 0u64, 0u64);
    for bits in ranges {
        part += (f64::from_bits(bits) * inverse) as i64 as u64;
        count += 1;
        if count.is_multiple_of(FITTING) {
            sum += u128::from(std::mem::take(&mut part));
        }
    }
    sum += u128::from(part);
    sum as f64 * unit / count.max(1) as f64
}

/// Lower median of positive numbers given as bit patterns, reordering them; `None` for none. O(n).
pub(crate) fn median_of_bits(values: &mut [u64]) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    Some(f64::from_bits(*values.select_nth_unstable(middle).1))
}

/// Lower median of any numbers, reordering them; `None` for none. O(n).
pub(crate) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len().checked_sub(1)? / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64], quantile: f64) -> BinStats {
        let mut bits: Vec<u64> = values.iter().map(|v| v.to_bits()).collect();
        bits.sort_unstable();
        BinStats::of_sorted(&bits, quantile)
    }

    #[test]
    fn statistics_of_a_short_list() {
        let stats = of(&[4.0, 2.0, 5.0, 1.0, 3.0], 0.25);
        assert_eq!((stats.count, stats.mean, stats.median), (5, 3.0, 3.0));
        assert_eq!((stats.min, stats.quantile), (1.0, 2.0));
        assert_eq!(of(&[], 0.5), BinStats::EMPTY);
        assert_eq!(of(&[7.0], 1.0).quantile, 7.0);
    }

    #[test]
    fn tiny_and_huge_ranges_have_a_mean() {
        assert!(of(&[1e-300, 2e-300], 0.5).mean.is_finite());
        assert!((of(&[1e300, 3e300], 0.5).mean / 2e300 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_median_of_an_even_list_is_the_lower_one() {
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut []), None);
    }
}
