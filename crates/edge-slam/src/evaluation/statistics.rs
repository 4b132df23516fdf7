//! Summary of a list of errors.

/// Root mean square, mean, median, deviation and extremes of a list of errors, in the errors' unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorStatistics {
    /// √(Σ e² / n).
    pub rmse: f64,
    /// Σ e / n.
    pub mean: f64,
    /// Middle value; mean of the two middle ones for even n.
    pub median: f64,
    /// Population deviation (divided by n), so that rmse² = mean² + std².
    pub std: f64,
    /// Smallest.
    pub min: f64,
    /// Greatest.
    pub max: f64,
}

impl ErrorStatistics {
    /// The summary of `errors`, or `None` when there are none. Cost: O(n log n).
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "counts of samples stay far below 2^53"
    )]
    pub fn of(errors: &[f64]) -> Option<Self> {
        let mut sorted = errors.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let n = sorted.len() as f64;
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 {
            sorted[middle]
        } else {
            0.5 * (sorted[middle - 1] + sorted[middle])
        };
        let mean = sorted.iter().sum::<f64>() / n;
        let square = sorted.iter().map(|e| e * e).sum::<f64>() / n;
        let variance = sorted.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / n;
        Some(Self {
            rmse: square.sqrt(),
            mean,
            median,
            std: variance.sqrt(),
            min,
            max,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn nothing_has_no_summary() {
        assert_eq!(ErrorStatistics::of(&[]), None);
    }

    proptest! {
        #[test]
        fn pythagoras_holds(errors in prop::collection::vec(0.0..10.0f64, 1..50)) {
            let s = ErrorStatistics::of(&errors).unwrap();
            prop_assert!((s.rmse.powi(2) - s.mean.powi(2) - s.std.powi(2)).abs() < 1e-9);
            prop_assert!(s.min <= s.median && s.median <= s.max);
        }
    }
}
