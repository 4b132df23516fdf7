//! Openings in walls: stretches of a straight wall through which points are seen, from jamb to jamb.
//!
//! Along a wall each bin has a value: votes through it, less votes on it and a few of those before it. The stretch of
//! the largest sum is a candidate, then the next one beside it, while they are worth anything (Bentley's maximal
//! subarray). Its jambs are the nearest bins outside it that show the wall. O(bins) per wall and candidate.
//!
//! What a vote on the wall counts decides between too wide and too narrow: at a low weight the doubtful rest of a wall that strays
//! surround is worth nothing rather than less, and is taken together with the door in it. So several weights may be tried, see [`Weights`].

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
/// What a vote on the wall counts against a vote through it; each weight has its candidates.
pub(super) type Weights = [f64];
/// At one look.
pub(super) const ONE_LOOK: &Weights = &[1.5];
/// At both of two. In generated rooms with 20 % outliers (seeds from 54000, 247 doors) the best candidate of a door has more than 0.7 of
/// its union with the door in common for 89 % of the doors at 1.5 alone, 96 % with 4 beside it and 98 % with 3 and 8.
pub(super) const TWO_LOOKS: &Weights = &[1.5, 3.0, 8.0];
/// What a vote before the wall counts.
const BEFORE: f64 = 0.3;
/// Least sum of a candidate.
const LEAST: f64 = 2.0;
/// Candidates a wall may have.
const MOST: usize = 5;
/// How far from the outermost point seen through an opening its jamb may be, degrees: where the wall is well seen, and
/// where it is blank or little is seen behind. Both are tried.
const REACH: usize = 6;
const FAR_REACH: usize = 18;
/// Candidates nearer to each other than this may be one opening, degrees.
const NEIGHBOURS: usize = 12;

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
    fn candidates(&self, weights: &Weights) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        for &weight in weights {
            for candidate in self.candidates_at(weight) {
                if !found.contains(&candidate) {
                    found.push(candidate);
                }
            }
        }
        found
    }

    fn candidates_at(&self, weight: f64) -> Vec<(usize, usize)> {
        let value = |place: usize| {
            let votes = self.votes(place);
            votes.through - weight * votes.on - BEFORE * votes.before
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
        self.merged(&values, &mut found);
        found
    }

    /// Adds neighbours as one: a few strays on the wall may part an opening.
    fn merged(&self, values: &[f64], found: &mut Vec<(usize, usize)>) {
        found.sort_unstable();
        let parts = found.len();
        for k in 1..parts {
            let (start, end) = (found[k - 1].0, found[k].1);
            let apart = found[k].0 - found[k - 1].1;
            if apart * 360 <= NEIGHBOURS * self.n && values[start..end].iter().sum::<f64>() > LEAST
            {
                found.push((start, end));
            }
        }
    }

    /// The jambs' places: the nearest bins outside that show the wall or something before it.
    fn jambs(&self, (start, end): (usize, usize), reach: usize) -> (usize, usize) {
        let shows = |place: usize| self.votes(place).on + self.votes(place).before > 0.0;
        let reach = (reach * self.n / 360).max(1);
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
    weights: &Weights,
) -> Vec<Opening> {
    let margin = (rule.margin / profile.bin_width()).round() as usize;
    let mut found = Vec::new();
    for (index, wall) in walls.iter().enumerate() {
        let Some(stretch) = Stretch::of(sight, wall) else {
            continue;
        };
        for inner in stretch.candidates(weights) {
            let near = stretch.jambs(inner, REACH);
            let far = stretch.jambs(inner, FAR_REACH);
            for jambs in std::iter::once(near).chain((far != near).then_some(far)) {
                let run = Run {
                    start: stretch.bin(jambs.0),
                    len: jambs.1 - jambs.0,
                };
                if borders_on(run, margin, unseen) {
                    continue;
                }
                let cues = Cues::of(sight, walls, index, &stretch, inner, jambs);
                let ends = [jambs.0, jambs.1].map(|place| stretch.at(place as f64));
                found.push(Opening::new(run, ends, &cues, profile));
            }
        }
    }
    found
}

/// Whether a run, or what lies within `margin` bins of it, was never looked at.
fn borders_on(run: Run, margin: usize, unseen: &[bool]) -> bool {
    let n = unseen.len();
    let wide = (run.len + 2 * margin).min(n);
    let mut around = (0..wide).map(|k| (run.start + 2 * n - margin.min(n) + k) % n);
    around.any(|bin| unseen[bin])
}

impl Opening {
    /// `ends` are the jambs in median ranges about the agent.
    fn new(run: Run, [a, b]: [[f64; 2]; 2], cues: &Cues, profile: &RangeProfile) -> Self {
        let unit = profile.median_range;
        Self {
            sector: run.sector(profile.bins.len()),
            width: unit * (a[0] - b[0]).hypot(a[1] - b[1]),
            cues: cues.to_array(),
            run,
            jamb_ranges: [a, b].map(|jamb| unit * jamb[0].hypot(jamb[1])),
        }
    }
}
