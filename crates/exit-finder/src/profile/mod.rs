//! The range profile: what lies how far in which direction, in `n` angular bins.
//!
//! Bins are half-open, `[i·2π/n, (i+1)·2π/n)`, numbered from 0 at the plane's first axis, and they
//! close into a circle.

mod band;
mod binning;
mod cells;
mod edges;
mod live;
mod polar;
mod running_median;
mod samples;
mod statistics;
mod strip;
mod survey;

pub(crate) use edges::Edges;
pub use live::LiveProfile;
pub(crate) use polar::Eye;
pub(crate) use samples::Samples;
pub use statistics::BinStats;
pub(crate) use statistics::median;
pub use strip::Strip;

use std::f64::consts::TAU;

use crate::angle::wrap;
use crate::plane::AffinePlane;
use crate::vector::{add, scale};

/// Range statistics per angular bin around one position.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeProfile {
    /// The plane whose coordinates the bearings refer to.
    pub plane: AffinePlane,
    /// Where the ranges start, world.
    pub agent: [f64; 3],
    /// One entry per bin, `bins[0]` starts at bearing 0.
    pub bins: Vec<BinStats>,
    /// Ranges of the points in each bin.
    pub(crate) seen: Samples,
    /// Those at flying height: where the band widens with range, the points before it widened.
    pub(crate) level: Samples,
    /// All points, those outside the band as well: what is seen behind a wall is seen through an opening, however high.
    pub(crate) any_height: Samples,
    /// Those above the band.
    pub(crate) above: Samples,
    /// Points that a cleaning took out, at any height; see [`RangeProfile::of_cleaned`].
    pub(crate) doubtful: Samples,
    /// Mean range of all points in the profile, virtual ones left out, map units.
    pub mean_range: f64,
    /// Lower median of the same ranges, map units.
    pub median_range: f64,
    /// The paper's `r` under the configured reading: [`Self::mean_range`], or the mean distance
    /// from the plane's origin.
    pub radius: f64,
    /// The band that was used, heights above the agent in map units; `None`: all heights.
    pub band: Option<[f64; 2]>,
    /// The band reaches this slope at least, in either direction.
    pub(crate) widening: f64,
    /// How the band leans; level unless the band is [`crate::HeightBand::Strip`].
    pub strip: Strip,
    /// What happened to the points.
    pub counts: PointCounts,
}

/// How many points went where.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PointCounts {
    /// Points given, without the virtual ones.
    pub given: usize,
    /// Points in the profile, without the virtual ones.
    pub used: usize,
    /// Skipped: a coordinate is NaN or infinite.
    pub non_finite: usize,
    /// Skipped: at the agent, bearing undefined.
    pub at_agent: usize,
    /// Skipped: outside the height band.
    pub outside_band: usize,
    /// Used points that a virtual point hides; they are not in any bin.
    pub hidden: usize,
    /// Virtual points in the profile.
    pub virtual_used: usize,
}

impl RangeProfile {
    /// Width of a bin, radians.
    pub fn bin_width(&self) -> f64 {
        TAU / self.bins.len() as f64
    }

    /// The bearing at which a bin starts, radians in `[0, 2π)`.
    pub fn start_of(&self, bin: usize) -> f64 {
        (bin % self.bins.len()) as f64 * self.bin_width()
    }

    /// The bearing in the middle of a bin, radians in `[0, 2π)`.
    pub fn centre_of(&self, bin: usize) -> f64 {
        ((bin % self.bins.len()) as f64 + 0.5) * self.bin_width()
    }

    /// The bin of a bearing; any finite angle is wrapped.
    pub fn bin_of(&self, bearing: f64) -> usize {
        ((wrap(bearing) / self.bin_width()) as usize).min(self.bins.len() - 1)
    }

    /// The point `range` away from the agent in a bearing, at the agent's height, world.
    pub fn at(&self, bearing: f64, range: f64) -> [f64; 3] {
        add(self.agent, scale(self.direction(bearing), range))
    }

    /// Unit vector of a bearing, world.
    pub fn direction(&self, bearing: f64) -> [f64; 3] {
        self.plane.direction([bearing.cos(), bearing.sin()])
    }

    /// Whether a point lies in the height band, that is whether it could be part of the profile.
    pub fn holds(&self, point: [f64; 3]) -> bool {
        let (q, centre) = (self.plane.project(point), self.plane.project(self.agent));
        let offset = [q[0] - centre[0], q[1] - centre[1]];
        let range = offset[0].hypot(offset[1]);
        let height = self.plane.height(point) - self.plane.height(self.agent);
        let height = height - self.strip.height_at(offset, range);
        let widened = self.widening * range;
        let within =
            |[from, to]: [f64; 2]| height >= from.min(-widened) && height <= to.max(widened);
        self.band.is_none_or(within)
    }

    /// The end of a bin's spoke at its mean range, as the paper's figure draws it; `None` when the
    /// bin is empty.
    pub fn spoke(&self, bin: usize) -> Option<[f64; 3]> {
        let stats = self.bins.get(bin)?;
        (stats.count > 0).then(|| self.at(self.centre_of(bin), stats.mean))
    }
}
