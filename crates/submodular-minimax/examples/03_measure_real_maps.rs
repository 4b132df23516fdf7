//! Outlier removal on labelled maps: every reading, and the default with one part of it taken away.
//!
//! `cargo run --release -p submodular-minimax --example 03_measure_real_maps [MAP_FOLDER ...]`
//!
//! A map folder holds map.ply, keyframes.csv, observations.csv.gz and depth_check.csv; without
//! arguments the maps of the data folder are read. A point is an outlier if its depth differs by
//! more than 20 % from the depth sensor's. Against what others use: `compare_outlier_removal` in the
//! workspace's examples.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/labelled/mod.rs"]
mod labelled;

use labelled::{Labelled, average_precision, f1, false_positive_rate};
use std::error::Error;
use submodular_minimax::{
    Cues, DepthSource, OutlierConfig, OutlierError, Tolerance, Views, remove_outliers,
};

fn main() -> Result<(), Box<dyn Error>> {
    let folders: Vec<String> = std::env::args().skip(1).collect();
    let mut maps = labelled::real_maps();
    if !folders.is_empty() {
        maps = folders
            .iter()
            .map(|f| labelled::read_map(f.as_ref()))
            .collect();
    }
    if maps.is_empty() {
        println!("skipped: no map folders given and no data folder found");
        return Ok(());
    }
    print!("{:34}", "F1 / AP");
    maps.iter().for_each(|m| print!(" {:>34}", m.name));
    println!();
    for (name, config, observed) in readings() {
        print!("{name:34}");
        for map in &maps {
            row(map, map.views.as_ref().filter(|_| observed), &config)?;
        }
        println!();
    }
    print!("{:34}", "default, agent at the origin");
    for map in &maps {
        let views = Views::from_position([0.0; 3], map.points.len())?;
        row(map, Some(&views), &OutlierConfig::default())?;
    }
    println!();
    Ok(())
}

/// Our readings, and the default with one part of it taken away; whether they see the observations.
fn readings() -> Vec<(&'static str, OutlierConfig, bool)> {
    vec![
        ("D nearest", OutlierConfig::nearest(), true),
        ("F supported", OutlierConfig::supported(), true),
        ("G connected", OutlierConfig::connected(), true),
        ("H rays", OutlierConfig::rays(), true),
        ("default, no observations", OutlierConfig::default(), false),
        ("default", OutlierConfig::default(), true),
        (
            "- without violations",
            changed(|cues| cues.violation_exponent = 0.0),
            true,
        ),
        (
            "- without depth agreement",
            changed(|cues| (cues.depth_exponent, cues.near_depth_exponent) = (0.0, 0.0)),
            true,
        ),
        (
            "- without range and parallax",
            changed(|cues| (cues.far_exponent, cues.parallax_exponent) = (0.0, 0.0)),
            true,
        ),
        (
            "- without coarseness",
            changed(|cues| cues.coarseness_exponent = 0.0),
            true,
        ),
        (
            "- without hiding rays",
            changed(|cues| cues.hidden_exponent = 0.0),
            true,
        ),
        (
            "- fixed tolerances, 10 and 5.5",
            changed(|cues| {
                if cues.tolerance != Tolerance::Fixed(10.0) {
                    cues.tolerance = Tolerance::Fixed(5.5);
                }
            }),
            true,
        ),
        (
            "- Euclidean distances",
            changed(|cues| cues.range_exponent = 0.0),
            true,
        ),
        (
            "- angular distances",
            changed(|cues| cues.range_exponent = 1.0),
            true,
        ),
        (
            "- as if all triangulated",
            taken_for(DepthSource::Triangulated),
            true,
        ),
        (
            "- as if all measured",
            taken_for(DepthSource::Measured),
            true,
        ),
    ]
}

/// The default with its weights changed.
fn changed(change: impl Fn(&mut Cues)) -> OutlierConfig {
    let mut config = OutlierConfig::default();
    change(&mut config.rays.triangulated);
    change(&mut config.rays.measured);
    config
}

/// The default told where depths come from.
fn taken_for(source: DepthSource) -> OutlierConfig {
    let mut config = OutlierConfig::default();
    config.rays.source = source;
    config
}

fn row(map: &Labelled, views: Option<&Views>, config: &OutlierConfig) -> Result<(), OutlierError> {
    let found = remove_outliers(&map.points, views, config)?;
    let ap = average_precision(&found.scores, &map.outlier);
    let fpr = false_positive_rate(&found.removed, &map.outlier);
    let f1 = f1(&found.removed, &map.outlier);
    print!(" {:>34}", format!("{f1:.3} / {ap:.3} (FPR {fpr:.3})"));
    Ok(())
}
