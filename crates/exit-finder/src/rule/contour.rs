//! The wall as the agent sees it, and how it would go on behind an edge if the room were convex.
//!
//! In a convex room the wall between two edges lies between two bounds: it is never nearer than the
//! straight line between the edges (the chord), and never farther than the walls beside the edges,
//! continued. What lies beyond both was seen through an opening.

use super::line::Line;
use super::smoothing::smoothed;
use crate::profile::{RangeProfile, median};

/// The smoothed profile, prepared for asking about sectors.
pub(super) struct Contour {
    /// Robust range per bin, `None` where nothing was seen.
    pub(super) ranges: Vec<Option<f64>>,
    /// Unit vector to the middle of each bin.
    directions: Vec<[f64; 2]>,
    /// Robust range of the wall in the `side` bins from bin i on, and the bin where it lies.
    pieces: Vec<Option<(usize, f64)>>,
    /// The wall that ends before bin i, and the wall that starts at bin i, as fitted lines.
    ending: Vec<Option<[Line; 2]>>,
    starting: Vec<Option<[Line; 2]>>,
    side: usize,
}

impl Contour {
    /// `half` and `side` in bins: half window of the smoothing, length of a piece of wall.
    pub(super) fn new(profile: &RangeProfile, half: usize, side: usize, min_count: usize) -> Self {
        let ranges = smoothed(profile, half, min_count);
        let n = ranges.len();
        let side = side.clamp(1, n);
        let directions: Vec<[f64; 2]> = (0..n)
            .map(|bin| profile.centre_of(bin).sin_cos())
            .map(|(sin, cos)| [cos, sin])
            .collect();
        let pieces: Vec<_> = (0..n)
            .map(|bin| piece_of_wall(&ranges, bin, side))
            .collect();
        let point = |bin: usize| {
            pieces[bin % n].map(|(at, range): (usize, f64)| directions[at].map(|x| x * range))
        };
        let starting = (0..n)
            .map(|bin| lines([0, 1, 2].map(|k| point(bin + k * side))))
            .collect();
        let ending = (0..n)
            .map(|bin| lines([1, 2, 3].map(|k| point(bin + 3 * n - k * side))))
            .collect();
        Self {
            ranges,
            directions,
            pieces,
            ending,
            starting,
            side,
        }
    }

    pub(super) fn n(&self) -> usize {
        self.ranges.len()
    }

    /// Unit vector to the middle of a bin.
    pub(super) fn direction(&self, bin: usize) -> [f64; 2] {
        self.directions[bin % self.n()]
    }

    /// Median range of the known bins of a run, or `None`.
    pub(super) fn median_range(&self, start: usize, len: usize) -> Option<f64> {
        let n = self.n();
        let known = (start..start + len).filter_map(|bin| self.ranges[bin % n]);
        median(&mut known.collect::<Vec<f64>>())
    }

    /// Ranges of the wall just outside a run, at its start and at its end; where one side was not
    /// seen, that of the other.
    pub(super) fn jamb_ranges(&self, start: usize, len: usize) -> Option<[f64; 2]> {
        let n = self.n();
        let first = self.pieces[(start + n - self.side) % n].map(|(_, range)| range);
        let last = self.pieces[(start + len) % n].map(|(_, range)| range);
        Some([first.or(last)?, last.or(first)?])
    }

    /// The wall that a convex room would have in a run; `None` when the wall on one side was
    /// not seen: half an opening at the border of a scan is not judged.
    pub(super) fn expectation(&self, start: usize, len: usize) -> Option<Expectation> {
        let n = self.n();
        let first = self.pieces[(start + n - self.side) % n]?.1;
        let last = self.pieces[(start + len) % n]?.1;
        let [p, q] = [(start + n - 1, first), (start + len, last)]
            .map(|(bin, range)| self.direction(bin).map(|x| x * range));
        let (before, after) = (self.ending[start % n], self.starting[(start + len) % n]);
        let chord = Line::through(p, q)?;
        let known = before.is_some() || after.is_some();
        let width = (p[0] - q[0]).hypot(p[1] - q[1]);
        known.then_some(Expectation {
            chord,
            width,
            before,
            after,
        })
    }
}

/// Bounds of the wall in a run.
pub(super) struct Expectation {
    /// The straight line between the jambs.
    pub(super) chord: Line,
    /// Distance between the jambs.
    pub(super) width: f64,
    before: Option<[Line; 2]>,
    after: Option<[Line; 2]>,
}

impl Expectation {
    /// Inverse of the range that lies behind the line between the jambs and behind the walls on both sides,
    /// continued; zero or less where one of them is never met.
    pub(super) fn inverse_farther(&self, direction: [f64; 2]) -> f64 {
        let sides = [self.before, self.after].into_iter().flatten();
        sides
            .map(|lines| inverse_of_side(&lines, direction))
            .fold(self.chord.inverse_range(direction), f64::min)
    }

    /// Inverse of the farthest range at which a convex room's wall could be seen in a direction.
    pub(super) fn inverse_range(&self, direction: [f64; 2]) -> f64 {
        let sides = [self.before, self.after].into_iter().flatten();
        let nearer = sides
            .map(|lines| inverse_of_side(&lines, direction))
            .fold(0.0, f64::max);
        nearer.min(self.chord.inverse_range(direction))
    }
}

/// Of the two readings of a wall, the farther one.
fn inverse_of_side(lines: &[Line; 2], direction: [f64; 2]) -> f64 {
    lines[0]
        .inverse_range(direction)
        .min(lines[1].inverse_range(direction))
}

/// The lines through the nearest piece of a wall and each of the next two; the same twice where only one is
/// known.
fn lines([near, middle, far]: [Option<[f64; 2]>; 3]) -> Option<[Line; 2]> {
    let to = |other: Option<[f64; 2]>| near.zip(other).and_then(|(p, q)| Line::through(p, q));
    let (first, second) = (to(middle), to(far));
    Some([first.or(second)?, second.or(first)?])
}

/// Median range of the known bins among `side` from `start` on, at the middle one of them.
fn piece_of_wall(ranges: &[Option<f64>], start: usize, side: usize) -> Option<(usize, f64)> {
    let n = ranges.len();
    let known = || {
        (start..start + side)
            .map(|i| i % n)
            .filter(|&i| ranges[i].is_some())
    };
    let middle = known().nth(known().count().checked_sub(1)? / 2)?;
    let range = median(&mut known().filter_map(|i| ranges[i]).collect::<Vec<_>>())?;
    Some((middle, range))
}
