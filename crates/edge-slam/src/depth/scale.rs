//! Scale of predicted depth against triangulated depth, and whether the prediction is worth anything.

use super::DepthError;

/// reference ≈ scale · predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthFit {
    /// Reference units per predicted unit: the median ratio, polished by Cauchy-weighted least squares of logarithms.
    pub scale: f64,
    /// Correlation of the logarithms, −1..=1: a constant prediction has 0.
    pub correlation: f64,
    /// Median of |log(reference / (scale · predicted))|: 0.1 means 10 %.
    pub spread: f64,
    /// Pairs used.
    pub pairs: usize,
}

impl DepthFit {
    /// Whether the prediction says more than a constant would: correlation at least `least` (0.5 is usual).
    #[must_use]
    pub fn passes(&self, least: f64) -> bool {
        self.correlation >= least
    }
}

/// Fewest pairs of a fit.
const FEWEST: usize = 20;

/// Fits one scale to pairs of predicted and reference depth, `NaN` and values that are not positive left out.
///
/// Just under half of the pairs may be wrong. The correlation is that of all pairs: wrong ones lower it. Cost: O(n log n).
///
/// # Errors
/// [`DepthError::TooFewPairs`] under 20 usable pairs; [`DepthError::Size`] for slices of different length.
///
/// ```
/// use edge_slam::depth::fit_depth;
/// let predicted: Vec<f64> = (1..40).map(f64::from).collect();
/// let reference: Vec<f64> = predicted.iter().map(|d| 0.5 * d).collect();
/// let fit = fit_depth(&predicted, &reference)?;
/// assert!((fit.scale - 0.5).abs() < 1e-9 && fit.passes(0.99));
/// # Ok::<(), edge_slam::depth::DepthError>(())
/// ```
pub fn fit_depth(predicted: &[f64], reference: &[f64]) -> Result<DepthFit, DepthError> {
    if predicted.len() != reference.len() {
        let (width, found) = (predicted.len(), reference.len());
        return Err(DepthError::Size {
            width,
            height: 1,
            needed: width,
            found,
        });
    }
    let usable = |d: f64| d > 0.0 && d.is_finite();
    let logs: Vec<[f64; 2]> = predicted
        .iter()
        .zip(reference)
        .filter(|&(&p, &r)| usable(p) && usable(r))
        .map(|(p, r)| [p.ln(), r.ln()])
        .collect();
    if logs.len() < FEWEST {
        return Err(DepthError::TooFewPairs {
            pairs: logs.len(),
            needed: FEWEST,
        });
    }
    let mut shift = median(logs.iter().map(|[p, r]| r - p).collect());
    let spread = |shift: f64| median(logs.iter().map(|[p, r]| (r - p - shift).abs()).collect());
    let width = (2.0 * spread(shift)).max(1e-6);
    for _ in 0..10 {
        let (mut sum, mut total) = (0.0, 0.0);
        for [p, r] in &logs {
            let residual = r - p - shift;
            let weight = 1.0 / (1.0 + (residual / width).powi(2));
            sum += weight * residual;
            total += weight;
        }
        shift += sum / total;
    }
    Ok(DepthFit {
        scale: shift.exp(),
        correlation: correlation(&logs),
        spread: spread(shift),
        pairs: logs.len(),
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[expect(clippy::cast_precision_loss, reason = "counts of pairs are small")]
fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let n = pairs.len() as f64;
    let mean = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<f64>() / n;
    let (a, b) = (mean(0), mean(1));
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    for [p, r] in pairs {
        aa += (p - a) * (p - a);
        ab += (p - a) * (r - b);
        bb += (r - b) * (r - b);
    }
    let product = aa * bb;
    if product > 1e-18 {
        ab / product.sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn outliers_do_not_move_the_scale(
            scale in 0.2..5.0f64, depths in prop::collection::vec(0.5..8.0f64, 40..80),
        ) {
            let reference: Vec<f64> = depths.iter().enumerate()
                .map(|(k, d)| if k % 4 == 0 { 90.0 } else { d * scale })
                .collect();
            let fit = fit_depth(&depths, &reference)?;
            prop_assert!((fit.scale / scale - 1.0).abs() < 0.05, "{} {}", fit.scale, scale);
        }
    }

    #[test]
    fn a_constant_prediction_does_not_pass() {
        let reference: Vec<f64> = (1..50).map(f64::from).collect();
        let fit = fit_depth(&[2.0; 49], &reference).unwrap();
        assert!(!fit.passes(0.5));
        assert_eq!(fit.correlation, 0.0);
        assert!(fit_depth(&[f64::NAN; 49], &reference).is_err());
        assert!(fit_depth(&[1.0; 3], &reference).is_err());
    }
}
