//! Candidates: sectors with a short line between their edges and points deep behind it.
//!
//! A door is a bottleneck: the distance between its jambs is small against the depth of what is seen
//! behind them. Moving an edge outwards lengthens the line, moving it inwards puts the edge on the far
//! wall and lengthens it too, so the best sector has its edges at the jambs. In a room's corner the
//! depth is at most half the line; at the far end of a long room the walls beside the edges go on, and
//! nothing lies behind their continuation.

use super::contour::Contour;
use crate::config::RangeAware;
use crate::profile::{BinStats, RangeProfile};
use crate::sector::Run;

/// A bin has at most this many votes, so that one poster does not outvote a doorway.
const MOST_VOTES: usize = 4;
/// Depths are counted up to this many widths, so that one far point does not carry a sector.
const MOST_DEPTH: f64 = 3.0;

/// A sector with the evidence in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Match {
    pub(super) run: Run,
    /// Mean of `1 − wall / seen` over the votes beyond.
    pub(super) jump: f64,
    /// Votes beyond the wall.
    pub(super) beyond: usize,
    /// Distance between the jambs, map units.
    pub(super) width: f64,
    /// What is maximised.
    pub(super) strength: f64,
}

/// Local maxima of the strength over all sectors without unseen bins, best first, not overlapping.
/// Sectors between jambs nearer than `needed` come last and only where no wider one lies.
pub(super) fn matches(
    profile: &RangeProfile,
    contour: &Contour,
    unseen: &[bool],
    rule: &RangeAware,
    needed: f64,
) -> Vec<Match> {
    let n = contour.n();
    let widest = (rule.widest / profile.bin_width()).round() as usize;
    let usual = usual_votes(profile);
    let mut found: Vec<Match> = Vec::new();
    for len in widths(widest.min(n - 1)) {
        let sectors = (0..n).map(|start| Run { start, len });
        let sectors = sectors.filter(|run| run.bins(n).all(|bin| !unseen[bin]));
        found.extend(sectors.filter_map(|run| measure(profile, contour, run, rule, usual)));
    }
    found.sort_by(|a, b| {
        (b.width >= needed)
            .cmp(&(a.width >= needed))
            .then(b.strength.total_cmp(&a.strength))
            .then(a.run.start.cmp(&b.run.start))
    });
    let mut taken = vec![false; n];
    found.retain(|candidate| {
        let free = candidate.run.bins(n).all(|bin| !taken[bin]);
        if free {
            candidate.run.bins(n).for_each(|bin| taken[bin] = true);
        }
        free
    });
    found
}

/// Votes per bin over all bins seen.
fn usual_votes(profile: &RangeProfile) -> f64 {
    let seen = || profile.bins.iter().filter(|stats| stats.count > 0);
    let votes: usize = seen().map(|stats| stats.count.min(MOST_VOTES)).sum();
    votes as f64 / seen().count().max(1) as f64
}

/// Widths in bins, growing by about an eighth: 1, 2, …, 8, 9, 11, 13, …
fn widths(widest: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(1), |&len| Some(len + 1 + len / 8))
        .take_while(move |&len| len <= widest)
}

fn measure(
    profile: &RangeProfile,
    contour: &Contour,
    run: Run,
    rule: &RangeAware,
    usual_votes: f64,
) -> Option<Match> {
    let expected = contour.expectation(run.start, run.len)?;
    if expected.width > rule.max_relative_width * profile.median_range {
        return None;
    }
    let (mut beyond, mut votes, mut depth, mut jump) = (0, 0, 0.0, 0.0);
    for bin in run.bins(contour.n()) {
        let BinStats { count, median, .. } = profile.bins[bin];
        if count == 0 {
            continue;
        }
        let votes_here = count.min(MOST_VOTES);
        let direction = contour.direction(bin);
        let behind = expected
            .chord
            .distance_behind(direction.map(|x| x * median))
            / expected.width;
        let ratio = median * expected.inverse_range(direction);
        votes += votes_here;
        depth += votes_here as f64 * behind.clamp(-1.0, MOST_DEPTH);
        if ratio > rule.jump {
            beyond += votes_here;
            jump += votes_here as f64 * (1.0 - 1.0 / ratio);
        }
    }
    let share = beyond as f64 / votes.max(1) as f64;
    let depth = depth / votes.max(1) as f64;
    let usual = rule.min_density * usual_votes * run.len as f64;
    let enough = beyond >= rule.min_points_beyond
        && beyond as f64 >= usual
        && share >= rule.min_share_beyond
        && depth >= rule.min_depth;
    let jump = jump / beyond.max(1) as f64;
    let strength = jump * share * (beyond as f64).sqrt();
    enough.then_some(Match {
        run,
        jump,
        beyond,
        width: expected.width,
        strength,
    })
}
