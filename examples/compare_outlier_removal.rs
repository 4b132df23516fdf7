//! Problem: which points of a sparse map are wrong? Every way to tell, at its fixed default setting.
//!
//! Run: `cargo run --release -p examples --example compare_outlier_removal [MAP | WORLD [SEED]]`
//! With a map (a folder with map.ply, keyframes.csv, observations.csv(.gz), or a file of points) prints what each way
//! removes, and if depth_check.csv lies beside it how right that is: a point is wrong if a depth sensor disagrees by more
//! than 20 %. With a world turns a simulated drone once round and takes the map of its SLAM, whose truth is known.

use core::time::Duration;
use std::collections::HashMap;
use std::error::Error;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use indoor_sim::{SimConfig, Simulator, World};
use slam_bridge::{Map, PointId, SlamSource, read_map};
use submodular_minimax::baseline::{dbscan, lof, radius, statistical};
use submodular_minimax::{OutlierConfig, Views, remove_outliers};
use tello_sdk::{Command, Distance, Turn};

/// What is known of each point: wrong, right, or nothing.
type Truth = Vec<Option<bool>>;

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

/// Writes the table.
fn compare(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "apartment".to_owned());
    let seed: u64 = arguments.next().map_or(Ok(1), |word| word.parse())?;
    let path = Path::new(&name);
    let (map, truth) = if path.exists() {
        let map = read_map(path)?;
        let truth = depth_labels(&map, &path.join("depth_check.csv"))?;
        (map, truth)
    } else {
        simulated(&name, seed)?
    };
    let points = map.positions();
    let count = |kind: bool| truth.iter().filter(|t| **t == Some(kind)).count();
    let (wrong, right) = (count(true), count(false));
    writeln!(
        out,
        "{} points; known to be wrong {wrong}, right {right}",
        points.len()
    )?;
    writeln!(
        out,
        "method                        removed  precision  recall     F1"
    )?;
    if map.has_observations() {
        let views = views(&map)?;
        for (name, config) in [
            ("default", OutlierConfig::default()),
            ("H, who saw what", OutlierConfig::rays()),
        ] {
            let found = remove_outliers(&points, Some(&views), &config)?;
            row(out, name, &found.removed, &truth)?;
        }
    }
    for (name, config) in [
        ("default, points alone", OutlierConfig::default()),
        ("G", OutlierConfig::connected()),
        ("F", OutlierConfig::supported()),
        ("D", OutlierConfig::nearest()),
        ("A, the paper's constants", OutlierConfig::paper()),
    ] {
        row(
            out,
            name,
            &remove_outliers(&points, None, &config)?.removed,
            &truth,
        )?;
    }
    baselines(out, &points, &truth)
}

/// What people use today, at the settings that they are usually given.
fn baselines(
    out: &mut impl Write,
    points: &[[f64; 3]],
    truth: &Truth,
) -> Result<(), Box<dyn Error>> {
    for (name, found) in [
        ("SOR", statistical(points, &Default::default())?),
        ("ROR", radius(points, &Default::default())?),
        ("LOF", lof(points, &Default::default())?),
        ("DBSCAN", dbscan(points, &Default::default())?),
    ] {
        row(out, name, &found.removed, truth)?;
    }
    Ok(())
}

/// The map of one turn in a simulated world, and its truth.
fn simulated(world: &str, seed: u64) -> Result<(Map, Truth), Box<dyn Error>> {
    let mut sim = Simulator::new(World::named(world, seed)?, SimConfig::default(), seed)?;
    scan(&mut sim)?;
    let map = sim.slam_ref().map();
    let truth = (map.points.iter())
        .map(|point| sim.slam_ref().point_truth(point.id))
        .map(|truth| Some(truth.is_some_and(|truth| truth.outlier.is_some())))
        .collect();
    Ok((map, truth))
}

/// point_id, observations with depth, median signed relative depth error; nothing known without the file.
fn depth_labels(map: &Map, path: &Path) -> Result<Truth, Box<dyn Error>> {
    let mut wrong = HashMap::new();
    if path.is_file() {
        for line in std::fs::read_to_string(path)?.lines().skip(1) {
            let fields: Vec<&str> = line.split(',').collect();
            if let [id, _, error] = fields[..] {
                let error: f64 = error.trim().parse()?;
                wrong.insert(PointId(id.trim().parse()?), error.abs() > 0.2);
            }
        }
    }
    Ok((map.points.iter())
        .map(|point| wrong.get(&point.id).copied())
        .collect())
}

/// Takes off and turns once round, going up and down.
fn scan(sim: &mut Simulator) -> Result<(), Box<dyn Error>> {
    let climb = Distance::from_cm(40)?;
    let turn = Command::Clockwise(Turn::from_degrees(20)?);
    let steps = (0..9).flat_map(|_| {
        [
            Command::Up(climb),
            turn.clone(),
            Command::Down(climb),
            turn.clone(),
        ]
    });
    for command in core::iter::once(Command::TakeOff).chain(steps) {
        sim.send(&command)?;
        while sim.poll_reply().is_none() {
            sim.advance(Duration::from_millis(100));
        }
    }
    Ok(())
}

/// Which camera position saw which point.
fn views(map: &Map) -> Result<Views, Box<dyn Error>> {
    let place: HashMap<_, _> = map
        .keyframes
        .iter()
        .enumerate()
        .map(|(i, k)| (k.id, i))
        .collect();
    let centers = map
        .keyframes
        .iter()
        .map(|keyframe| keyframe.center().into());
    let observers = (map.points.iter()).map(|point| {
        point
            .observers
            .iter()
            .filter_map(|id| place.get(id).copied())
            .collect()
    });
    Ok(Views::new(centers.collect(), observers.collect())?)
}

fn row(out: &mut impl Write, name: &str, removed: &[usize], truth: &Truth) -> io::Result<()> {
    let found = |kind: bool| removed.iter().filter(|&&i| truth[i] == Some(kind)).count() as f64;
    let (hits, misses) = (found(true), found(false));
    let wrong = truth.iter().filter(|t| **t == Some(true)).count() as f64;
    if wrong == 0.0 {
        return writeln!(
            out,
            "{name:28} {:8}          -       -      -",
            removed.len()
        );
    }
    let precision = hits / (hits + misses).max(1.0);
    let recall = hits / wrong;
    let f1 = 2.0 * hits / (hits + misses + wrong);
    writeln!(
        out,
        "{name:28} {:8} {precision:10.3} {recall:7.3} {f1:6.3}",
        removed.len()
    )
}
