//! The default rule: openings are gaps in walls through which points are seen, and runs that are empty.
//!
//! 1. Flag the bins that were never looked at (`unseen`).
//! 2. Find the straight walls (`wall`) and, in each, the stretches through which points are seen (`openings`).
//! 3. Judge each by what was seen in it and beside it (`cues`, `score`); the likeliest that do not overlap are exits.
//! 4. Gaps: empty runs where walls are so evenly textured that a wall would have shown.
//! 5. Turn down what is too narrow.

use super::contour::Contour;
use super::openings::{ONE_LOOK, Opening, TWO_LOOKS, Weights, openings};
use super::score::{ScoreParts, bias, second_bias};
use super::second_look::{SecondLook, looked_at_twice, taken_out};
use super::sight::Sight;
use super::unseen::{points_elsewhere, unseen_bins};
use super::wall::walls;
use crate::config::{ExitConfig, RangeAware};
use crate::exit::{Exit, ExitKind, ExitReport, Rejected, Rejection};
use crate::profile::RangeProfile;
use crate::sector::{Run, circular_runs};
use crate::vector::distance;
use crate::view::ExitView;

pub(super) fn exits(
    profile: RangeProfile,
    rule: &RangeAware,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> ExitReport {
    let scene = Scene::new(&profile, rule, view, config);
    let verdicts = scene.verdicts(scene.likely());
    report(verdicts, profile)
}

/// The same of a map that was cleaned, by its profiles with and without what was taken out.
pub(super) fn exits_of_cleaned(
    all: RangeProfile,
    kept: &RangeProfile,
    rule: &RangeAware,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> ExitReport {
    let scene = Scene::new(&all, rule, view, config);
    let found = scene.twice(&Scene::new(kept, rule, view, config));
    let verdicts = scene.verdicts(scene.likely_by_both(found));
    report(verdicts, all)
}

fn report(verdicts: Verdicts, profile: RangeProfile) -> ExitReport {
    let (mut exits, mut rejected) = (Vec::new(), Vec::new());
    let sector = |run: Run| run.sector(profile.bins.len());
    for (run, verdict) in verdicts.jumps.into_iter().chain(verdicts.gaps) {
        match verdict {
            Ok(exit) => exits.push(exit),
            Err(reason) => rejected.push(Rejected {
                sector: sector(run),
                reason,
            }),
        }
    }
    ExitReport {
        exits,
        unseen: verdicts.unseen.into_iter().map(sector).collect(),
        rejected,
        profile,
    }
}

/// All candidates of a profile, whatever their probability.
pub(super) fn candidates(
    profile: &RangeProfile,
    rule: &RangeAware,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Vec<Opening> {
    Scene::new(profile, rule, view, config).openings(ONE_LOOK)
}

/// All candidates of both profiles of a map that was cleaned.
pub(super) fn candidates_of_cleaned(
    all: &RangeProfile,
    kept: &RangeProfile,
    rule: &RangeAware,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> Vec<SecondLook> {
    Scene::new(all, rule, view, config).twice(&Scene::new(kept, rule, view, config))
}

/// A candidate with its parts and its probability.
type Judged = (Opening, ScoreParts, f64);
type Verdict = (Run, Result<Exit, Rejection>);

/// What the rule says of the openings in walls and of the empty runs, and what was never looked at.
struct Verdicts {
    jumps: Vec<Verdict>,
    gaps: Vec<Verdict>,
    unseen: Vec<Run>,
}

/// The profile with what is known about each bin.
struct Scene<'a> {
    profile: &'a RangeProfile,
    rule: &'a RangeAware,
    /// Half the smoothing window, bins.
    half: usize,
    contour: Contour,
    unseen: Vec<bool>,
    /// Width below which an opening is turned down, map units.
    needed: f64,
}

impl<'a> Scene<'a> {
    fn new(
        profile: &'a RangeProfile,
        rule: &'a RangeAware,
        view: &ExitView<'_>,
        config: &ExitConfig,
    ) -> Self {
        let bins = |angle: f64| (angle / profile.bin_width()).round() as usize;
        let half = bins(rule.window);
        let contour = Contour::new(profile, half, bins(rule.side), config.min_count);
        let unseen = unseen_bins(profile, &contour.ranges, rule, view);
        let needed = config
            .min_width
            .unwrap_or(rule.min_relative_width * profile.median_range);
        Self {
            profile,
            rule,
            half,
            contour,
            unseen,
            needed,
        }
    }

    fn n(&self) -> usize {
        self.contour.n()
    }

    fn openings(&self, weights: &Weights) -> Vec<Opening> {
        let rule = self.rule;
        let sight = Sight::of(self.profile, rule);
        let walls = walls(&sight, rule.max_walls, rule.min_wall);
        let most = rule.max_relative_width * self.profile.median_range;
        let mut found = openings(self.profile, &sight, &walls, &self.unseen, rule, weights);
        found.retain(|opening| opening.width <= most);
        found
    }

    /// The candidates of this look at all points and of another at the kept ones.
    fn twice(&self, among_kept: &Self) -> Vec<SecondLook> {
        let [all, kept] = [self, among_kept].map(|look| look.openings(TWO_LOOKS));
        let share = taken_out(self.profile, among_kept.profile);
        looked_at_twice(all, kept, share, self.needed)
    }

    fn verdicts(&self, likely: Vec<Judged>) -> Verdicts {
        let jumps = self.jumps(likely);
        Verdicts {
            gaps: self.gaps(&jumps),
            jumps,
            unseen: circular_runs(&self.unseen),
        }
    }

    /// The openings that are likely enough.
    fn likely(&self) -> Vec<Judged> {
        let (bias, least) = (bias(), self.rule.min_probability);
        let openings = self.openings(ONE_LOOK).into_iter();
        openings
            .filter(|opening| opening.rough_probability(bias) >= least - ROUNDING)
            .map(|opening| {
                let parts = opening.parts();
                (opening, parts, parts.probability())
            })
            .filter(|(_, _, probability)| *probability >= least)
            .collect()
    }

    /// The same by two looks.
    fn likely_by_both(&self, found: Vec<SecondLook>) -> Vec<Judged> {
        let (bias, least) = (second_bias(), self.rule.min_probability);
        found
            .into_iter()
            .map(|look| (look.rough_probability(bias), look))
            .filter(|(probability, _)| *probability >= least)
            .map(|(probability, look)| {
                let parts = look.parts(bias);
                (look.opening, parts, probability)
            })
            .collect()
    }

    /// The likeliest openings that do not overlap. Those narrower than needed come last and only where no wider one lies.
    fn jumps(&self, mut likely: Vec<Judged>) -> Vec<Verdict> {
        likely.sort_by(|(a, _, p), (b, _, q)| {
            (b.width >= self.needed)
                .cmp(&(a.width >= self.needed))
                .then(q.total_cmp(p))
                .then(a.run.start.cmp(&b.run.start))
        });
        let n = self.n();
        let mut taken = vec![false; n];
        let mut verdicts = Vec::new();
        for best in &likely {
            if best.0.run.bins(n).any(|bin| taken[bin]) {
                continue;
            }
            let widest = self.before(best, &likely, &taken);
            let (opening, parts, _) = self.within(widest, &likely);
            let widest = &widest.0;
            widest.run.bins(n).for_each(|bin| taken[bin] = true);
            let exit = self.exit_of(
                opening.run,
                opening.jamb_ranges,
                ExitKind::RangeJump,
                *parts,
            );
            verdicts.push((opening.run, self.wide_enough(exit)));
        }
        verdicts
    }

    /// The opening through which a likely one is seen, if it is one itself: it is the one to be entered first.
    fn before<'b>(&self, best: &'b Judged, likely: &'b [Judged], taken: &[bool]) -> &'b Judged {
        let n = self.n();
        let holds = |other: &&Judged| {
            best.0.run.is_within(other.0.run, n)
                && SAME_RANGE * nearer_jamb(&other.0) < nearer_jamb(&best.0)
                && other.0.width >= self.needed
                && other.0.run.bins(n).all(|bin| !taken[bin])
        };
        likely.iter().find(holds).unwrap_or(best)
    }

    /// A wider sector holds a piece of wall as well: of about equally likely ones in the same wall, the narrowest.
    fn within<'b>(&self, widest: &'b Judged, likely: &'b [Judged]) -> &'b Judged {
        let n = self.n();
        let equal = likely.iter().filter(|(other, _, p)| {
            other.run.is_within(widest.0.run, n)
                && nearer_jamb(other) <= SAME_RANGE * nearer_jamb(&widest.0)
                && (other.width >= self.needed) == (widest.0.width >= self.needed)
                && odds(*p) * EQUAL >= odds(widest.2)
        });
        equal
            .min_by_key(|(other, _, _)| other.run.len)
            .unwrap_or(widest)
    }

    /// Empty runs outside the openings found already.
    fn gaps(&self, jumps: &[Verdict]) -> Vec<Verdict> {
        let mut empty: Vec<bool> = (0..self.n())
            .map(|bin| self.contour.ranges[bin].is_none() && !self.unseen[bin])
            .collect();
        for (run, _) in jumps {
            run.bins(self.n()).for_each(|bin| empty[bin] = false);
        }
        let runs: Vec<Run> = circular_runs(&empty)
            .into_iter()
            .map(|run| self.widened(run))
            .collect();
        runs.iter()
            .map(|&run| (run, self.judge_gap(run, &runs)))
            .collect()
    }

    /// Takes back what the smoothing window took from an empty run on either side.
    fn widened(&self, run: Run) -> Run {
        let n = self.n();
        let most = self.half.min((n - run.len) / 2);
        let empty = |bin: usize| self.profile.bins[bin % n].count == 0;
        let before = (1..=most).take_while(|k| empty(run.start + n - k)).count();
        let after = (0..most)
            .take_while(|k| empty(run.start + run.len + k))
            .count();
        Run {
            start: (run.start + n - before) % n,
            len: run.len + before + after,
        }
    }

    fn judge_gap(&self, run: Run, gaps: &[Run]) -> Result<Exit, Rejection> {
        let (expected, mean) = points_elsewhere(self.profile, run, gaps);
        let needed = self.rule.min_expected.max(self.rule.min_evenness * mean);
        if expected < needed {
            return Err(Rejection::Unsupported { expected, needed });
        }
        let usual = self.profile.median_range;
        let ranges = self
            .contour
            .jamb_ranges(run.start, run.len)
            .unwrap_or([usual, usual]);
        let [a, b] = self.jambs(run, ranges);
        let width = distance(a, b);
        let support = 1.0 - (-expected / 8.0).exp();
        let passable = width / (width + 0.5 * self.needed).max(f64::MIN_POSITIVE);
        let parts = ScoreParts::of_support(GAP * support * passable);
        self.wide_enough(self.exit_of(run, ranges, ExitKind::Empty, parts))
    }

    fn wide_enough(&self, exit: Exit) -> Result<Exit, Rejection> {
        if exit.width < self.needed {
            return Err(Rejection::TooNarrow {
                width: exit.width,
                needed: self.needed,
            });
        }
        Ok(exit)
    }

    fn exit_of(&self, run: Run, ranges: [f64; 2], kind: ExitKind, parts: ScoreParts) -> Exit {
        let profile = self.profile;
        let sector = run.sector(self.n());
        let jambs = self.jambs(run, ranges);
        let bearing_rad = sector.middle_rad();
        let score = match kind {
            ExitKind::RangeJump => parts.probability(),
            ExitKind::Empty => GAP_RANK * parts.probability(),
        };
        let range = ranges[0].min(ranges[1]) * (1.0 + self.rule.beyond);
        Exit {
            direction: profile.direction(bearing_rad),
            bearing_rad,
            position: profile.at(bearing_rad, range),
            sector,
            width_rad: sector.width_rad,
            width: distance(jambs[0], jambs[1]),
            jambs,
            range,
            kind,
            score,
            parts,
        }
    }

    /// The two ends of a run at these ranges.
    fn jambs(&self, run: Run, ranges: [f64; 2]) -> [[f64; 3]; 2] {
        let sector = run.sector(self.n());
        let ends = [sector.start_rad, sector.start_rad + sector.width_rad];
        [0, 1].map(|k| self.profile.at(ends[k], ranges[k]))
    }
}

fn nearer_jamb(opening: &Opening) -> f64 {
    opening.jamb_ranges[0].min(opening.jamb_ranges[1])
}

fn odds(probability: f64) -> f64 {
    probability / (1.0 - probability).max(f64::MIN_POSITIVE)
}

/// The two ways to add up the trees differ by less than this.
const ROUNDING: f64 = 1e-9;
/// Odds that differ by less than this factor are about equal.
const EQUAL: f64 = std::f64::consts::E;
/// Jambs farther by more than this factor belong to another wall.
const SAME_RANGE: f64 = 1.5;
/// Probability of the best gap: an empty run says that the wall is missing, not how far one could see.
const GAP: f64 = 0.6;
/// Rank of a gap against openings that one sees through.
const GAP_RANK: f64 = 1.0 / 3.0;
