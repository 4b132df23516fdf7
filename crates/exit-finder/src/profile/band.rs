//! Which heights count.

use super::polar::Polar;
use super::statistics::median_of_bits;
use super::strip::Strip;
use crate::config::HeightBand;

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
    /// The band for points in `n` bins.
    pub(crate) fn of(band: HeightBand, points: &[Polar], n: usize) -> Self {
        let (strip, widening) = match band {
            HeightBand::Strip(share) => (Strip::of(points, n), share),
            _ => (Strip::default(), 0.0),
        };
        let heights = match band {
            HeightBand::Off => None,
            HeightBand::Absolute { from, to } => Some([from, to]),
            HeightBand::Relative(share) | HeightBand::Strip(share) => {
                let mut ranges: Vec<u64> = points.iter().map(|p| p.range.to_bits()).collect();
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

    /// Whether a point lies at flying height, `None` outside the band.
    #[inline]
    pub(crate) fn level_of(&self, p: &Polar) -> Option<bool> {
        let Some([from, to]) = self.heights else {
            return Some(true);
        };
        let height = p.height - self.strip.height_at(p.offset, p.range);
        let widened = self.widening * p.range;
        let inside = height >= from.min(-widened) && height <= to.max(widened);
        inside.then_some(height >= from && height <= to)
    }
}
