//! The real room scans and the openings labelled in them.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "shared by tests and examples, each uses its part"
)]

use std::path::PathBuf;

/// A scan with the openings read off its plot, degrees of atan2(z, x); empty: a partial scan.
pub struct Room {
    pub name: &'static str,
    pub opening: Option<[f64; 2]>,
}

pub const ROOMS: [Room; 6] = [
    Room {
        name: "room1",
        opening: Some([-15.0, 20.0]),
    },
    Room {
        name: "jackobs",
        opening: Some([25.0, 42.0]),
    },
    Room {
        name: "shahar_1",
        opening: Some([-115.0, -95.0]),
    },
    Room {
        name: "fares",
        opening: None,
    },
    Room {
        name: "fares_df1",
        opening: None,
    },
    Room {
        name: "shahar_4",
        opening: None,
    },
];

/// The points of a scan, or `None` (with a line that says so) when the data folder is not there.
pub fn load(name: &str) -> Option<Vec<[f64; 3]>> {
    let folder = std::env::var("EXPLORER_DATA").map_or_else(
        |_| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")),
        PathBuf::from,
    );
    let path = folder
        .join("tello-orbslam-rooms")
        .join(format!("{name}.csv"));
    let Ok(text) = std::fs::read_to_string(&path) else {
        println!("skipped: {} is not there", path.display());
        return None;
    };
    let point = |line: &str| {
        let mut fields = line
            .split(',')
            .map(|field| field.trim().parse::<f64>().ok());
        Some([fields.next()??, fields.next()??, fields.next()??])
    };
    Some(text.lines().filter_map(point).collect())
}

/// Difference of a bearing (radians) from the opening, degrees; zero inside.
pub fn outside(bearing_rad: f64, [low, high]: [f64; 2]) -> f64 {
    let middle = 0.5 * (low + high);
    let off = (bearing_rad.to_degrees() - middle + 180.0).rem_euclid(360.0) - 180.0;
    (off.abs() - 0.5 * (high - low)).max(0.0)
}

/// An opening as seen from elsewhere, degrees; its edges are taken to lie `range` from the origin.
pub fn seen_from(opening: [f64; 2], range: f64, agent: [f64; 3]) -> [f64; 2] {
    let [low, high] = opening.map(|degrees| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        (range * sin - agent[2])
            .atan2(range * cos - agent[0])
            .to_degrees()
    });
    [low, if high < low { high + 360.0 } else { high }]
}
