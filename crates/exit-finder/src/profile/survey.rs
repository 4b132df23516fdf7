//! One pass over the points: their ranges and bins, and a histogram of their slopes.
//!
//! Twelve bytes a point are kept. What else is needed to tell the layer, offset and height, is projected again in a
//! second pass, which costs less than to write it to memory and to read it back.

use super::PointCounts;
use super::band::{Band, Layer};
use super::edges::Edges;
use super::polar::Eye;
use super::strip::Slopes;

/// What the first pass keeps. Entry i belongs to the i-th point.
pub(crate) struct Survey {
    /// 0 for points without a bearing.
    pub(crate) ranges: Vec<f64>,
    pub(crate) bins: Vec<u32>,
    pub(crate) slopes: Slopes,
}

impl Survey {
    /// Looks at the points, and counts those without a bearing in `counts`.
    pub(crate) fn of(
        points: impl Iterator<Item = [f64; 3]>,
        (eye, edges): (&Eye, &Edges),
        n: usize,
        counts: &mut PointCounts,
    ) -> Self {
        let mut survey = Self {
            ranges: Vec::with_capacity(counts.given),
            bins: Vec::with_capacity(counts.given),
            slopes: Slopes::new(n),
        };
        for point in points {
            let polar = eye.look(point, edges, counts);
            survey.ranges.push(polar.map_or(0.0, |p| p.range));
            survey.bins.push(polar.map_or(0, |p| p.bin));
            if let Some(p) = polar {
                survey.slopes.add(p.bin, p.height / p.range);
            }
        }
        survey
    }

    /// The layer of each point, `None` for those without a bearing.
    pub(crate) fn layers(
        &self,
        points: impl Iterator<Item = [f64; 3]>,
        eye: &Eye,
        band: &Band,
    ) -> Vec<Option<Layer>> {
        let layer = |(point, &range): ([f64; 3], &f64)| {
            let (offset, height) = eye.offset(point);
            (range > 0.0).then(|| band.layer_of(offset, range, height))
        };
        points.zip(&self.ranges).map(layer).collect()
    }

    /// The ranges of the points in the band, as bit patterns.
    pub(crate) fn in_band(&self, layers: &[Option<Layer>]) -> Vec<u64> {
        let mut ranges = vec![0; layers.len()];
        let mut len = 0;
        // Written always and kept where it counts: without a branch that random heights would mispredict.
        for (range, layer) in self.ranges.iter().zip(layers) {
            ranges[len] = range.to_bits();
            len += usize::from(layer.is_some_and(Layer::in_band));
        }
        ranges.truncate(len);
        ranges
    }
}
