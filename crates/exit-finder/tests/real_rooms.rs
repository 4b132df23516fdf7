//! The real room scans: the labelled openings are found, and unseen sectors are not sold as exits.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod real;

use exit_finder::{AffinePlane, ExitConfig, ExitReport, ExitView, find_exits};

fn search(points: &[[f64; 3]]) -> ExitReport {
    let agent = [0.0; 3];
    let plane = AffinePlane::from_up([0.0, -1.0, 0.0], agent).unwrap();
    find_exits(
        points,
        agent,
        &plane,
        &ExitView::default(),
        &ExitConfig::default(),
    )
    .unwrap()
}

#[test]
fn the_best_exit_lies_in_the_labelled_opening() {
    for room in real::ROOMS {
        let (Some(opening), Some(points)) = (room.opening, real::load(room.name)) else {
            continue;
        };
        let report = search(&points);
        let best = report.best().expect(room.name);
        let off = real::outside(best.bearing_rad, opening);
        assert!(
            off <= 3.0,
            "{}: best exit is {off:.1} degrees outside",
            room.name
        );
    }
}

#[test]
fn a_partial_scan_sells_no_unseen_sector() {
    for room in real::ROOMS {
        let Some(points) = real::load(room.name) else {
            continue;
        };
        let report = search(&points);
        if room.opening.is_none() {
            let unseen: f64 = report.unseen.iter().map(|sector| sector.width_rad).sum();
            assert!(unseen > 3.5, "{}: {:?}", room.name, report.unseen);
        }
        for exit in &report.exits {
            let overlap = report
                .unseen
                .iter()
                .any(|sector| sector.contains(exit.bearing_rad));
            assert!(!overlap, "{}: {:?}", room.name, exit.sector);
        }
    }
}
