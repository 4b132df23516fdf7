//! Outlier removal on clouds with known truth: every reading, and the default from seed to seed.
//!
//! `cargo run --release -p submodular-minimax --example 02_measure_synthetic_clouds`
//!
//! Apartments from seeds (5 % to 25 % outliers, 1,000 to 100,000 points, clean ones too) and, if the
//! data folder is there, the synthetic apartment that they imitate. Clean clouds show the
//! false-positive rate. The last tables give the default's least, mean and largest F1 over ten seeds, and the share
//! removed of clean clouds, of apartments and of rooms full of boxes.
//! Against what others use: `compare_outlier_removal --generated` in the workspace's examples.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/labelled/mod.rs"]
mod labelled;

use labelled::apartment::Apartment;
use labelled::room::Room;
use labelled::{Labelled, average_precision, f1, false_positive_rate};
use std::error::Error;
use submodular_minimax::{OutlierConfig, remove_outliers};

fn main() -> Result<(), Box<dyn Error>> {
    let mut clouds: Vec<Labelled> = labelled::apartment_of_the_data_folder()
        .into_iter()
        .collect();
    for (points, outliers) in KINDS {
        clouds.push(make(points, outliers, 11));
    }
    let clean = [
        make(10_000, 0.0, 11),
        make(10_000, 0.0, 12),
        make(50_000, 0.0, 11),
    ];
    println!("F1 (last three: share removed of a clean cloud)");
    for cloud in clouds.iter().chain(&clean) {
        println!("  {}", cloud.name);
    }
    for (name, config) in [
        ("D nearest", OutlierConfig::nearest()),
        ("F supported", OutlierConfig::supported()),
        ("G connected", OutlierConfig::connected()),
        ("default", OutlierConfig::default()),
    ] {
        print!("{name:34}");
        for cloud in &clouds {
            let found = remove_outliers(&cloud.points, None, &config)?;
            print!(" {:.3}", f1(&found.removed, &cloud.outlier));
        }
        for cloud in &clean {
            let found = remove_outliers(&cloud.points, None, &config)?;
            print!(
                " {:.3}",
                false_positive_rate(&found.removed, &cloud.outlier)
            );
        }
        println!();
    }
    print!("{:34}", "default, average precision");
    for cloud in &clouds {
        let found = remove_outliers(&cloud.points, None, &OutlierConfig::default())?;
        print!(" {:.3}", average_precision(&found.scores, &cloud.outlier));
    }
    println!();
    spread_over_seeds()
}

/// Points and share of outliers.
const KINDS: [(usize, f64); 9] = [
    (1_000, 0.15),
    (2_000, 0.05),
    (2_000, 0.25),
    (10_000, 0.05),
    (10_000, 0.15),
    (10_000, 0.25),
    (50_000, 0.05),
    (50_000, 0.15),
    (100_000, 0.25),
];

/// How the default fares from seed to seed.
fn spread_over_seeds() -> Result<(), Box<dyn Error>> {
    println!("the default over seeds 11 to 20, apartments; rooms: least, mean, largest F1");
    for (points, outliers) in SMALL.into_iter().chain(KINDS) {
        let percent = 100.0 * outliers;
        let apartments = over_seeds(f1, |seed| make(points, outliers, seed))?;
        let rooms = over_seeds(f1, |seed| room(points, outliers, seed))?;
        println!("  n={points} outliers={percent:.0} %: {apartments}; {rooms}");
    }
    println!("of clean ones the least, mean and largest share removed");
    for points in [500, 1_000, 2_000, 10_000] {
        let apartments = over_seeds(false_positive_rate, |seed| make(points, 0.0, seed))?;
        let rooms = over_seeds(false_positive_rate, |seed| room(points, 0.0, seed))?;
        println!("  n={points}: {apartments}; {rooms}");
    }
    Ok(())
}

/// Points and share of outliers of more small clouds.
const SMALL: [(usize, f64); 3] = [(500, 0.15), (1_000, 0.05), (1_000, 0.25)];

/// The least, mean and largest of what ten seeds make of the default.
fn over_seeds(
    measure: impl Fn(&[usize], &[Option<bool>]) -> f64,
    cloud: impl Fn(u64) -> Labelled,
) -> Result<String, Box<dyn Error>> {
    let mut values = Vec::new();
    for seed in 11..=20 {
        let cloud = cloud(seed);
        let found = remove_outliers(&cloud.points, None, &OutlierConfig::default())?;
        values.push(measure(&found.removed, &cloud.outlier));
    }
    values.sort_by(f64::total_cmp);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let (least, most) = (values[0], values[values.len() - 1]);
    Ok(format!("{least:.3} {mean:.3} {most:.3}"))
}

fn room(points: usize, outliers: f64, seed: u64) -> Labelled {
    let kind = Room {
        points,
        outliers,
        patches: 100 + points / 50,
        seed,
    };
    kind.make()
}

fn make(points: usize, outliers: f64, seed: u64) -> Labelled {
    let kind = Apartment {
        points,
        outliers,
        seed,
    };
    kind.make()
}
