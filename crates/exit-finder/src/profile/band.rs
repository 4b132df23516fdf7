//! Which heights count.

use super::polar::{BLOCK, Block, Eye};
use super::statistics::median_of_bits;
use super::strip::Strip;
use super::survey::Survey;
use crate::config::HeightBand;
use crate::points::PointLike;

/// At which height a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Layer {
    /// At flying height.
    Level,
    /// In the band where it has widened with range.
    Band,
    /// Above the band: a lintel.
    Above,
    /// Below the band: a counter, the floor.
    Below,
}

const LAYERS: [Layer; 4] = [Layer::Level, Layer::Band, Layer::Above, Layer::Below];

impl Layer {
    /// Whether the point is part of the profile.
    pub(crate) fn in_band(self) -> bool {
        matches!(self, Self::Level | Self::Band)
    }
}

/// The heights that count, resolved for one map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Band {
    /// Heights about the strip, map units; `None`: all.
    pub(crate) heights: Option<[f64; 2]>,
    /// How the band leans.
    pub(crate) strip: Strip,
    /// The band is at least this slope wide.
    pub(crate) widening: f64,
}

impl Band {
    /// The band for points with these slopes and ranges, 0 for points without.
    pub(crate) fn of(band: HeightBand, survey: &Survey) -> Self {
        let (strip, widening) = match band {
            HeightBand::Strip(share) => (survey.slopes.strip(), share),
            _ => (Strip::default(), 0.0),
        };
        let heights = match band {
            HeightBand::Off => None,
            HeightBand::Absolute { from, to } => Some([from, to]),
            HeightBand::Relative(share) | HeightBand::Strip(share) => {
                let known = survey.ranges.iter().filter(|&&range| range > 0.0);
                let mut ranges: Vec<u64> = known.map(|range| range.to_bits()).collect();
                let reach = share * median_of_bits(&mut ranges).unwrap_or(0.0);
                Some([-reach, reach])
            }
        };
        Self {
            heights,
            strip,
            widening,
        }
    }

    /// Where a point lies that has this offset from the agent and this height above it.
    #[inline]
    pub(crate) fn layer_of(&self, offset: [f64; 2], range: f64, height: f64) -> Layer {
        let Some(heights) = self.heights else {
            return Layer::Level;
        };
        let height = height - self.strip.height_at(offset, range);
        LAYERS[usize::from(code(height, heights, self.widening * range))]
    }
}

impl Band {
    /// Adds the layers of points with these ranges, 0 for points without a bearing. To the last bit [`Band::layer_of`] of each.
    pub(crate) fn add_layers<P: PointLike>(
        &self,
        points: &[P],
        ranges: &[f64],
        eye: &Eye,
        layers: &mut Vec<Option<Layer>>,
    ) {
        let Some(heights) = self.heights else {
            layers.extend(
                ranges
                    .iter()
                    .map(|&range| (range > 0.0).then_some(Layer::Level)),
            );
            return;
        };
        let mut block = Block::default();
        for (points, ranges) in points.chunks(BLOCK).zip(ranges.chunks(BLOCK)) {
            block.place(eye, points);
            let mut known = [0.0; BLOCK];
            known[..ranges.len()].copy_from_slice(ranges);
            let mut codes = [0u8; BLOCK];
            for k in 0..BLOCK {
                let strip = self.strip.height_at([block.x[k], block.y[k]], known[k]);
                codes[k] = code(block.height[k] - strip, heights, self.widening * known[k]);
            }
            let layer =
                |(&code, &range): (&u8, &f64)| (range > 0.0).then_some(LAYERS[usize::from(code)]);
            layers.extend(codes.iter().zip(ranges).map(layer));
        }
    }
}

/// The place in [`LAYERS`] of a point this high above the middle of the strip. Without branches, which would be mispredicted at every
/// other point.
#[inline]
fn code(height: f64, [from, to]: [f64; 2], widened: f64) -> u8 {
    let level = (height >= from) & (height <= to);
    let band = (height >= from.min(-widened)) & (height <= to.max(widened));
    let outside = 1 + u8::from(!band) * (1 + u8::from(height <= 0.0));
    u8::from(!level) * outside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_lies_at_level_in_the_widened_band_above_or_below() {
        let band = Band {
            heights: Some([-0.5, 0.5]),
            strip: Strip {
                pitch: 0.1,
                tilt: [0.0, 0.2],
            },
            widening: 0.25,
        };
        // Four units towards bearing a quarter turn the middle of the strip is 1.2 up, and the band 1 wide to either side.
        let layer = |height: f64| band.layer_of([0.0, 4.0], 4.0, height);
        assert_eq!(layer(1.2 + 0.49), Layer::Level);
        assert_eq!(layer(1.2 - 0.49), Layer::Level);
        assert_eq!(layer(1.2 + 0.99), Layer::Band);
        assert_eq!(layer(1.2 - 0.99), Layer::Band);
        assert_eq!(layer(1.2 + 1.01), Layer::Above);
        assert_eq!(layer(1.2 - 1.01), Layer::Below);
        // Nearby the band is as wide as its heights say.
        assert_eq!(band.layer_of([0.4, 0.0], 0.4, 0.55), Layer::Above);
        let all = Band {
            heights: None,
            ..band
        };
        assert_eq!(all.layer_of([0.0, 4.0], 4.0, 99.0), Layer::Level);
    }
}
