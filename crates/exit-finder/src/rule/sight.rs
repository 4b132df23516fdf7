//! What was seen per bin, as inverse ranges: in them a wall is linear, and the noise of a triangulated depth is even.
//!
//! The point of a straight wall in direction d lies at inverse range a·d, see [`super::line`]. The error of a depth from
//! parallax grows with the square of the range, which is a constant in the inverse, plus a share of the range.
//! Everything is in units of the median range, so no constant needs a scale.

use crate::config::RangeAware;
use crate::profile::{RangeProfile, Samples};

/// Inverse ranges of one height band, per bin, descending.
struct Layer {
    inverse: Vec<f64>,
    /// Where each bin ends.
    ends: Vec<usize>,
    /// Points that one entry of a bin stands for.
    each: Vec<f64>,
}

impl Layer {
    fn of(samples: &Samples, n: usize, unit: f64) -> Self {
        let (mut inverse, mut ends, mut each) = (Vec::new(), Vec::new(), Vec::new());
        for bin in 0..n {
            let ranges = samples.of(bin);
            let kept = ranges.len().min(MOST);
            let rank = |k: usize| (2 * k + 1) * ranges.len() / (2 * kept);
            inverse.extend((0..kept).map(|k| unit / ranges[rank(k)]));
            ends.push(inverse.len());
            each.push(samples.count(bin) as f64 / kept.max(1) as f64);
        }
        Self {
            inverse,
            ends,
            each,
        }
    }

    fn span(&self, bin: usize) -> std::ops::Range<usize> {
        let start = bin.checked_sub(1).map_or(0, |before| self.ends[before]);
        start..self.ends[bin]
    }
}

/// The profile as the search for walls reads it.
pub(super) struct Sight {
    directions: Vec<[f64; 2]>,
    seen: Layer,
    level: Layer,
    any_height: Layer,
    above: Layer,
    doubtful: Layer,
    /// Share of the doubtful points among all.
    dirt: f64,
    noise: [f64; 2],
}

impl Sight {
    pub(super) fn of(profile: &RangeProfile, rule: &RangeAware) -> Self {
        let n = profile.bins.len();
        let direction = |bin| {
            let (sin, cos) = profile.centre_of(bin).sin_cos();
            [cos, sin]
        };
        Self {
            directions: (0..n).map(direction).collect(),
            seen: Layer::of(&profile.seen, n, profile.median_range),
            level: Layer::of(&profile.level, n, profile.median_range),
            any_height: Layer::of(&profile.any_height, n, profile.median_range),
            above: Layer::of(&profile.above, n, profile.median_range),
            doubtful: Layer::of(&profile.doubtful, n, profile.median_range),
            dirt: dirt(profile),
            noise: rule.noise,
        }
    }

    pub(super) fn n(&self) -> usize {
        self.directions.len()
    }

    /// Unit vector to the middle of a bin.
    pub(super) fn direction(&self, bin: usize) -> [f64; 2] {
        self.directions[bin]
    }

    /// Points of a bin at any height of the band, and how many each entry stands for.
    pub(super) fn seen(&self, bin: usize) -> (&[f64], f64) {
        (&self.seen.inverse[self.seen.span(bin)], self.seen.each[bin])
    }

    /// The same at any height at all.
    pub(super) fn any_height(&self, bin: usize) -> (&[f64], f64) {
        let layer = &self.any_height;
        (&layer.inverse[layer.span(bin)], layer.each[bin])
    }

    /// The same above the band.
    pub(super) fn above(&self, bin: usize) -> (&[f64], f64) {
        let layer = &self.above;
        (&layer.inverse[layer.span(bin)], layer.each[bin])
    }

    /// The same of the points that a cleaning took out.
    pub(super) fn doubtful(&self, bin: usize) -> (&[f64], f64) {
        let layer = &self.doubtful;
        (&layer.inverse[layer.span(bin)], layer.each[bin])
    }

    /// Share of the map that a cleaning took out, 0 if unknown.
    pub(super) fn dirt(&self) -> f64 {
        self.dirt
    }

    /// The same at flying height, with the place of the first entry among all of them.
    pub(super) fn level(&self, bin: usize) -> (&[f64], f64, usize) {
        let span = self.level.span(bin);
        let first = span.start;
        (&self.level.inverse[span], self.level.each[bin], first)
    }

    /// Entries at flying height in all bins.
    pub(super) fn level_entries(&self) -> usize {
        self.level.inverse.len()
    }

    /// Standard deviation of an inverse range.
    pub(super) fn sigma(&self, inverse: f64) -> f64 {
        self.noise[0] * inverse + self.noise[1]
    }

    /// What still lies on a wall seen at this inverse range.
    pub(super) fn tolerance(&self, inverse: f64) -> f64 {
        SIGMAS * self.sigma(inverse.max(0.0))
    }
}

fn dirt(profile: &RangeProfile) -> f64 {
    let count = |samples: &Samples| (0..profile.bins.len()).map(|bin| samples.count(bin)).sum();
    let [all, doubtful]: [usize; 2] = [count(&profile.any_height), count(&profile.doubtful)];
    doubtful as f64 / all.max(1) as f64
}

/// A point this many standard deviations away does not lie on a wall.
const SIGMAS: f64 = 2.5;
/// Entries that are kept of a bin, evenly spaced: twice as many as it has votes.
const MOST: usize = 8;
