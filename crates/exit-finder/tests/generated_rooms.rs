//! A small part of the generated rooms, so that a change for the worse is noticed. The full measurement is
//! `examples/03_generated_rooms.rs`; its figures are in the README.

mod generator;
mod scoring;

use exit_finder::ExitConfig;
use generator::Kind;
use scoring::{Suite, evaluate};

fn suite() -> Suite {
    Suite {
        kind: Kind::Plain,
        doors: 1..=3,
        dark: false,
        rooms: 40,
        first_seed: 1,
        outliers: 0.0,
        clean: false,
        observed: false,
    }
}

#[test]
fn exits_are_doors_and_most_doors_are_exits() {
    let score = evaluate(&suite().scans(), true, &ExitConfig::default());
    assert!(score.precision() >= 0.9 && score.recall() >= 0.7, "{score}");
    let paper = evaluate(&suite().scans(), true, &ExitConfig::paper());
    assert!(paper.precision() < score.precision() && paper.recall() < score.recall());
}

#[test]
fn closed_rooms_stay_closed() {
    let scans = Suite {
        doors: 0..=0,
        ..suite()
    }
    .scans();
    let score = evaluate(&scans, true, &ExitConfig::default());
    assert!(
        score.silence() >= 0.9,
        "{} of {} rooms silent",
        score.silent,
        score.rooms
    );
}
