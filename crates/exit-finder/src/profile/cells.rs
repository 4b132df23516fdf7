//! Counting into bins: statistics, and a sample of the ranges in each bin.

use super::band::Layer;
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
    /// All points, those outside the band as well.
    pub(crate) any_height: Samples,
    /// Those above the band.
    pub(crate) above: Samples,
}

impl Cells {
    /// Statistics of points given as (bin, layer, range). O(n log(n / bins)).
    pub(crate) fn of(
        n: usize,
        quantile: f64,
        points: impl Iterator<Item = (usize, Layer, f64)> + Clone,
    ) -> Self {
        let cell = |bin: usize, layer: Layer| 4 * bin + layer as usize;
        let mut ends = vec![0usize; 4 * n + 1];
        for (bin, layer, _) in points.clone() {
            ends[cell(bin, layer) + 1] += 1;
        }
        for cell in 0..4 * n {
            ends[cell + 1] += ends[cell];
        }
        let mut cursor = ends.clone();
        let mut ranges = vec![0u64; ends[4 * n]];
        for (bin, layer, range) in points {
            let slot = &mut cursor[cell(bin, layer)];
            ranges[*slot] = range.to_bits();
            *slot += 1;
        }
        let mut cells = Self::with_capacity(n);
        let mut merged = Vec::new();
        for bin in 0..n {
            let span = |layer: Layer| ends[cell(bin, layer)]..ends[cell(bin, layer) + 1];
            let [level, band, above] = [Layer::Level, Layer::Band, Layer::Above].map(span);
            let outside = above.start..span(Layer::Below).end;
            for part in [&level, &band, &above] {
                ranges[part.clone()].sort_unstable();
            }
            cells.level.push_sorted(&ranges[level.clone()]);
            cells.above.push_sorted(&ranges[above]);
            ranges[outside.clone()].sort_unstable();
            merge(&ranges[level], &ranges[band], &mut merged);
            cells.any_height.push_union(&merged, &ranges[outside]);
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
            any_height: Samples::with_capacity(n),
            above: Samples::with_capacity(n),
        }
    }
}

/// Merges two ascending lists. Without branches that depend on the ranges, which would be mispredicted half the time.
fn merge(a: &[u64], b: &[u64], merged: &mut Vec<u64>) {
    merged.clear();
    merged.resize(a.len() + b.len(), 0);
    let (mut i, mut j) = (0, 0);
    for slot in merged.iter_mut() {
        let first = a.get(i).copied().unwrap_or(u64::MAX);
        let second = b.get(j).copied().unwrap_or(u64::MAX);
        let is_first = first <= second && i < a.len();
        *slot = if is_first { first } else { second };
        i += usize::from(is_first);
        j += usize::from(!is_first);
    }
}
