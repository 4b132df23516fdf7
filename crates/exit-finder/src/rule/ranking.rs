//! The order of exits: best score, then smallest turn from the heading, then smallest bearing.

use crate::angle::turn;
use crate::exit::ExitReport;
use crate::view::ExitView;

/// Scores closer than this are equal.
const TIE: f64 = 1e-9;

pub(super) fn rank(report: &mut ExitReport, view: &ExitView<'_>) {
    let heading = view
        .heading
        .and_then(|heading| report.profile.plane.bearing(heading));
    let key = |bearing: f64, score: f64| {
        let turned = heading.map_or(0.0, |heading| turn(heading, bearing).abs());
        ((score / TIE).round(), turned, bearing)
    };
    report.exits.sort_by(|a, b| {
        let (a_score, a_turn, a_bearing) = key(a.bearing_rad, a.score);
        let (b_score, b_turn, b_bearing) = key(b.bearing_rad, b.score);
        b_score
            .total_cmp(&a_score)
            .then(a_turn.total_cmp(&b_turn))
            .then(a_bearing.total_cmp(&b_bearing))
    });
    report
        .rejected
        .sort_by(|a, b| a.sector.start_rad.total_cmp(&b.sector.start_rad));
    report
        .unseen
        .sort_by(|a, b| a.start_rad.total_cmp(&b.start_rad));
}
