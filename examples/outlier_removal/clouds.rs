//! Clouds without observations whose truth is known: the default against baselines.
//!
//! Apartments from seeds, 5 % to 25 % outliers, 10,000 to 100,000 points, and, if the data folder is there, the synthetic
//! apartment that they imitate: F1. Then clean ones: the share that is removed. Each baseline is shown at the
//! one setting of a grid that is best on average over these very clouds, which helps it.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

use slam_bridge::read_map;
use submodular_minimax::{OutlierConfig, remove_outliers};

use crate::labels;
use crate::score::{Labelled, f1, false_positive_rate};
use crate::settings::{self, families};

// The generator has one home, the tests of the crate whose outlier removal is measured by it.
#[path = "../../crates/submodular-minimax/tests/labelled/apartment.rs"]
#[allow(
    unreachable_pub,
    clippy::unwrap_used,
    reason = "written for tests, and shared"
)]
mod apartment;

use apartment::Apartment;

/// Writes the table.
pub(crate) fn compare(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut clouds: Vec<Labelled> = of_the_data_folder()?.into_iter().collect();
    clouds.extend(KINDS.map(|(points, outliers)| make(points, outliers, 11)));
    let clean = [(10_000, 11), (10_000, 12), (50_000, 11)].map(|(n, seed)| make(n, 0.0, seed));
    for cloud in clouds.iter().chain(&clean) {
        writeln!(out, "{}", cloud.name)?;
    }
    let width = 6 * clouds.len();
    writeln!(out, "{:34} {:width$} share removed of the clean", "", "F1")?;
    for family in families() {
        let mut tries = Vec::new();
        for cloud in &clouds {
            tries.push(settings::tried(&family, cloud)?);
        }
        let best = settings::best(&tries.iter().collect::<Vec<_>>());
        let setting = &family.grid[best];
        let wrong = |cloud: &Labelled| {
            let found = setting.remove(&cloud.points)?;
            Ok::<_, Box<dyn Error>>(false_positive_rate(&found.removed, &cloud.outlier))
        };
        let f1s = tries.iter().map(|tried| Ok(tried[best].1));
        row(out, &setting.name, f1s.chain(clean.iter().map(wrong)))?;
    }
    for (name, config) in [
        ("G", OutlierConfig::connected()),
        ("default", OutlierConfig::default()),
    ] {
        let removed = |cloud: &Labelled| remove_outliers(&cloud.points, None, &config);
        let f1s = clouds
            .iter()
            .map(|c| Ok(f1(&removed(c)?.removed, &c.outlier)));
        let wrong = clean.iter();
        let wrong = wrong.map(|c| Ok(false_positive_rate(&removed(c)?.removed, &c.outlier)));
        row(out, name, f1s.chain(wrong))?;
    }
    Ok(())
}

fn row(
    out: &mut impl Write,
    name: &str,
    values: impl Iterator<Item = Result<f64, Box<dyn Error>>>,
) -> Result<(), Box<dyn Error>> {
    write!(out, "{name:34}")?;
    for value in values {
        write!(out, " {:.3}", value?)?;
    }
    Ok(writeln!(out)?)
}

/// Points and share of outliers.
const KINDS: [(usize, f64); 6] = [
    (10_000, 0.05),
    (10_000, 0.15),
    (10_000, 0.25),
    (50_000, 0.05),
    (50_000, 0.15),
    (100_000, 0.25),
];

fn make(points: usize, outliers: f64, seed: u64) -> Labelled {
    let kind = Apartment {
        points,
        outliers,
        seed,
    };
    kind.make()
}

fn of_the_data_folder() -> Result<Option<Labelled>, Box<dyn Error>> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared").into();
    let root = std::env::var_os("EXPLORER_DATA").map_or(beside, PathBuf::from);
    let file = root.join("data/synthetic-apartment/apt_10k_o15.ply");
    if !file.is_file() {
        return Ok(None);
    }
    let map = read_map(&file)?;
    Ok(Some(Labelled {
        name: "synthetic apartment of the data folder".to_owned(),
        points: map.positions(),
        views: None,
        outlier: labels::read(&map, &file.with_extension("labels.npy"))?,
    }))
}
