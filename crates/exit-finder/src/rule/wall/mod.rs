//! Straight walls, and what was seen on them, through them and before them in each bin.

mod lines;

use super::line::Line;
use super::sight::Sight;

/// A bin has at most this many votes, so that one poster does not outvote a doorway.
const MOST_VOTES: f64 = 4.0;

/// A wall with the votes of each bin.
pub(super) struct Wall {
    pub(super) line: Line,
    /// Per bin.
    pub(super) votes: Vec<Votes>,
    /// Votes on the wall in the bins before each, over two turns.
    sums: Vec<f64>,
}

impl Wall {
    fn new(line: Line, votes: Vec<Votes>) -> Self {
        let mut sums = vec![0.0];
        for votes in votes.iter().chain(&votes) {
            sums.push(sums.last().copied().unwrap_or(0.0) + votes.on);
        }
        Self { line, votes, sums }
    }

    /// Votes on the wall in `len` bins from `first` on, both below the number of bins.
    pub(super) fn on(&self, first: usize, len: usize) -> f64 {
        self.sums[first + len] - self.sums[first]
    }
}

/// What a bin says about a wall.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Votes {
    /// Points at flying height on the wall.
    pub(super) on: f64,
    /// Those of them that lie on no stronger wall.
    pub(super) own: f64,
    /// Points behind the wall at any height: a line of sight that passes speaks for an opening wherever it passes.
    pub(super) through: f64,
    /// Points at flying height before the wall.
    pub(super) before: f64,
    /// How far behind the wall the points through it lie, harmonic mean, median ranges.
    pub(super) depth: f64,
}

/// The walls of a profile, strongest first.
pub(super) fn walls(sight: &Sight, most: usize, least: usize) -> Vec<Wall> {
    let mut claimed = vec![false; sight.level_entries()];
    lines::lines(sight, most, least)
        .into_iter()
        .map(|line| {
            let away = line.distance();
            let votes = (0..sight.n()).map(|bin| votes(sight, (&line, away), bin, &mut claimed));
            Wall::new(line, votes.collect())
        })
        .collect()
}

/// The votes of a bin about a line at this distance.
fn votes(sight: &Sight, (line, away): (&Line, f64), bin: usize, claimed: &mut [bool]) -> Votes {
    let at = line.inverse_range(sight.direction(bin));
    if at < lines::FARTHEST.min(lines::FARTHEST / away) {
        return Votes::default();
    }
    let tolerance = sight.tolerance(at);
    let mut votes = Votes::default();
    let (level, each, first) = sight.level(bin);
    for (k, entry) in level.iter().enumerate() {
        if (entry - at).abs() <= tolerance {
            votes.on += each;
            if !std::mem::replace(&mut claimed[first + k], true) {
                votes.own += each;
            }
        } else if *entry > at {
            votes.before += each;
        }
    }
    let (count, sum) = behind(sight, bin, at);
    votes.through = count;
    if count > 0.0 {
        votes.depth = (at * count / sum - 1.0) * away;
    }
    let all = votes.on + votes.through + votes.before;
    let weight = all.min(MOST_VOTES) / all.max(f64::MIN_POSITIVE);
    Votes {
        on: weight * votes.on,
        own: weight * votes.own,
        through: weight * votes.through,
        before: weight * votes.before,
        depth: votes.depth,
    }
}

/// Points of a bin behind a wall that has this inverse range there: how many, and the sum of their inverse ranges.
pub(super) fn behind(sight: &Sight, bin: usize, at: f64) -> (f64, f64) {
    let (entries, each) = sight.any_height(bin);
    let least = at - sight.tolerance(at);
    let behind = entries.iter().filter(|&&entry| entry < least);
    behind.fold((0.0, 0.0), |(count, sum), entry| {
        (count + each, sum + each * entry)
    })
}
