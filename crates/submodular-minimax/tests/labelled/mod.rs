//! Labelled clouds for tests and measurements: real maps from a data folder, rooms made from a seed.
#![allow(
    dead_code,
    unreachable_pub,
    reason = "each test and example uses a part"
)]
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

pub mod apartment;
pub mod room;

use std::collections::HashMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use submodular_minimax::Views;

/// CPU time of this thread, from the scheduler's statistics of Linux.
pub fn cpu_seconds() -> Result<f64, Box<dyn std::error::Error>> {
    let statistics = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds = statistics.split(' ').next().unwrap_or_default();
    Ok(nanoseconds.parse::<f64>()? / 1e9)
}

/// Points with what is known of them.
pub struct Labelled {
    pub name: String,
    pub points: Vec<[f64; 3]>,
    pub views: Option<Views>,
    /// Whether it is an outlier, where that is known.
    pub outlier: Vec<Option<bool>>,
}

/// The data folder: `EXPLORER_DATA`, or a folder named shared beside the checkout.
pub fn data_folder() -> Option<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared");
    let root = std::env::var("EXPLORER_DATA").unwrap_or_else(|_| beside.into());
    let data = Path::new(&root).join("data");
    data.is_dir().then_some(data)
}

/// The labelled real maps: folders with map.ply, keyframes.csv, observations.csv.gz, depth_check.csv.
pub fn real_maps() -> Vec<Labelled> {
    let Some(data) = data_folder() else {
        return Vec::new();
    };
    let names = ["sevenscenes_kitchen_mono_first500", "tum_fr1_rpy_rgbd"];
    let folder = |name: &str| data.join("orbslam3-maps").join(name);
    names
        .iter()
        .map(|name| folder(name))
        .filter(|f| f.is_dir())
        .map(|f| read_map(&f))
        .collect()
}

/// The synthetic apartment with its truth, if the data folder is there.
pub fn apartment_of_the_data_folder() -> Option<Labelled> {
    let folder = data_folder()?.join("synthetic-apartment");
    let points = read_ply(&folder.join("apt_10k_o15.ply"))?.points;
    let labels = std::fs::read(folder.join("apt_10k_o15.labels.npy")).ok()?;
    let body = &labels[labels.len() - points.len()..];
    let outlier = body.iter().map(|&label| Some(label > 0)).collect();
    Some(Labelled {
        name: "synthetic apartment".into(),
        points,
        views: None,
        outlier,
    })
}

/// Reads one map folder.
pub fn read_map(folder: &Path) -> Labelled {
    let vertices = read_ply(&folder.join("map.ply")).unwrap();
    let ids = &vertices.ids;
    let keyframes = rows(&std::fs::read_to_string(folder.join("keyframes.csv")).unwrap());
    let camera: HashMap<usize, usize> = keyframes
        .iter()
        .enumerate()
        .map(|(i, row)| (row[0] as usize, i))
        .collect();
    let cameras = keyframes
        .iter()
        .map(|row| [row[3], row[4], row[5]])
        .collect();
    let mut text = String::new();
    let file = std::fs::File::open(folder.join("observations.csv.gz")).unwrap();
    flate2::read::GzDecoder::new(file)
        .read_to_string(&mut text)
        .unwrap();
    let seen: HashMap<usize, Vec<usize>> = (text.lines().skip(1))
        .map(|line| {
            let (id, list) = line.split_once(',').unwrap();
            let keyframes = list
                .split(' ')
                .filter_map(|k| camera.get(&k.trim().parse().ok()?));
            (id.parse().unwrap(), keyframes.copied().collect())
        })
        .collect();
    let observers = ids
        .iter()
        .map(|id| seen.get(id).cloned().unwrap_or_default())
        .collect();
    let checks = std::fs::read_to_string(folder.join("depth_check.csv")).unwrap_or_default();
    let error: HashMap<usize, f64> = rows(&checks)
        .into_iter()
        .map(|row| (row[0] as usize, row[2]))
        .collect();
    let outlier = ids
        .iter()
        .map(|id| error.get(id).map(|e| e.abs() > 0.2))
        .collect();
    let views = Views::new(cameras, observers).unwrap();
    let name = folder.file_name().unwrap().to_string_lossy().into_owned();
    Labelled {
        name,
        points: vertices.points,
        views: Some(views.with_max_distances(vertices.max_distances).unwrap()),
        outlier,
    }
}

fn rows(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| {
        line.split(',')
            .map(|x| x.parse().unwrap_or(f64::NAN))
            .collect()
    };
    text.lines().skip(1).map(row).collect()
}

/// What a PLY file tells of its points.
#[derive(Default)]
struct Vertices {
    points: Vec<[f64; 3]>,
    ids: Vec<usize>,
    max_distances: Vec<Option<f64>>,
}

fn read_ply(path: &Path) -> Option<Vertices> {
    let bytes = std::fs::read(path).ok()?;
    let end = bytes.windows(11).position(|w| w == b"end_header\n")? + 11;
    let header = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let properties: Vec<&str> = (header.lines())
        .filter(|line| line.starts_with("property"))
        .filter_map(|line| line.split(' ').next_back())
        .collect();
    let column = |name: &str| properties.iter().position(|property| *property == name);
    let (id, reach) = (column("id"), column("max_distance"));
    if header.contains("binary_little_endian") {
        let float = |at: &[u8]| f64::from(f32::from_le_bytes([at[0], at[1], at[2], at[3]]));
        let size: usize = (header.lines())
            .filter(|line| line.starts_with("property"))
            .map(|line| match line.split(' ').nth(1) {
                Some("uchar" | "uint8") => 1,
                Some("ushort" | "uint16") => 2,
                _ => 4,
            })
            .sum();
        let points = bytes[end..].chunks_exact(size);
        let points = points
            .map(|p| [float(p), float(&p[4..]), float(&p[8..])])
            .collect();
        return Some(Vertices {
            points,
            ..Vertices::default()
        });
    }
    let mut vertices = Vertices::default();
    for line in String::from_utf8_lossy(&bytes[end..]).lines() {
        let values: Vec<f64> = line
            .split_whitespace()
            .filter_map(|x| x.parse().ok())
            .collect();
        if values.len() >= 3 {
            let reach = reach.map(|at| values[at]).filter(|&reach| reach > 0.0);
            vertices.points.push([values[0], values[1], values[2]]);
            vertices.ids.push(id.map_or(0, |at| values[at] as usize));
            vertices.max_distances.push(reach);
        }
    }
    Some(vertices)
}

/// F1 of the removed set among the labelled points.
pub fn f1(removed: &[usize], outlier: &[Option<bool>]) -> f64 {
    let found = removed
        .iter()
        .filter(|&&v| outlier[v] == Some(true))
        .count();
    let called = removed.iter().filter(|&&v| outlier[v].is_some()).count();
    let truth = outlier.iter().filter(|o| **o == Some(true)).count();
    2.0 * found as f64 / (called + truth).max(1) as f64
}

/// Share of the labelled inliers that were removed.
pub fn false_positive_rate(removed: &[usize], outlier: &[Option<bool>]) -> f64 {
    let wrong = removed
        .iter()
        .filter(|&&v| outlier[v] == Some(false))
        .count();
    let inliers = outlier.iter().filter(|o| **o == Some(false)).count();
    wrong as f64 / inliers.max(1) as f64
}

/// Average precision of a score, higher meaning more outlying; equal scores form one step.
pub fn average_precision(scores: &[f64], outlier: &[Option<bool>]) -> f64 {
    let mut known: Vec<(f64, bool)> = scores
        .iter()
        .zip(outlier)
        .filter_map(|(&s, o)| o.map(|o| (s, o)))
        .collect();
    known.sort_by(|a, b| b.0.total_cmp(&a.0));
    let truth = known.iter().filter(|k| k.1).count().max(1) as f64;
    let (mut hits, mut before, mut sum) = (0.0, 0.0, 0.0);
    for (i, &(score, outlier)) in known.iter().enumerate() {
        hits += f64::from(u8::from(outlier));
        if known.get(i + 1).is_none_or(|next| next.0 != score) {
            sum += (hits - before) / truth * hits / (i + 1) as f64;
            before = hits;
        }
    }
    sum
}
