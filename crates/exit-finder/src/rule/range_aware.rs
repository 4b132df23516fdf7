//! The default rule: openings are runs that are empty or whose range jumps above their surroundings.
//!
//! 1. Smooth the profile into a contour of the room (`contour`).
//! 2. Flag the bins that were never looked at (`unseen`).
//! 3. Range jumps: sectors with points deep behind the line between their edges, and behind the walls
//!    beside them continued (`matched`).
//! 4. Gaps: empty runs where walls are so evenly textured that a wall would have shown.
//! 5. Turn down what is too narrow.

use super::contour::Contour;
use super::evidence::ScoreParts;
use super::matched;
use super::unseen::{points_elsewhere, unseen_bins};
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
    let (mut exits, mut rejected) = (Vec::new(), Vec::new());
    for (run, verdict) in scene.jumps().into_iter().chain(scene.gaps()) {
        match verdict {
            Ok(exit) => exits.push(exit),
            Err(reason) => rejected.push(Rejected {
                sector: run.sector(scene.n()),
                reason,
            }),
        }
    }
    let unseen = circular_runs(&scene.unseen)
        .into_iter()
        .map(|run| run.sector(scene.n()))
        .collect();
    ExitReport {
        exits,
        unseen,
        rejected,
        profile,
    }
}

type Verdict = (Run, Result<Exit, Rejection>);

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

    fn jumps(&self) -> Vec<Verdict> {
        let found = matched::matches(
            self.profile,
            &self.contour,
            &self.unseen,
            self.rule,
            self.needed,
        );
        let judge = |found: matched::Match| {
            let exit = self.exit_of(found.run, ExitKind::RangeJump, found.evidence.parts());
            (found.run, self.wide_enough(exit, found.width))
        };
        found.into_iter().map(judge).collect()
    }

    fn gaps(&self) -> Vec<Verdict> {
        let empty: Vec<bool> = (0..self.n())
            .map(|bin| self.contour.ranges[bin].is_none() && !self.unseen[bin])
            .collect();
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
        let [a, b] = self.jambs(run);
        let width = distance(a, b);
        let support = 1.0 - (-expected / 8.0).exp();
        let passable = width / (width + 0.5 * self.needed).max(f64::MIN_POSITIVE);
        let parts = ScoreParts::of_support(GAP * support * passable);
        let exit = self.exit_of(run, ExitKind::Empty, parts);
        self.wide_enough(exit, width)
    }

    fn wide_enough(&self, exit: Exit, width: f64) -> Result<Exit, Rejection> {
        if width < self.needed {
            return Err(Rejection::TooNarrow {
                width,
                needed: self.needed,
            });
        }
        Ok(exit)
    }

    fn exit_of(&self, run: Run, kind: ExitKind, parts: ScoreParts) -> Exit {
        let profile = self.profile;
        let sector = run.sector(self.n());
        let jambs = self.jambs(run);
        let bearing_rad = sector.middle_rad();
        let score = match kind {
            ExitKind::RangeJump => parts.score(),
            ExitKind::Empty => GAP_RANK * parts.probability(),
        };
        let [before, after] = jambs.map(|jamb| distance(jamb, profile.agent));
        let range = before.min(after) * (1.0 + self.rule.beyond);
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

    /// The wall just outside each edge, at the edge; the median range where none was seen.
    fn jambs(&self, run: Run) -> [[f64; 3]; 2] {
        let sector = run.sector(self.n());
        let usual = self.profile.median_range;
        let ranges = self
            .contour
            .jamb_ranges(run.start, run.len)
            .unwrap_or([usual, usual]);
        let ends = [sector.start_rad, sector.start_rad + sector.width_rad];
        [0, 1].map(|k| self.profile.at(ends[k], ranges[k]))
    }
}

/// Probability of the best gap: an empty run says that the wall is missing, not how far one could see.
const GAP: f64 = 0.6;
/// Rank of a gap: as if one saw half as far again as around.
const GAP_RANK: f64 = 1.0 / 3.0;
