//! Exits of generated rooms after the project's own outlier removal: precision, recall and silence at three outlier rates.
//!
//! `cargo run --release -p examples --example exits_of_generated_rooms [-- FIRST_SEED [ROOMS]]`
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../crates/exit-finder/tests/generator/mod.rs"]
mod generator;
#[path = "../crates/exit-finder/tests/scoring/mod.rs"]
mod scoring;

use exit_finder::ExitConfig;
use generator::Scan;
use scoring::{Suite, evaluate};
use submodular_minimax::{OutlierConfig, Views, remove_outliers};

/// What is done to a cloud before the search.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Cleaning {
    Off,
    /// Points alone.
    Blind,
    /// With the place they were seen from.
    FromPosition,
    /// The same with distances divided by a higher power of the range: far points behind doors are sparser.
    ForExits,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let argument = |k: usize, otherwise: u64| {
        let given = std::env::args().nth(k);
        given.map_or(Ok(otherwise), |text| text.parse::<u64>())
    };
    let (first_seed, rooms) = (argument(1, 1)?, argument(2, 200)?);
    println!(
        "percent          |  scale known          |  scale unknown        | found of   |        | found of | sectors | closed rooms"
    );
    println!(
        "outliers         |  P      R      best   |  P      R      best   | 20 1 m off | oracle | oracle's | agree   | silent"
    );
    for outliers in [0.0, 0.1, 0.2] {
        for cleaning in [
            Cleaning::Off,
            Cleaning::Blind,
            Cleaning::FromPosition,
            Cleaning::ForExits,
        ] {
            let suite = |doors, first_seed| Suite {
                doors,
                dark: false,
                rooms,
                first_seed,
                outliers,
                clean: false,
            };
            let open = cleaned(suite(1..=3, first_seed).scans(), cleaning)?;
            let closed = cleaned(suite(0..=0, first_seed + 100_000).scans(), cleaning)?;
            let config = ExitConfig::default();
            let [known, unknown] = [true, false].map(|known| evaluate(&open, known, &config));
            println!(
                "{:3.0} {cleaning:12?} {} {} {:6.1} {:6.1} {:6.1} {:6.1} {:6.1}",
                100.0 * outliers,
                row(&known),
                row(&unknown),
                100.0 * known.recall_seen_through(),
                100.0 * known.oracle(),
                100.0 * known.recall_evident(),
                100.0 * known.agreement(),
                100.0 * evaluate(&closed, true, &config).silence(),
            );
        }
    }
    Ok(())
}

fn row(score: &scoring::Score) -> String {
    let [p, r, b] = [score.precision(), score.recall(), score.best()].map(|x| 100.0 * x);
    format!("{p:6.1} {r:6.1} {b:6.1} ")
}

fn cleaned(
    mut scans: Vec<Scan>,
    cleaning: Cleaning,
) -> Result<Vec<Scan>, Box<dyn std::error::Error>> {
    for scan in &mut scans {
        let views = match cleaning {
            Cleaning::Off => continue,
            Cleaning::Blind => None,
            Cleaning::FromPosition | Cleaning::ForExits => {
                Some(Views::from_position(scan.agent, scan.points.len())?)
            }
        };
        let mut config = OutlierConfig::default();
        if cleaning == Cleaning::ForExits {
            config.rays.one_position.range_exponent = 1.4;
        }
        scan.keep(&remove_outliers(&scan.points, views.as_ref(), &config)?.kept);
    }
    Ok(scans)
}
