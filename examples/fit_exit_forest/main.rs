//! Fits the score of `exit-finder`'s range-aware rule on generated rooms and prints it as Rust source.
//!
//! `cargo run --release -p examples --example fit_exit_forest [-- FIRST_SEED [ROOMS]] > crates/exit-finder/src/rule/forest.rs`
//! `cargo run --release -p examples --example fit_exit_forest -- 30000 6500 second > crates/exit-finder/src/rule/second_forest.rs`
//!
//! Rooms with one to three doors and as many closed rooms, at outlier rates of 0, 10 and 20 %: of every twelve, eight plain,
//! two with curved walls, one whose openings lie above counters and one whose doors reach up to the ceiling. Each is looked
//! at as it is, cleaned from the position, cleaned with what was taken out as doubtful points, and as a camera with a narrow
//! view would see it. Each candidate that the rule would consider is one example; it is right when the middle of its sector
//! lies in an opening, three degrees to spare. The default seeds are disjoint from those that the README reports.
//!
//! The forest of the second look is fitted on the same kinds of rooms as maps with observations, cleaned by them. It asks for the
//! probability by the first one, which must have been fitted on other rooms.
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
    AffinePlane, CUES, ExitConfig, ExitView, Opening, RangeProfile, SECOND_CUES,
    candidates_of_cleaned, candidates_of_profile,
};
use generator::{Kind, Scan, corrupted, scan};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use submodular_minimax::{Cues, OutlierConfig, Views, remove_outliers};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Half the view of a narrow camera, height over range.
const NARROW: f64 = 0.2;

/// Candidates as cues, and whether each is a door.
type Examples<const CUES: usize> = (Vec<[f64; CUES]>, Vec<bool>);

fn main() -> Outcome<()> {
    let argument = |k: usize, otherwise: u64| {
        let given = std::env::args().nth(k);
        given.map_or(Ok(otherwise), |text| text.parse::<u64>())
    };
    let (first_seed, rooms) = (argument(1, 60_000)?, argument(2, 1800)?);
    let seeds = first_seed..first_seed + rooms;
    match std::env::args().nth(3).as_deref() {
        None => {
            let (cues, right) = gathered::<CUES>(seeds, first_looks)?;
            print(&Forest::<15, 16>::fit(&cues, &right, 300), "");
        }
        Some("second") => {
            let (cues, right) = gathered::<SECOND_CUES>(seeds, second_looks)?;
            print(
                &Forest::<31, 32>::fit(&cues, &right, 500),
                " -- 30000 6500 second",
            );
        }
        Some(other) => return Err(format!("{other}: give `second` or nothing").into()),
    }
    Ok(())
}

/// How a scan is looked at: candidates, and whether each is a door.
type Look<const CUES: usize> = fn(Scan, &mut Pcg64) -> Outcome<Examples<CUES>>;

/// The candidates of all rooms at the three rates of outliers, each on its thread.
fn gathered<const CUES: usize>(
    seeds: std::ops::Range<u64>,
    look: Look<CUES>,
) -> Outcome<Examples<CUES>> {
    let gather = |outliers| {
        let seeds = seeds.clone();
        move || examples(seeds, outliers, look).map_err(|error| error.to_string())
    };
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
    Ok((cues, right))
}

/// All candidates of the rooms with these seeds and of as many closed ones.
fn examples<const CUES: usize>(
    seeds: std::ops::Range<u64>,
    outliers: f64,
    look: Look<CUES>,
) -> Outcome<Examples<CUES>> {
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
            let (more_cues, more_right) = look(scan, &mut rng)?;
            cues.extend(more_cues);
            right.extend(more_right);
        }
    }
    Ok((cues, right))
}

fn first_looks(scan: Scan, _: &mut Pcg64) -> Outcome<Examples<CUES>> {
    let found = views(&scan)?.into_iter();
    Ok(found
        .map(|(opening, is_door)| (opening.cues, is_door))
        .unzip())
}

fn second_looks(mut scan: Scan, rng: &mut Pcg64) -> Outcome<Examples<SECOND_CUES>> {
    scan.observe(rng);
    let views = Views::new(scan.viewpoints(), scan.observers.clone())?;
    let cleaning = remove_outliers(&scan.points, Some(&views), &OutlierConfig::default())?;
    scan.keep_and_doubt(&cleaning.kept);
    let rays = scan.rays();
    let view = ExitView {
        doubtful: &scan.doubtful,
        rays: &rays,
        ..ExitView::default()
    };
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], scan.agent)?;
    // A narrow candidate is no company of wider ones, see `SECOND_CUES`.
    let config = ExitConfig {
        min_width: Some(0.6 * scan.scale),
        ..ExitConfig::default()
    };
    let found = candidates_of_cleaned(&scan.points, scan.agent, &plane, &view, &config)?;
    let wide = found
        .into_iter()
        .filter(|look| look.opening.width >= 0.6 * scan.scale);
    Ok(wide
        .map(|look| (look.cues, is_door(&look.opening, &scan, &plane)))
        .unzip())
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
    let found = candidates_of_profile(&profile, &ExitView::default(), &config)?;
    let wide = found
        .into_iter()
        .filter(|opening| opening.width >= 0.6 * scan.scale);
    Ok(wide
        .map(|opening| {
            let is_door = is_door(&opening, scan, &plane);
            (opening, is_door)
        })
        .collect())
}

/// Whether the middle of a candidate lies in an opening.
fn is_door(opening: &Opening, scan: &Scan, plane: &AffinePlane) -> bool {
    let spare = 3f64.to_radians();
    let (sin, cos) = opening.sector.middle_rad().sin_cos();
    let direction = plane.direction([cos, sin]);
    let bearing = direction[1].atan2(direction[0]);
    scan.openings
        .iter()
        .any(|door| (bearing - door.start + spare).rem_euclid(TAU) < door.width + 2.0 * spare)
}

fn print<const NODES: usize, const LEAVES: usize>(forest: &Forest<NODES, LEAVES>, arguments: &str) {
    println!(
        "//! The fitted trees; printed by `cargo run --release -p examples --example fit_exit_forest{arguments}`."
    );
    println!("#![allow(clippy::approx_constant, reason = \"fitted numbers\")]\n");
    let kind = if LEAVES == 16 { "Shallow" } else { "Deep" };
    println!("use super::score::{kind};\n");
    println!("/// Log odds of a candidate whose parts are all zero.");
    println!("pub(super) const BASE: f64 = {:?};\n", forest.base());
    println!("#[rustfmt::skip]");
    println!(
        "pub(super) static TREES: [{kind}; {}] = [",
        forest.trees.len()
    );
    for pair in forest.trees.chunks(2) {
        let trees = pair.iter().map(|tree| {
            let most = tree.most.map(|x| format!("{x:?}")).join(", ");
            let leaf = tree.leaf.map(|x| format!("{x:?}")).join(", ");
            let cue = tree.cue;
            format!("{kind} {{ cue: {cue:?}, most: [{most}], leaf: [{leaf}] }},")
        });
        println!("    {}", trees.collect::<Vec<_>>().join(" "));
    }
    println!("];");
}
