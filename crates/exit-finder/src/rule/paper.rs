//! Algorithm 2: the longest run of bins with at most one point is the exit.

use std::f64::consts::TAU;

use crate::config::{ExitConfig, GapTopology, Numbering, PaperReading};
use crate::exit::{Exit, ExitKind, ExitReport, Rejected, Rejection};
use crate::profile::RangeProfile;
use crate::rule::ScoreParts;
use crate::sector::{Run, circular_runs, linear_runs};
use crate::vector::distance;

/// Every run is returned; the longest, which is the paper's exit, has the best score.
pub(super) fn exits(
    profile: RangeProfile,
    reading: &PaperReading,
    config: &ExitConfig,
) -> ExitReport {
    let mut exits = Vec::new();
    let mut rejected = Vec::new();
    for run in empty_runs(&profile, reading, config.min_count) {
        let exit = exit_of(&profile, run);
        match config.min_width {
            Some(needed) if exit.width < needed => rejected.push(Rejected {
                sector: exit.sector,
                reason: Rejection::TooNarrow {
                    width: exit.width,
                    needed,
                },
            }),
            _ => exits.push(exit),
        }
    }
    ExitReport {
        exits,
        unseen: Vec::new(),
        rejected,
        profile,
    }
}

fn empty_runs(profile: &RangeProfile, reading: &PaperReading, min_count: usize) -> Vec<Run> {
    let n = profile.bins.len();
    let first = match reading.numbering {
        Numbering::FromOne => 1,
        Numbering::FromZero => 0,
    };
    // Entry k is the paper's bin number k + first; number n is the never filled [360°, 361°).
    let empty: Vec<bool> = (first..n + first)
        .map(|number| number == n || profile.bins[number].count < min_count)
        .collect();
    let runs = match reading.gap {
        GapTopology::Linear => linear_runs(&empty),
        GapTopology::Circular => circular_runs(&empty),
    };
    runs.into_iter()
        .map(|run| Run {
            start: run.start + first,
            ..run
        })
        .collect()
}

fn exit_of(profile: &RangeProfile, run: Run) -> Exit {
    let n = profile.bins.len();
    let sector = run.sector(n);
    let bearing_rad = sector.middle_rad();
    let before = profile.bins[(run.start + n - 1) % n].mean;
    let after = profile.bins[(run.start + run.len) % n].mean;
    let jamb_range = if run.len >= n {
        f64::INFINITY
    } else {
        before.min(after)
    };
    let jamb_range = if jamb_range.is_finite() {
        jamb_range
    } else {
        profile.radius
    };
    let jambs = [sector.start_rad, sector.start_rad + sector.width_rad]
        .map(|bearing| profile.at(bearing, jamb_range));
    let score = sector.width_rad / TAU;
    Exit {
        direction: profile.direction(bearing_rad),
        bearing_rad,
        position: profile.at(bearing_rad, profile.radius),
        sector,
        width_rad: sector.width_rad,
        width: distance(jambs[0], jambs[1]),
        jambs,
        range: profile.radius,
        kind: ExitKind::Empty,
        score,
        parts: ScoreParts::default(),
    }
}
