//! Which heights count.

use super::statistics::median_of_bits;
use super::strip::Strip;
use super::survey::Survey;
use crate::config::HeightBand;

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
        let Some([from, to]) = self.heights else {
            return Layer::Level;
        };
        let height = height - self.strip.height_at(offset, range);
        let widened = self.widening * range;
        let level = height >= from && height <= to;
        let band = height >= from.min(-widened) && height <= to.max(widened);
        // A look-up instead of branches, which would be mispredicted at every other point.
        let outside = 1 + usize::from(!band) * (1 + usize::from(height <= 0.0));
        LAYERS[usize::from(!level) * outside]
    }
}
