//! Openings in walls: stretches of a straight wall through which points are seen, from jamb to jamb.
//!
//! Along a wall each bin has a value: votes through it, less votes on it and a few of those before it. The stretch of
//! the largest sum is a candidate, then the next one beside it, while they are worth anything (Bentley's maximal
//! subarray). Its jambs are the nearest bins outside it that show the wall. O(bins) per wall and candidate.

use super::cues::{CUES, Cues};
use super::sight::Sight;
use super::wall::{Votes, Wall};
use crate::config::RangeAware;
use crate::profile::RangeProfile;
use crate::sector::{Run, Sector};

/// A stretch of a wall that may be an opening, with everything its probability is computed from.
#[derive(Debug, Clone, PartialEq)]
pub struct Opening {
    /// From jamb to jamb.
    pub sector: Sector,
    /// Distance between the jambs, map units.
    pub width: f64,
    /// What was seen, see [`CUE_NAMES`](super::CUE_NAMES) for their names.
    pub cues: [f64; CUES],
    pub(super) run: Run,
    /// Ranges of the jambs, map units.
    pub(super) jamb_ranges: [f64; 2],
}

/// A wall seen farther than so many median ranges is not searched.
const FARTHEST: f64 = 0.12;
/// What a vote on the wall and one before it count against a vote through it.
const AGAINST: [f64; 2] = [1.5, 0.3];
/// Least sum of a candidate.
const LEAST: f64 = 2.0;
/// Candidates a wall may have.
const MOST: usize = 5;
/// How far from the outermost point seen through an opening its jamb may be, degrees.
const REACH: usize = 6;

/// The part of a wall that lies before the agent: `len` bins from `first` on, without a break.
pub(super) struct Stretch<'a> {
    pub(super) wall: &'a Wall,
    pub(super) first: usize,
    pub(super) len: usize,
    n: usize,
}

impl<'a> Stretch<'a> {
    fn of(sight: &Sight, wall: &'a Wall) -> Option<Self> {
        let n = sight.n();
        let visible = |bin: usize| wall.line.inverse_range(sight.direction(bin % n)) > FARTHEST;
        let hidden = (0..n).find(|&bin| !visible(bin))?;
        let first = (hidden..hidden + n).find(|&bin| visible(bin))?;
        let len = (first..first + n).take_while(|&bin| visible(bin)).count();
        Some(Self {
            wall,
            first: first % n,
            len,
            n,
        })
    }

    pub(super) fn bin(&self, place: usize) -> usize {
        (self.first + place) % self.n
    }

    pub(super) fn votes(&self, place: usize) -> &Votes {
        &self.wall.votes[self.bin(place)]
    }

    /// The point of the wall at the edge before a place (or, at half places, in the middle of a bin), median ranges.
    pub(super) fn at(&self, place: f64) -> [f64; 2] {
        let bearing = (self.first as f64 + place) * std::f64::consts::TAU / self.n as f64;
        let direction = [bearing.cos(), bearing.sin()];
        let range = 1.0 / self.wall.line.inverse_range(direction).max(0.05);
        direction.map(|x| x * range)
    }

    /// Candidates as places in the stretch, start and end.
    fn candidates(&self) -> Vec<(usize, usize)> {
        let value = |place: usize| {
            let votes = self.votes(place);
            votes.through - AGAINST[0] * votes.on - AGAINST[1] * votes.before
        };
        let values: Vec<f64> = (0..self.len).map(value).collect();
        let mut used = vec![false; self.len];
        let mut found = Vec::new();
        while found.len() < MOST {
            let (sum, start, end) = largest(&values, &used);
            if sum < LEAST {
                break;
            }
            used[start..end].fill(true);
            found.push((start, end));
        }
        found
    }

    /// The jambs' places: the nearest bins outside that show the wall or something before it.
    fn jambs(&self, start: usize, end: usize) -> (usize, usize) {
        let shows = |place: usize| self.votes(place).on + self.votes(place).before > 0.0;
        let reach = (REACH * self.n / 360).max(1);
        let before = (0..=reach.min(start)).find(|&k| k < start && shows(start - k - 1));
        let after = (0..=reach).find(|&k| end + k < self.len && shows(end + k));
        (start - before.unwrap_or(0), end + after.unwrap_or(0))
    }
}

/// The unused stretch of the largest sum: the sum, its start and its end.
fn largest(values: &[f64], used: &[bool]) -> (f64, usize, usize) {
    let mut best = (0.0, 0, 0);
    let (mut sum, mut start) = (0.0, 0);
    for (place, value) in values.iter().enumerate() {
        if used[place] {
            (sum, start) = (0.0, place + 1);
            continue;
        }
        if sum <= 0.0 {
            (sum, start) = (0.0, place);
        }
        sum += value;
        if sum > best.0 {
            best = (sum, start, place + 1);
        }
    }
    best
}

/// All candidates of all walls. `unseen` flags bins nobody looked into: an opening that is nearer than
/// `rule.margin` to one is not judged, because half an opening at the border of a scan looks like anything.
pub(super) fn openings(
    profile: &RangeProfile,
    sight: &Sight,
    walls: &[Wall],
    unseen: &[bool],
    rule: &RangeAware,
) -> Vec<Opening> {
    let margin = (rule.margin / profile.bin_width()).round() as usize;
    let mut found = Vec::new();
    for (index, wall) in walls.iter().enumerate() {
        let Some(stretch) = Stretch::of(sight, wall) else {
            continue;
        };
        let n = sight.n();
        for (start, end) in stretch.candidates() {
            let jambs = stretch.jambs(start, end);
            let (from, len) = (stretch.bin(jambs.0), jambs.1 - jambs.0);
            let wide = (len + 2 * margin).min(n);
            let mut around = (0..wide).map(|k| (from + 2 * n - margin.min(n) + k) % n);
            if around.any(|bin| unseen[bin]) {
                continue;
            }
            let cues = Cues::of(sight, walls, index, &stretch, (start, end), jambs);
            let [a, b] = [jambs.0, jambs.1].map(|place| stretch.at(place as f64));
            let unit = profile.median_range;
            let run = Run { start: from, len };
            found.push(Opening {
                sector: run.sector(n),
                width: unit * (a[0] - b[0]).hypot(a[1] - b[1]),
                cues: cues.to_array(),
                run,
                jamb_ranges: [a, b].map(|jamb| unit * jamb[0].hypot(jamb[1])),
            });
        }
    }
    found
}
