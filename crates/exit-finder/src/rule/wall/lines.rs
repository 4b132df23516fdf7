//! Straight walls in the profile, strongest first.
//!
//! Input: inverse ranges per bin. Output: lines in the plane of flight with the number of entries on them.
//! Method: a Hough transform over pairs. Each bin is represented by three of its entries, pairs of
//! representatives some degrees apart propose lines, and a line's score is how many representatives within ±60 degrees
//! lie on it. The best one is fitted to all entries by least squares, its representatives are taken out, and so on.
//! An entry that is taken proposes nothing any more, and scores only fall, so an old score is an upper bound: proposals are kept in a list for
//! each score, from the highest down, and move to a lower list when their score has fallen. No random numbers.
//!
//! Cost: O(bins · window) for the first scores, a constant of the profile.

use std::cmp::Ordering;

use super::super::line::Line;
use super::super::sight::Sight;

/// Angular distances of the two points that propose a line, degrees.
const APART: [usize; 4] = [4, 10, 24, 50];
/// A line's score counts this far to both sides of its pair, degrees.
const WINDOW: usize = 60;
/// Lines nearer to the agent than this share of the median range are none.
const NEAREST: f64 = 1.0 / 6.0;
/// A wall that is seen farther than ten median ranges is not looked for.
pub(super) const FARTHEST: f64 = 0.1;
/// Seeds are taken in so many bins at most, evenly.
const SEEDS: usize = 360;

/// Up to `most` lines with at least `least` representatives on each.
pub(super) fn lines(sight: &Sight, most: usize, least: usize) -> Vec<Line> {
    let mut search = Search::new(sight);
    let (proposals, mut ranked) = search.proposals(least);
    let mut found = Vec::new();
    for score in (least..ranked.len()).rev() {
        // Scores only fall, so nothing is added to this list any more.
        let mut equal = std::mem::take(&mut ranked[score]);
        equal.sort_unstable_by(Ranked::farther_first);
        for best in equal {
            if found.len() >= most {
                return found;
            }
            let Proposal { line, seeds } = proposals[best.index as usize];
            let middle = best.middle as usize;
            if seeds
                .iter()
                .any(|&(bin, k)| search.entries[k][bin].is_nan())
            {
                continue;
            }
            let now = search.score(&line, middle);
            if now < score {
                if now >= least {
                    ranked[now].push(best);
                }
                continue;
            }
            let line = search.fitted(line, middle);
            search.take_out(&line);
            found.push(line);
        }
    }
    found
}

/// A line to be tried.
#[derive(Debug, Clone, Copy)]
struct Proposal {
    line: Line,
    /// The two entries that propose it: bin and representative.
    seeds: [(usize, usize); 2],
}

/// What is moved of a proposal: little, since there are thousands.
#[derive(Debug, Clone, Copy)]
struct Ranked {
    /// Of the line from the agent, median ranges.
    distance: f64,
    /// Bin in the middle of the pair.
    middle: u32,
    /// Among the proposals.
    index: u32,
}

impl Ranked {
    /// Of equal scores the farther line, which turning the profile does not change.
    fn farther_first(&self, other: &Self) -> Ordering {
        let distance = other.distance.total_cmp(&self.distance);
        let middle = self.middle.cmp(&other.middle);
        distance.then(middle).then(self.index.cmp(&other.index))
    }
}

struct Search<'a> {
    sight: &'a Sight,
    /// Two turns of directions, by coordinate, so that a window is one slice.
    directions: [Vec<f64>; 2],
    /// Two turns of representatives, near, middle and far; NaN where there are fewer or they are taken.
    entries: [Vec<f64>; 3],
    /// Half the window, bins.
    half: usize,
}

impl<'a> Search<'a> {
    fn new(sight: &'a Sight) -> Self {
        let n = sight.n();
        let bins = || (0..n).chain(0..n);
        let three: Vec<[f64; 3]> = (0..n)
            .map(|bin| representatives(sight.seen(bin).0))
            .collect();
        Self {
            sight,
            directions: [0, 1].map(|k| bins().map(|bin| sight.direction(bin)[k]).collect()),
            entries: [0, 1, 2].map(|k| bins().map(|bin| three[bin][k]).collect()),
            half: (WINDOW * n / 360).min((n - 1) / 2),
        }
    }

    /// The lines to be tried, and by score which of them have it.
    fn proposals(&self, least: usize) -> (Vec<Proposal>, Vec<Vec<Ranked>>) {
        let n = self.sight.n();
        let mut proposals = Vec::new();
        let mut ranked = vec![Vec::new(); 3 * (2 * self.half + 1) + 1];
        let apart = APART.map(|degrees| degrees * n / 360);
        for first in (0..n).step_by(n.div_ceil(SEEDS)) {
            for d in apart.into_iter().filter(|&d| d > 0) {
                for (x, y) in [(0, 0), (1, 1), (2, 2)] {
                    let seeds = [(first, x), (first + d, y)];
                    let Some(line) = self.through(seeds) else {
                        continue;
                    };
                    let middle = (first + d / 2) % n;
                    let score = self.score(&line, middle);
                    if score >= least {
                        ranked[score].push(Ranked {
                            distance: line.distance(),
                            middle: middle as u32,
                            index: proposals.len() as u32,
                        });
                        proposals.push(Proposal { line, seeds });
                    }
                }
            }
        }
        (proposals, ranked)
    }

    fn through(&self, seeds: [(usize, usize); 2]) -> Option<Line> {
        let [p, q] = seeds.map(|(bin, k)| {
            let range = 1.0 / self.entries[k][bin];
            [0, 1].map(|axis| range * self.directions[axis][bin])
        });
        // Comparisons with NaN are false.
        let known = (p[0] + q[0]).is_finite();
        let line = Line::through(p, q).filter(|_| known)?;
        line.is_farther_than(NEAREST).then_some(line)
    }

    /// Representatives on a line within the window around a bin.
    fn score(&self, line: &Line, middle: usize) -> usize {
        let n = self.sight.n();
        let from = (middle + n - self.half) % n;
        let len = 2 * self.half + 1;
        let [x, y] = [0, 1].map(|axis| &self.directions[axis][from..from + len]);
        let [near, between, far] = [0, 1, 2].map(|k| &self.entries[k][from..from + len]);
        let on = |apart: f64, tolerance: f64| u64::from(apart.abs() <= tolerance);
        let mut score = 0;
        for k in 0..len {
            let at = line.inverse_range([x[k], y[k]]);
            let tolerance = self.sight.tolerance(at);
            let tolerance = if at < FARTHEST { -1.0 } else { tolerance };
            score += on(near[k] - at, tolerance)
                + on(between[k] - at, tolerance)
                + on(far[k] - at, tolerance);
        }
        score as usize
    }

    /// Least squares over all entries near the line, twice.
    fn fitted(&self, mut line: Line, middle: usize) -> Line {
        let n = self.sight.n();
        for _ in 0..2 {
            let (mut xx, mut xy, mut yy, mut xv, mut yv) = (0.0, 0.0, 0.0, 0.0, 0.0);
            for bin in (0..=2 * self.half).map(|k| (middle + n - self.half + k) % n) {
                let d = self.sight.direction(bin);
                let at = line.inverse_range(d);
                let (entries, each) = self.sight.seen(bin);
                if at < FARTHEST {
                    continue;
                }
                let tolerance = self.sight.tolerance(at);
                let weight = each.min(MOST_WEIGHT) / self.sight.sigma(at).powi(2);
                for entry in entries.iter().filter(|&v| (v - at).abs() <= tolerance) {
                    xx += weight * d[0] * d[0];
                    xy += weight * d[0] * d[1];
                    yy += weight * d[1] * d[1];
                    xv += weight * entry * d[0];
                    yv += weight * entry * d[1];
                }
            }
            let determinant = xx * yy - xy * xy;
            if determinant <= 1e-12 * xx * yy {
                break;
            }
            line = Line::with_inverse(
                (xv * yy - yv * xy) / determinant,
                (xx * yv - xy * xv) / determinant,
            );
        }
        line
    }

    fn take_out(&mut self, line: &Line) {
        let [x, y] = &self.directions;
        for entries in &mut self.entries {
            for ((entry, x), y) in entries.iter_mut().zip(x).zip(y) {
                let at = line.inverse_range([*x, *y]);
                if (*entry - at).abs() <= self.sight.tolerance(at) {
                    *entry = f64::NAN;
                }
            }
        }
    }
}

/// An entry of a fuller bin counts as this many points in the fit.
const MOST_WEIGHT: f64 = 2.0;

/// Three of a bin's entries: near, middle and far.
fn representatives(entries: &[f64]) -> [f64; 3] {
    match *entries {
        [] => [f64::NAN; 3],
        [a] => [a, f64::NAN, f64::NAN],
        [a, b] => [a, b, f64::NAN],
        _ => {
            let l = entries.len();
            [entries[l / 6], entries[l / 2], entries[5 * l / 6]]
        }
    }
}
