//! The mean distance to the nearest neighbours, divided by viewing ranges: what the metric alone is worth.

use submodular_minimax::Views;

/// Pairs of points are all looked at, so larger clouds are left out.
pub(crate) const MOST_POINTS: usize = 20_000;

/// Mean over the `k` nearest of ‖u − v‖ / √(r_u r_v), r the median distance to the observing cameras.
///
/// Points that nobody observes have the median range. Cost: O(n²).
pub(crate) fn mean_distances(points: &[[f64; 3]], views: &Views, k: usize) -> Vec<f64> {
    let mut ranges: Vec<f64> = (0..points.len())
        .map(|v| {
            let cameras = views.observers(v).map(|c| views.viewpoints()[c]);
            median(cameras.map(|c| squared(c, points[v]).sqrt()).collect())
        })
        .collect();
    let typical = median(ranges.iter().copied().filter(|r| r.is_finite()).collect());
    for range in &mut ranges {
        let known = if range.is_finite() { *range } else { typical };
        // A camera inside a point would make its distances infinite.
        *range = known.max(1e-3 * typical);
    }
    let mean = |v: usize| {
        let others = (0..points.len()).filter(|&u| u != v);
        let mut all: Vec<f64> = others
            .map(|u| squared(points[u], points[v]) / (ranges[u] * ranges[v]))
            .collect();
        let k = k.min(all.len());
        if k == 0 {
            return 0.0;
        }
        all.select_nth_unstable_by(k - 1, f64::total_cmp);
        all[..k].iter().map(|d| d.sqrt()).sum::<f64>() / k as f64
    };
    (0..points.len()).map(mean).collect()
}

/// The points above mean + `ratio` deviations, as SOR cuts.
pub(crate) fn above_deviations(values: &[f64], ratio: f64) -> Vec<usize> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n.max(1.0);
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    let cut = mean + ratio * (squares / (n - 1.0).max(1.0)).sqrt();
    (0..values.len()).filter(|&v| values[v] > cut).collect()
}

/// NaN without values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.as_slice() {
        [] => f64::NAN,
        sorted => 0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2]),
    }
}

fn squared(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}
