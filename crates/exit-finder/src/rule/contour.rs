//! The room's outline as the agent sees it: a robust range per bin, and the wall beside an empty run.

use super::smoothing::smoothed;
use crate::profile::{RangeProfile, median};

/// The smoothed profile.
pub(super) struct Contour {
    /// Robust range per bin, `None` where nothing was seen.
    pub(super) ranges: Vec<Option<f64>>,
    /// Length of a piece of wall beside a run, bins.
    side: usize,
}

impl Contour {
    /// `half` and `side` in bins: half window of the smoothing, length of a piece of wall.
    pub(super) fn new(profile: &RangeProfile, half: usize, side: usize, min_count: usize) -> Self {
        let ranges = smoothed(profile, half, min_count);
        let side = side.clamp(1, ranges.len());
        Self { ranges, side }
    }

    pub(super) fn n(&self) -> usize {
        self.ranges.len()
    }

    /// Ranges of the wall just outside a run, at its start and at its end; where one side was not
    /// seen, that of the other.
    pub(super) fn jamb_ranges(&self, start: usize, len: usize) -> Option<[f64; 2]> {
        let first = self.piece(start + self.n() - self.side);
        let last = self.piece(start + len);
        Some([first.or(last)?, last.or(first)?])
    }

    /// Median range of the known bins in a piece of wall.
    fn piece(&self, start: usize) -> Option<f64> {
        let known = (start..start + self.side).filter_map(|bin| self.ranges[bin % self.n()]);
        median(&mut known.collect::<Vec<_>>())
    }
}
