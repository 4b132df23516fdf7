//! Problem: which points of a sparse map are wrong? Every way to tell, in one table a map.
//!
//! Run: `cargo run --release -p examples --example compare_outlier_removal [OPTIONS] [MAP | WORLD [SEED]] ...`,
//! or with `--generated` on clouds from seeds (see clouds.rs).
//!
//! MAP is a folder with map.ply, keyframes.csv and observations.csv(.gz), or a file of points; a WORLD is one in which a
//! simulated drone turns once round, and the map is that of its SLAM (default: apartment 1). Which points are wrong is
//! - for a world known;
//! - read from `--labels FILE`, or from depth_check.csv in the folder or NAME.labels.npy beside NAME.ply;
//! - told by `--depth SEQUENCE`, the folder of the images and depth images that the map was made from: wrong is what the
//!   sensor contradicts by more than 20 %.
//!
//! Without any of these the table has no precision, recall, F1 and AP; it says how many points go, and how far
//! that agrees with the default. Baselines are shown at the setting they are customarily given, at one setting for all
//! maps (the best on average over the labelled maps of the command, if several are given), and at the
//! best setting of a grid for each single map, which nobody knows beforehand.

use std::error::Error;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use explorer::map_views;
use slam_bridge::{Map, read_map};
use submodular_minimax::{OutlierConfig, Views, remove_outliers};

mod clouds;
mod labels;
mod range;
mod score;
mod settings;
mod simulated;
mod table;

use score::{Labelled, Labels};
use settings::{Family, Tried, families};
use table::{Row, heading};

fn main() -> Result<(), Box<dyn Error>> {
    let done = compare(&mut io::stdout().lock());
    let closed = |error: &(dyn Error + 'static)| {
        (error.downcast_ref::<io::Error>()).is_some_and(|e| e.kind() == ErrorKind::BrokenPipe)
    };
    match done {
        // The reader has seen enough, as in `| head -1`.
        Err(error) if closed(&*error) => Ok(()),
        done => done,
    }
}

/// Writes all tables.
fn compare(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    if std::env::args().nth(1).as_deref() == Some("--generated") {
        return clouds::compare(out);
    }
    let maps = maps(std::env::args().skip(1))?;
    let families = families();
    let mut tries: Vec<Option<[Tried; 4]>> = Vec::new();
    for map in &maps {
        let labelled = map.count(true) > 0;
        tries.push(labelled.then(|| tried(&families, map)).transpose()?);
    }
    let shared = shared(&families, &tries);
    for (map, tries) in maps.iter().zip(&tries) {
        describe(out, map)?;
        heading(out)?;
        let default = ours(out, map)?;
        metric_alone(out, map, &default)?;
        baselines(out, map, &families, tries.as_ref(), &shared, &default)?;
        writeln!(out)?;
    }
    Ok(())
}

fn tried(families: &[Family; 4], map: &Labelled) -> Result<[Tried; 4], Box<dyn Error>> {
    let [a, b, c, d] = families;
    let of = |family| settings::tried(family, map);
    Ok([of(a)?, of(b)?, of(c)?, of(d)?])
}

/// For each baseline the place in its grid of the setting that is best on average over several labelled maps.
fn shared(families: &[Family], tries: &[Option<[Tried; 4]>]) -> Option<Vec<usize>> {
    let labelled: Vec<&[Tried; 4]> = tries.iter().flatten().collect();
    let best = |at: usize| settings::best(&labelled.iter().map(|t| &t[at]).collect::<Vec<_>>());
    (labelled.len() > 1).then(|| (0..families.len()).map(best).collect())
}

fn describe(out: &mut impl Write, map: &Labelled) -> io::Result<()> {
    let cameras = map
        .views
        .as_ref()
        .map_or(0, |views| views.viewpoints().len());
    let (wrong, right) = (map.count(true), map.count(false));
    let points = map.points.len();
    writeln!(out, "{}: {points} points, {cameras} keyframes", map.name)?;
    match wrong + right {
        0 => writeln!(out, "nothing is known of what is wrong"),
        known => {
            let share = 100.0 * wrong as f64 / known as f64;
            writeln!(
                out,
                "known to be wrong {wrong} ({share:.1} %), right {right}"
            )
        }
    }
}

/// Our readings at their one setting; what the default with all that is known removes.
fn ours(out: &mut impl Write, map: &Labelled) -> Result<Vec<usize>, Box<dyn Error>> {
    let default = remove_outliers(&map.points, map.views.as_ref(), &OutlierConfig::default())?;
    let row = |name: &'static str, views: Option<&Views>, config: OutlierConfig| {
        let found = remove_outliers(&map.points, views, &config)?;
        Ok::<_, Box<dyn Error>>(Row {
            name: name.to_owned(),
            removed: found.removed,
            scores: found.scores,
        })
    };
    writeln!(out, "this project, one setting for all maps")?;
    let mut rows = Vec::new();
    if let Some(views) = &map.views {
        rows.push(row("default", Some(views), OutlierConfig::default())?);
        rows.push(row("H, who saw what", Some(views), OutlierConfig::rays())?);
    }
    let agent = Views::from_position([0.0; 3], map.points.len())?;
    let told = "default, points seen from 0, 0, 0";
    rows.push(row(
        "default, points alone",
        None,
        OutlierConfig::default(),
    )?);
    rows.push(row(told, Some(&agent), OutlierConfig::default())?);
    rows.push(row("G", None, OutlierConfig::connected())?);
    rows.push(row("F", None, OutlierConfig::supported())?);
    rows.push(row("D", None, OutlierConfig::nearest())?);
    rows.push(row(
        "A, the paper's constants",
        None,
        OutlierConfig::paper(),
    )?);
    for row in &rows {
        row.write(out, map, &default.removed)?;
    }
    Ok(default.removed)
}

/// The mean distance to 20 neighbours divided by viewing ranges, cut as SOR cuts its own.
fn metric_alone(out: &mut impl Write, map: &Labelled, default: &[usize]) -> io::Result<()> {
    let Some(views) = map
        .views
        .as_ref()
        .filter(|_| map.points.len() <= range::MOST_POINTS)
    else {
        return Ok(());
    };
    writeln!(
        out,
        "the mean distance to 20 neighbours, divided by viewing ranges"
    )?;
    let scores = range::mean_distances(&map.points, views, 20);
    for ratio in [0.5, 2.0] {
        let row = Row {
            name: format!("cut at {ratio} deviations, as SOR"),
            removed: range::above_deviations(&scores, ratio),
            scores: scores.clone(),
        };
        row.write(out, map, default)?;
    }
    Ok(())
}

fn baselines(
    out: &mut impl Write,
    map: &Labelled,
    families: &[Family; 4],
    tries: Option<&[Tried; 4]>,
    shared: &Option<Vec<usize>>,
    default: &[usize],
) -> Result<(), Box<dyn Error>> {
    writeln!(out, "baselines, at the customary setting")?;
    for family in families {
        Row::of(&family.customary, map)?.write(out, map, default)?;
    }
    match shared {
        Some(_) => writeln!(
            out,
            "baselines, at one setting, the best on average over these maps"
        )?,
        None => writeln!(
            out,
            "baselines, at one setting, the best on average over two other maps"
        )?,
    }
    for (at, family) in families.iter().enumerate() {
        let setting = shared
            .as_ref()
            .map_or(&family.shared, |best| &family.grid[best[at]]);
        Row::of(setting, map)?.write(out, map, default)?;
    }
    if let Some(tries) = tries {
        writeln!(out, "baselines, at the best setting for this very map")?;
        for (family, tried) in families.iter().zip(tries) {
            let best = settings::best(&[tried]);
            Row::of(&family.grid[best], map)?.write(out, map, default)?;
        }
    }
    Ok(())
}

/// The maps that the command line names.
fn maps(arguments: impl Iterator<Item = String>) -> Result<Vec<Labelled>, Box<dyn Error>> {
    let mut arguments = arguments.peekable();
    let (mut maps, mut labels, mut depth) = (Vec::new(), None, None);
    while let Some(word) = arguments.next() {
        let missing = || format!("{word} needs a path");
        match word.as_str() {
            "--labels" => labels = Some(PathBuf::from(arguments.next().ok_or_else(missing)?)),
            "--depth" => depth = Some(PathBuf::from(arguments.next().ok_or_else(missing)?)),
            path if Path::new(path).exists() => {
                maps.push(recorded(path.as_ref(), labels.take(), depth.take())?);
            }
            world => {
                let seed = arguments.next_if(|next| next.parse::<u64>().is_ok());
                maps.push(flown(world, seed.map_or(Ok(1), |seed| seed.parse())?)?);
            }
        }
    }
    if labels.is_some() || depth.is_some() {
        return Err("--labels and --depth come before the map that they belong to".into());
    }
    if maps.is_empty() {
        maps.push(flown("apartment", 1)?);
    }
    Ok(maps)
}

fn flown(world: &str, seed: u64) -> Result<Labelled, Box<dyn Error>> {
    let (map, outlier) = simulated::scan(world, seed)?;
    labelled(format!("{world} {seed}"), &map, outlier)
}

fn recorded(
    path: &Path,
    labels: Option<PathBuf>,
    depth: Option<PathBuf>,
) -> Result<Labelled, Box<dyn Error>> {
    let map = read_map(path)?;
    let beside = [
        path.join("depth_check.csv"),
        path.with_extension("labels.npy"),
    ];
    let file = labels.or_else(|| beside.into_iter().find(|file| file.is_file()));
    let outlier = match (depth, file) {
        (Some(folder), _) => labels::from_depth(&map, &folder)?,
        (None, Some(file)) => labels::read(&map, &file)?,
        (None, None) => vec![None; map.points.len()],
    };
    labelled(path.display().to_string(), &map, outlier)
}

fn labelled(name: String, map: &Map, outlier: Labels) -> Result<Labelled, Box<dyn Error>> {
    Ok(Labelled {
        name,
        points: map.positions(),
        views: map_views(map)?,
        outlier,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the published maps lie, or `None` with a line that says so.
    fn data() -> Option<PathBuf> {
        let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared").into();
        let root = std::env::var_os("EXPLORER_DATA")
            .map_or(beside, PathBuf::from)
            .join("data");
        if !root.is_dir() {
            println!("skipped: no maps in {} (set EXPLORER_DATA)", root.display());
            return None;
        }
        Some(root)
    }

    #[test]
    fn the_default_beats_the_customary_baselines_with_and_without_observations() {
        let Some(data) = data() else { return };
        for name in ["sevenscenes_kitchen_mono_first500", "tum_fr1_rpy_rgbd"] {
            let map = recorded(&data.join("orbslam3-maps").join(name), None, None).unwrap();
            for views in [None, map.views.as_ref()] {
                let ours = remove_outliers(&map.points, views, &OutlierConfig::default()).unwrap();
                let ours = score::f1(&ours.removed, &map.outlier);
                for family in families() {
                    let theirs = family.customary.remove(&map.points).unwrap();
                    let theirs = score::f1(&theirs.removed, &map.outlier);
                    let setting = &family.customary.name;
                    assert!(ours > theirs, "{name}: {ours:.3}, {setting} {theirs:.3}");
                }
            }
        }
    }

    #[test]
    fn a_scan_of_a_simulated_apartment_is_cleaned_better_than_by_any_setting_of_sor() {
        let map = flown("apartment", 11).unwrap();
        let [sor, ..] = families();
        let tried = settings::tried(&sor, &map).unwrap();
        let best = settings::best(&[&tried]);
        let (setting, theirs) = (&sor.grid[best].name, tried[best].1);
        let agent = Views::from_position([0.0; 3], map.points.len()).unwrap();
        for views in [Some(&agent), map.views.as_ref()] {
            let ours = remove_outliers(&map.points, views, &OutlierConfig::default()).unwrap();
            let ours = score::f1(&ours.removed, &map.outlier);
            assert!(ours > theirs, "{ours:.3}, {setting} {theirs:.3}");
        }
    }

    #[test]
    fn depth_images_tell_what_the_published_labels_tell() {
        let Some(data) = data() else { return };
        let folder = data.join("orbslam3-maps/sevenscenes_kitchen_mono_first500");
        let published = recorded(&folder, None, None).unwrap().outlier;
        let depth = Some(data.join("seven_scenes_redkitchen_part1"));
        let told = recorded(&folder, None, depth).unwrap().outlier;
        let pairs = published.iter().zip(&told);
        let both: Vec<(bool, bool)> = pairs.filter_map(|(a, b)| Some(((*a)?, (*b)?))).collect();
        let same = both.iter().filter(|(a, b)| a == b).count();
        // Only the first 300 of the 500 frames have depth here, so not every observation counts.
        let known = both.len();
        assert!(
            known > 2_000 && same * 100 >= known * 98,
            "{same} of {known} are the same"
        );
    }

    #[test]
    fn labels_come_from_all_their_files() {
        let map = flown("one-door-room", 1).unwrap();
        let points = map.points.len();
        let folder = std::env::temp_dir().join(format!("wayout-labels-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let cloud: String = (map.points.iter())
            .map(|[x, y, z]| format!("{x},{y},{z}\n"))
            .collect();
        let (file, lines) = (folder.join("map.csv"), folder.join("labels.txt"));
        std::fs::write(&file, cloud).unwrap();
        let bits: Vec<u8> = (map.outlier.iter())
            .map(|&o| u8::from(o == Some(true)))
            .collect();
        std::fs::write(
            folder.join("map.labels.npy"),
            [&[0x93; 80], &bits[..]].concat(),
        )
        .unwrap();
        assert_eq!(recorded(&file, None, None).unwrap().outlier, map.outlier);
        let text: String = bits.iter().map(|bit| format!("{bit}\n")).collect();
        std::fs::write(&lines, &text).unwrap();
        let read = recorded(&file, Some(lines.clone()), None).unwrap().outlier;
        assert_eq!(read, map.outlier);
        std::fs::write(&lines, &text[2..]).unwrap();
        let error = recorded(&file, Some(lines), None)
            .err()
            .unwrap()
            .to_string();
        assert!(
            error.contains(&format!("{} labels for {points} points", points - 1)),
            "{error}"
        );
        std::fs::remove_dir_all(folder).unwrap();
    }
}
