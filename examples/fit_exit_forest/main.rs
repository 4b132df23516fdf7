//! Fits the score of `exit-finder`'s range-aware rule on generated rooms and prints it as Rust source.
//!
//! `cargo run --release -p examples --example fit_exit_forest [-- FIRST_SEED [ROOMS]] > crates/exit-finder/src/rule/forest.rs`
//!
//! Rooms with one to three doors and as many closed rooms, at outlier rates of 0, 10 and 20 %: of every twelve, eight plain,
//! two with curved walls, one whose openings lie above counters and one whose doors reach up to the ceiling. Each is looked
//! at as it is, cleaned from the position, cleaned with what was taken out as doubtful points, and as a camera with a narrow
//! view would see it. Each candidate that the rule would consider is one example; it is right when the middle of its sector
//! lies in an opening, three degrees to spare. The default seeds are disjoint from those that the README reports.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "an example prints its result"
)]

mod boosting;
#[path = "../../crates/exit-finder/tests/generator/mod.rs"]
mod generator;

use std::f64::consts::TAU;

use boosting::Forest;
use exit_finder::{
    AffinePlane, CUES, ExitConfig, ExitView, Opening, RangeProfile, candidates_of_profile,
};
use generator::{Kind, Scan, corrupted, scan};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use submodular_minimax::{Cues, OutlierConfig, Views, remove_outliers};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Half the view of a narrow camera, height over range.
const NARROW: f64 = 0.2;

/// Candidates as cues, and whether each is a door.
type Examples = (Vec<[f64; CUES]>, Vec<bool>);

fn main() -> Outcome<()> {
    let argument = |k: usize, otherwise: u64| {
        let given = std::env::args().nth(k);
        given.map_or(Ok(otherwise), |text| text.parse::<u64>())
    };
    let (first_seed, rooms) = (argument(1, 60_000)?, argument(2, 1800)?);
    let gather = |outliers| move || examples(first_seed..first_seed + rooms, outliers);
    let parts = std::thread::scope(|scope| {
        let parts = [0.0, 0.1, 0.2].map(|outliers| scope.spawn(gather(outliers)));
        parts.map(|part| part.join().map_err(|_| "a thread failed"))
    });
    let (mut cues, mut right) = (Vec::new(), Vec::new());
    for part in parts {
        let (more_cues, more_right) = part??;
        cues.extend(more_cues);
        right.extend(more_right);
    }
    eprintln!("{} candidates", cues.len());
    print(&Forest::fit(&cues, &right));
    Ok(())
}

/// All candidates of the rooms with these seeds and of as many closed ones.
fn examples(seeds: std::ops::Range<u64>, outliers: f64) -> Result<Examples, String> {
    let (mut cues, mut right) = (Vec::new(), Vec::new());
    for seed in seeds {
        let kind = match seed % 12 {
            0..8 => Kind::Plain,
            8 | 9 => Kind::Curved,
            10 => Kind::Counter,
            _ => Kind::Tall,
        };
        for (seed, doors) in [(seed, 1..=3), (seed + 100_000, 0..=0)] {
            let mut rng = Pcg64::seed_from_u64(seed);
            let doors = rng.random_range(doors);
            let mut scan = scan(kind, doors, false, &mut rng);
            scan.points = corrupted(&scan.points, scan.agent, outliers, &mut rng);
            let candidates = views(&scan).map_err(|error| error.to_string())?;
            for (opening, is_door) in candidates {
                cues.push(opening.cues);
                right.push(is_door);
            }
        }
    }
    Ok((cues, right))
}

/// The candidates of one scan in the four ways it is looked at.
fn views(scan: &Scan) -> Outcome<Vec<(Opening, bool)>> {
    let [kept, taken_out] = cleaned(scan)?;
    let slope = |p: &&[f64; 3]| {
        let d: [f64; 3] = std::array::from_fn(|i| p[i] - scan.agent[i]);
        d[2].abs() <= NARROW * d[0].hypot(d[1])
    };
    let narrow: Vec<[f64; 3]> = scan.points.iter().filter(slope).copied().collect();
    let views: [(&[_], &[_]); 4] = [
        (&scan.points, &[]),
        (&kept, &[]),
        (&kept, &taken_out),
        (&narrow, &[]),
    ];
    let mut found = Vec::new();
    for (points, doubtful) in views {
        found.extend(candidates(scan, points, doubtful)?);
    }
    Ok(found)
}

/// Points kept and taken out, with the ranges normalised as for the search for exits, see the README of `exit-finder`.
fn cleaned(scan: &Scan) -> Outcome<[Vec<[f64; 3]>; 2]> {
    let views = Views::from_position(scan.agent, scan.points.len())?;
    let mut config = OutlierConfig::default();
    config.rays.one_position = Cues::one_position();
    config.rays.one_position.range_exponent = 1.4;
    let cleaning = remove_outliers(&scan.points, Some(&views), &config)?;
    let points = |indices: Vec<usize>| {
        indices
            .into_iter()
            .map(|index| scan.points[index])
            .collect()
    };
    Ok([points(cleaning.kept), points(cleaning.removed)])
}

/// Candidates wide enough for a drone of 0.6 m, and whether each is a door.
fn candidates(
    scan: &Scan,
    points: &[[f64; 3]],
    doubtful: &[[f64; 3]],
) -> Outcome<Vec<(Opening, bool)>> {
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], scan.agent)?;
    let config = ExitConfig::default();
    let profile = RangeProfile::of_cleaned(points, doubtful, &[], scan.agent, &plane, &config)?;
    let spare = 3f64.to_radians();
    let is_door = |opening: &Opening| {
        let bearing = plane.direction({
            let (sin, cos) = opening.sector.middle_rad().sin_cos();
            [cos, sin]
        });
        let bearing = bearing[1].atan2(bearing[0]);
        scan.openings
            .iter()
            .any(|door| (bearing - door.start + spare).rem_euclid(TAU) < door.width + 2.0 * spare)
    };
    let found = candidates_of_profile(&profile, &ExitView::default(), &config)?;
    let wide = found
        .into_iter()
        .filter(|opening| opening.width >= 0.6 * scan.scale);
    Ok(wide
        .map(|opening| {
            let is_door = is_door(&opening);
            (opening, is_door)
        })
        .collect())
}

fn print(forest: &Forest) {
    println!(
        "//! The fitted trees; printed by `cargo run --release -p examples --example fit_exit_forest`."
    );
    println!("#![allow(clippy::approx_constant, reason = \"fitted numbers\")]\n");
    println!("use super::score::Tree;\n");
    println!("/// Log odds of a candidate whose parts are all zero.");
    println!("pub(super) const BASE: f64 = {:?};\n", forest.base());
    println!("#[rustfmt::skip]");
    println!(
        "pub(super) static TREES: [Tree; {}] = [",
        forest.trees.len()
    );
    for tree in &forest.trees {
        let most = tree.most.map(|x| format!("{x:?}")).join(", ");
        let leaf = tree.leaf.map(|x| format!("{x:?}")).join(", ");
        println!(
            "    Tree {{ cue: {:?}, most: [{most}], leaf: [{leaf}] }},",
            tree.cue
        );
    }
    println!("];");
}
