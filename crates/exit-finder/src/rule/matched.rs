//! Candidates: sectors with a short line between their edges and points deep behind it.
//!
//! A door is a bottleneck: the distance between its jambs is small against the depth of what is seen
//! behind them. Every sector up to `widest` is measured; those that pass the gates of [`RangeAware`] are
//! scored ([`super::evidence`]), and the likeliest that do not overlap remain. Moving an edge outwards takes
//! points of the wall into the sector, moving it inwards puts the edge on the far wall, so the best sector has
//! its edges at the jambs.
//!
//! What counts: points beyond the wall at any height of the band, because a line of sight that passes speaks for
//! an opening wherever it passes; but against it only points at flying height, because a lintel or the
//! floor before a door does not close it.
//!
//! Cost: O(bins · widths · widest), a constant of the profile.

use super::contour::{Contour, Expectation};
use super::evidence::Evidence;
use crate::config::RangeAware;
use crate::profile::{RangeProfile, Samples};
use crate::sector::Run;

/// A bin has at most this many votes, so that one poster does not outvote a doorway.
const MOST_VOTES: f64 = 4.0;
/// Depths are counted up to this many widths, so that one far point does not carry a sector.
const MOST_DEPTH: f64 = 3.0;
/// Half the width of the surroundings that a sector is compared with, radians: 50 degrees.
const SURROUNDINGS: f64 = 0.872_664_625_997_164_8;
/// Points this much farther than a continued wall lie behind it.
const BEHIND: f64 = 1.15;

/// A sector with the evidence in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Match {
    pub(super) run: Run,
    /// Distance between the jambs, map units.
    pub(super) width: f64,
    pub(super) evidence: Evidence,
    /// What is maximised.
    probability: f64,
}

/// Local maxima of the probability over all sectors without unseen bins, best first, not overlapping.
/// Sectors between jambs nearer than `needed` come last and only where no wider one lies.
pub(super) fn matches(
    profile: &RangeProfile,
    contour: &Contour,
    unseen: &[bool],
    rule: &RangeAware,
    needed: f64,
) -> Vec<Match> {
    let search = Search {
        surroundings: surroundings(profile, contour),
        extents: (0..contour.n())
            .map(|bin| BinExtents {
                seen: Extent::of(&profile.seen, bin),
                level: Extent::of(&profile.level, bin),
            })
            .collect(),
        profile,
        contour,
        rule,
    };
    let n = contour.n();
    let widest = (rule.widest / profile.bin_width()).round() as usize;
    let mut found: Vec<Match> = Vec::new();
    let clear = clear_bins(unseen);
    for len in widths(widest.min(n - 1)) {
        let sectors = (0..n).filter(|&start| clear[start] >= len);
        found.extend(sectors.filter_map(|start| search.measure(Run { start, len })));
    }
    found.sort_by(|a, b| {
        (b.width >= needed)
            .cmp(&(a.width >= needed))
            .then(b.probability.total_cmp(&a.probability))
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

/// Widths in bins, growing by about an eighth: 1, 2, …, 8, 9, 11, 13, …
fn widths(widest: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(1), |&len| Some(len + 1 + len / 8))
        .take_while(move |&len| len <= widest)
}

/// How many bins from each bin on, up to all, are not unseen.
fn clear_bins(unseen: &[bool]) -> Vec<usize> {
    let n = unseen.len();
    let mut clear = vec![0; n];
    let mut run = 0;
    for step in (0..2 * n).rev() {
        run = if unseen[step % n] {
            0
        } else {
            (run + 1).min(n)
        };
        clear[step % n] = run;
    }
    clear
}

/// Median range of the contour around each bin.
fn surroundings(profile: &RangeProfile, contour: &Contour) -> Vec<f64> {
    let n = contour.n();
    let half = ((SURROUNDINGS / profile.bin_width()).round() as usize).min((n - 1) / 2);
    (0..n)
        .map(|bin| {
            contour
                .median_range(bin + n - half, 2 * half + 1)
                .unwrap_or(f64::INFINITY)
        })
        .collect()
}

/// Votes of a sector.
#[derive(Debug, Default)]
struct Tally {
    /// All votes, and those for points beyond.
    votes: f64,
    beyond: f64,
    /// Sums over the votes beyond: depth, place in the sector and its square.
    depth: f64,
    place: f64,
    square: f64,
}

struct Search<'a> {
    profile: &'a RangeProfile,
    contour: &'a Contour,
    rule: &'a RangeAware,
    surroundings: Vec<f64>,
    extents: Vec<BinExtents>,
}

impl Search<'_> {
    fn measure(&self, run: Run) -> Option<Match> {
        let (rule, usual_range) = (self.rule, self.profile.median_range);
        let expected = self.contour.expectation(run.start, run.len)?;
        let width = expected.width;
        if width > rule.max_relative_width * usual_range {
            return None;
        }
        let tally = self.tally(run, &expected);
        let share = tally.beyond / tally.votes.max(1.0);
        let depth = tally.depth / tally.beyond.max(1.0);
        let enough = tally.beyond >= rule.min_points_beyond as f64
            && share >= rule.min_share_beyond
            && depth >= rule.min_depth
            && depth * width >= rule.min_relative_depth * usual_range;
        if !enough {
            return None;
        }
        let (n, middle) = (self.contour.n(), run.start + run.len / 2);
        let inside = self.contour.median_range(run.start, run.len)?;
        let place = tally.place / tally.beyond;
        let deviation = (tally.square / tally.beyond - place * place)
            .max(0.0)
            .sqrt();
        let evidence = Evidence {
            contrast: inside / self.surroundings[middle % n],
            share,
            votes: tally.beyond,
            depth,
            relative_width: width / usual_range,
            // An even spread has a deviation of length / √12.
            spread: deviation * 12f64.sqrt() / run.len as f64,
            convexity: self.behind_both(run, &expected) / tally.votes,
            angle: run.len as f64 * self.profile.bin_width(),
        };
        let probability = evidence.parts().probability();
        let found = Match {
            run,
            width,
            evidence,
            probability,
        };
        let enough = evidence.contrast >= rule.min_contrast && probability >= rule.min_probability;
        enough.then_some(found)
    }

    fn tally(&self, run: Run, expected: &Expectation) -> Tally {
        let mut tally = Tally::default();
        let depth_unit = expected.chord.distance() / expected.width;
        for (k, bin) in run.bins(self.contour.n()).enumerate() {
            let direction = self.contour.direction(bin);
            let inverse = expected.inverse_range(direction);
            let Some((votes, beyond, sum)) = self.votes(bin, self.rule.jump, inverse) else {
                continue;
            };
            tally.votes += votes;
            if beyond > 0.0 {
                tally.beyond += beyond;
                // Of the ranges beyond the harmonic mean counts: one far point does not carry a bin.
                let seen = direction.map(|x| x * beyond / sum);
                let behind = expected.chord.share_behind(seen) * depth_unit;
                tally.depth += beyond * behind.clamp(-1.0, MOST_DEPTH);
                let place = k as f64 + 0.5;
                tally.place += beyond * place;
                tally.square += beyond * place * place;
            }
        }
        tally
    }

    /// Votes of a bin, those beyond `factor` times the wall, and the sum of the latter's inverse
    /// ranges.
    fn votes(&self, bin: usize, factor: f64, inverse: f64) -> Option<(f64, f64, f64)> {
        let of = &self.extents[bin];
        if of.seen.count == 0.0 {
            return None;
        }
        let least = if inverse > 0.0 {
            factor / inverse
        } else {
            f64::INFINITY
        };
        let (beyond, sum) = of.seen.beyond(least, self.profile.seen.of(bin));
        let against = of.level.count - of.level.beyond(least, self.profile.level.of(bin)).0;
        let all = beyond + against;
        let weight = all.min(MOST_VOTES) / all.max(f64::MIN_POSITIVE);
        Some((weight * all, weight * beyond, weight * sum))
    }

    /// Votes for points behind the walls on both sides, continued.
    fn behind_both(&self, run: Run, expected: &Expectation) -> f64 {
        run.bins(self.contour.n())
            .filter_map(|bin| {
                let direction = self.contour.direction(bin);
                let (_, all, _) =
                    self.votes(bin, self.rule.jump, expected.inverse_range(direction))?;
                let farther = expected.inverse_farther(direction);
                Some(self.votes(bin, BEHIND, farther)?.1.min(all))
            })
            .sum()
    }
}

/// The two samples of a bin in short: most bins show one wall, which lies before or behind as a whole.
struct BinExtents {
    seen: Extent,
    level: Extent,
}

struct Extent {
    count: f64,
    nearest: f64,
    farthest: f64,
    /// Sum of the inverse ranges.
    inverse: f64,
}

impl Extent {
    fn of(samples: &Samples, bin: usize) -> Self {
        let sample = samples.of(bin);
        let count = samples.count(bin) as f64;
        let each = count / sample.len().max(1) as f64;
        Self {
            count,
            nearest: sample.first().copied().unwrap_or(f64::INFINITY),
            farthest: sample.last().copied().unwrap_or(0.0),
            inverse: sample.iter().map(|range| each / range).sum(),
        }
    }

    /// How many points lie beyond a range, and the sum of their inverse ranges.
    fn beyond(&self, least: f64, sample: &[f64]) -> (f64, f64) {
        if self.farthest <= least {
            return (0.0, 0.0);
        }
        if self.nearest > least {
            return (self.count, self.inverse);
        }
        let each = self.count / sample.len() as f64;
        let beyond = sample.iter().rev().take_while(|&&range| range > least);
        beyond.fold((0.0, 0.0), |(count, sum), range| {
            (count + each, sum + each / range)
        })
    }
}
