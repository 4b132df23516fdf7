//! One pass over the points: their ranges and bins, and a histogram of their slopes.
//!
//! Twelve bytes a point are kept. What else is needed to tell the layer, offset and height, is projected again in a
//! second pass, which costs less than to write it to memory and to read it back.

use super::PointCounts;
use super::band::{Band, Layer};
use super::edges::Edges;
use super::polar::{BLOCK, Block, Eye};
use super::strip::Slopes;
use crate::points::PointLike;

/// What the first pass keeps. Entry i belongs to the i-th point.
pub(crate) struct Survey {
    /// 0 for points without a bearing.
    pub(crate) ranges: Vec<f64>,
    pub(crate) bins: Vec<u32>,
    pub(crate) slopes: Slopes,
}

impl Survey {
    /// Looks at the points, and counts those without a bearing in `counts`.
    pub(crate) fn of<P: PointLike>(
        kept: &[P],
        doubtful: &[[f64; 3]],
        (eye, edges): (&Eye, &Edges),
        counts: &mut PointCounts,
    ) -> Self {
        let given = kept.len() + doubtful.len();
        let mut survey = Self {
            ranges: Vec::with_capacity(given),
            bins: Vec::with_capacity(given),
            slopes: Slopes::new(edges.n()),
        };
        survey.add(kept, eye, edges, counts);
        survey.add(doubtful, eye, edges, counts);
        survey
    }

    fn add<P: PointLike>(
        &mut self,
        points: &[P],
        eye: &Eye,
        edges: &Edges,
        counts: &mut PointCounts,
    ) {
        let mut block = Block::default();
        for points in points.chunks(BLOCK) {
            block.look(eye, points);
            let mut bins = [0; BLOCK];
            for (k, bin) in bins.iter_mut().enumerate().take(points.len()) {
                if block.has_bearing(k, counts) {
                    *bin = edges.bin_of([block.x[k], block.y[k]]) as u32;
                    self.slopes.add(*bin, block.slope[k]);
                } else {
                    block.range[k] = 0.0;
                }
            }
            self.bins.extend_from_slice(&bins[..points.len()]);
            self.ranges.extend_from_slice(&block.range[..points.len()]);
        }
    }

    /// The layer of each point, `None` for those without a bearing; the points as they were given to [`Survey::of`].
    pub(crate) fn layers<P: PointLike>(
        &self,
        kept: &[P],
        doubtful: &[[f64; 3]],
        eye: &Eye,
        band: &Band,
    ) -> Vec<Option<Layer>> {
        let mut layers = Vec::with_capacity(self.ranges.len());
        let (of_kept, of_doubtful) = self.ranges.split_at(kept.len());
        band.add_layers(kept, of_kept, eye, &mut layers);
        band.add_layers(doubtful, of_doubtful, eye, &mut layers);
        layers
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::HeightBand;
    use crate::plane::AffinePlane;

    #[test]
    fn points_in_blocks_are_to_the_last_bit_those_looked_at_one_by_one() {
        let agent = [0.3, -0.2, 0.1];
        let plane = AffinePlane::from_up([0.2, -0.1, 1.0], agent).unwrap();
        let eye = Eye::new(agent, &plane).unwrap();
        let edges = Edges::new(360);
        let mut points: Vec<[f64; 3]> = (0..1000)
            .map(|k| f64::from(k) * 0.7)
            .map(|t| [3.0 * t.sin(), 2.0 * (1.3 * t).cos(), (0.4 * t).sin()])
            .collect();
        points[70] = agent;
        points[71] = [f64::NAN, 0.0, 0.0];
        points[200] = [0.0, f64::INFINITY, 0.0];
        points[201] = [f64::MAX, f64::MAX, 0.0];
        let (kept, doubtful) = points.split_at(333);
        let (mut counts, mut expected) = (PointCounts::default(), PointCounts::default());
        let survey = Survey::of(kept, doubtful, (&eye, &edges), &mut counts);
        for band in [HeightBand::Strip(0.25), HeightBand::Off] {
            let band = Band::of(band, &survey);
            let layers = survey.layers(kept, doubtful, &eye, &band);
            assert_eq!(layers.len(), points.len());
            expected = PointCounts::default();
            for (k, &point) in points.iter().enumerate() {
                let polar = eye.look(point, &edges, &mut expected);
                assert_eq!(survey.ranges[k], polar.map_or(0.0, |p| p.range), "{k}");
                assert_eq!(survey.bins[k], polar.map_or(0, |p| p.bin), "{k}");
                let layer = polar.map(|p| band.layer_of(p.offset, p.range, p.height));
                assert_eq!(layers[k], layer, "{k}");
            }
        }
        assert_eq!(counts, expected);
        assert_eq!((counts.at_agent, counts.non_finite), (1, 3));
    }
}
