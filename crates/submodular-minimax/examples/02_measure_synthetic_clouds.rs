//! Outlier removal on clouds with known truth: the default against baselines at their best setting.
//!
//! `cargo run --release -p submodular-minimax --example 02_measure_synthetic_clouds`
//!
//! Rooms from a seed (2 % to 25 % outliers, 3,000 to 100,000 points, clean ones too) and, if the
//! data folder is there, the synthetic apartment. Clean clouds show the false-positive rate.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/labelled/mod.rs"]
mod labelled;
#[path = "../tests/labelled/baselines.rs"]
mod settings;

use labelled::room::Room;
use labelled::{Labelled, f1, false_positive_rate};
use std::error::Error;
use submodular_minimax::{OutlierConfig, remove_outliers};

fn main() -> Result<(), Box<dyn Error>> {
    let room = |points, outliers, patches| {
        Room {
            points,
            outliers,
            patches,
            seed: 7,
        }
        .make()
    };
    let mut clouds: Vec<Labelled> = labelled::apartment().into_iter().collect();
    clouds.push(room(10_000, 0.05, 400));
    clouds.push(room(10_000, 0.15, 400));
    clouds.push(room(10_000, 0.25, 400));
    clouds.push(room(3_000, 0.15, 300));
    clouds.push(room(50_000, 0.15, 1_500));
    clouds.push(room(50_000, 0.05, 400));
    let clean = [
        room(10_000, 0.0, 400),
        room(50_000, 0.0, 400),
        room(2_000, 0.0, 200),
    ];
    println!("F1 (last three: share removed of a clean cloud)");
    for cloud in clouds.iter().chain(&clean) {
        println!("  {}", cloud.name);
    }
    for family in settings::families() {
        let (name, row) = settings::best_fixed(&family, &clouds)?;
        print!("{name:34}");
        row.iter().for_each(|(f1, _)| print!(" {f1:.3}"));
        let run = family
            .iter()
            .find(|c| c.0 == name)
            .ok_or("the best is in the family")?;
        for cloud in &clean {
            let removed = run.1(&cloud.points)?.removed;
            print!(" {:.3}", false_positive_rate(&removed, &cloud.outlier));
        }
        println!();
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
    Ok(())
}
