//! The default rule: openings are runs that are empty or whose range jumps above their surroundings.

use crate::config::{ExitConfig, RangeAware};
use crate::exit::{Exit, ExitKind, ExitReport, Rejected, Rejection, ScoreParts};
use crate::profile::RangeProfile;
use crate::sector::{Run, circular_runs};
use crate::vector::distance;
use crate::view::ExitView;

use super::edges::continued_wall;
use super::smoothing::{smoothed, surroundings};
use super::unseen::{expected_points, unseen_bins};

pub(super) fn exits(
    profile: RangeProfile,
    rule: &RangeAware,
    view: &ExitView<'_>,
    config: &ExitConfig,
) -> ExitReport {
    let scene = Scene::new(&profile, rule, view, config);
    let mut exits = Vec::new();
    let mut rejected = Vec::new();
    for candidate in scene.candidates() {
        match scene.judge(&candidate) {
            Ok(exit) => exits.push(exit),
            Err(reason) => rejected.push(Rejected {
                sector: candidate.run.sector(scene.n()),
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

/// The smoothed profile with what is known about each bin.
struct Scene<'a> {
    profile: &'a RangeProfile,
    rule: &'a RangeAware,
    config: &'a ExitConfig,
    half: usize,
    ranges: Vec<Option<f64>>,
    ratios: Vec<f64>,
    unseen: Vec<bool>,
}

struct Candidate {
    run: Run,
    kind: ExitKind,
}

impl<'a> Scene<'a> {
    fn new(
        profile: &'a RangeProfile,
        rule: &'a RangeAware,
        view: &ExitView<'_>,
        config: &'a ExitConfig,
    ) -> Self {
        let half = (rule.window / profile.bin_width()).round() as usize;
        let wide = (rule.neighbourhood / profile.bin_width()).round() as usize;
        let ranges = smoothed(profile, half, config.min_count);
        let walls = surroundings(&ranges, wide);
        let ratios = ranges
            .iter()
            .zip(&walls)
            .map(|(range, wall)| range.zip(*wall).map_or(0.0, |(range, wall)| range / wall))
            .collect();
        let unseen = unseen_bins(profile, &ranges, rule, view);
        Self {
            profile,
            rule,
            config,
            half,
            ranges,
            ratios,
            unseen,
        }
    }

    fn n(&self) -> usize {
        self.ranges.len()
    }

    fn candidates(&self) -> Vec<Candidate> {
        let far: Vec<bool> = self
            .ratios
            .iter()
            .map(|&ratio| ratio > self.rule.jump)
            .collect();
        let empty: Vec<bool> = (0..self.n())
            .map(|bin| self.ranges[bin].is_none() && !self.unseen[bin])
            .collect();
        let jumps = circular_runs(&far)
            .into_iter()
            .map(|run| self.half_height(run));
        let jumps = jumps.map(|run| Candidate {
            run,
            kind: ExitKind::RangeJump,
        });
        let gaps = circular_runs(&empty).into_iter();
        let gaps = gaps.map(|run| Candidate {
            run,
            kind: ExitKind::Empty,
        });
        jumps.chain(gaps).collect()
    }

    /// The part of a far run around its peak where the ratio is above the root of the peak's.
    fn half_height(&self, run: Run) -> Run {
        let n = self.n();
        let peak = run.bins(n).map(|bin| self.ratios[bin]).fold(0.0, f64::max);
        let level = peak.sqrt();
        let inside: Vec<usize> = run
            .bins(n)
            .filter(|&bin| self.ratios[bin] >= level)
            .collect();
        match (inside.first(), inside.last()) {
            (Some(&first), Some(&last)) => Run {
                start: first,
                len: (last + n - first) % n + 1,
            },
            _ => run,
        }
    }

    fn judge(&self, candidate: &Candidate) -> Result<Exit, Rejection> {
        let run = candidate.run;
        let parts = match candidate.kind {
            ExitKind::RangeJump => self.jump_parts(run)?,
            ExitKind::Empty => self.gap_parts(run)?,
        };
        let exit = self.exit_of(candidate, parts);
        match self.config.min_width {
            Some(needed) if exit.width < needed => Err(Rejection::TooNarrow {
                width: exit.width,
                needed,
            }),
            _ => Ok(exit),
        }
    }

    fn jump_parts(&self, run: Run) -> Result<ScoreParts, Rejection> {
        let edge_jump = self.edge_jump(run, false).max(self.edge_jump(run, true));
        let needed = self.rule.edge_jump;
        if edge_jump < needed {
            return Err(Rejection::NoEdge { edge_jump, needed });
        }
        let points: usize = run
            .bins(self.n())
            .map(|bin| self.profile.bins[bin].count)
            .sum();
        Ok(ScoreParts {
            jump: 1.0 - 1.0 / edge_jump,
            support: support(points as f64),
            width: 1.0,
        })
    }

    fn gap_parts(&self, run: Run) -> Result<ScoreParts, Rejection> {
        let expected = expected_points(self.profile, run, self.half);
        let needed = self.rule.min_expected;
        if expected < needed {
            return Err(Rejection::Unsupported { expected, needed });
        }
        Ok(ScoreParts {
            jump: 0.5,
            support: support(expected),
            width: 1.0,
        })
    }

    /// Ratio of the seen range to the continued wall at one edge; 0 where there is no wall.
    fn edge_jump(&self, run: Run, at_end: bool) -> f64 {
        let n = self.n();
        let reach = 3 * self.half.max(1);
        let outside = |k: usize| {
            let bin = if at_end {
                run.start + run.len + k
            } else {
                run.start + n - 1 - k + n
            };
            self.ranges[bin % n]
        };
        let wall: Vec<Option<f64>> = (0..reach.min(n)).map(outside).collect();
        let middle = run.len as f64 / 2.0;
        let mut inside: Vec<f64> = run.bins(n).filter_map(|bin| self.ranges[bin]).collect();
        match (
            continued_wall(&wall, -middle),
            crate::profile::median(&mut inside),
        ) {
            (Some(inverse), Some(seen)) => inverse * seen,
            _ => 0.0,
        }
    }

    fn exit_of(&self, candidate: &Candidate, mut parts: ScoreParts) -> Exit {
        let profile = self.profile;
        let sector = candidate.run.sector(self.n());
        let [before, after] = self.jamb_ranges(candidate.run);
        let jambs = [
            profile.at(sector.start_rad, before),
            profile.at(sector.start_rad + sector.width_rad, after),
        ];
        let width = distance(jambs[0], jambs[1]);
        if let Some(needed) = self.config.min_width {
            parts.width = width / (width + 0.5 * needed);
        }
        let bearing_rad = sector.middle_rad();
        let range = before.min(after) * (1.0 + self.rule.beyond);
        Exit {
            direction: profile.direction(bearing_rad),
            bearing_rad,
            position: profile.at(bearing_rad, range),
            sector,
            width_rad: sector.width_rad,
            width,
            jambs,
            range,
            kind: candidate.kind,
            score: parts.jump * parts.support * parts.width,
            parts,
        }
    }

    /// Range of the wall just outside each edge; where nothing was seen, that of the other edge.
    fn jamb_ranges(&self, run: Run) -> [f64; 2] {
        let n = self.n();
        let near = |first: usize, step: usize| {
            (0..=self.half).find_map(|k| self.ranges[(first + k * step) % n])
        };
        let before = near(run.start + n - 1, n - 1);
        let after = near(run.start + run.len, 1);
        let usual = self.profile.median_range;
        [
            before.or(after).unwrap_or(usual),
            after.or(before).unwrap_or(usual),
        ]
    }
}

/// Grows from 0 to 1 with the number of points that speak for an opening.
fn support(points: f64) -> f64 {
    1.0 - (-points / 8.0).exp()
}
