//! `explorer exits` and `explorer map`, which cleans before, tell the same of a place: what a cleaning takes out opens no wall, and the
//! rays of keyframes say what was looked at.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

mod command;

use command::{data, folder, json, text};
use serde_json::Value;
use slam_bridge::nalgebra::{Isometry3, Translation3};
use slam_bridge::{KeyFrame, KeyFrameId, Map, MapPoint, PointId, write_map_folder};

/// The scans and the openings read off their plots, degrees of atan2(z, x); none: a partial scan.
const ROOMS: [(&str, Option<[f64; 2]>); 6] = [
    ("room1", Some([-15.0, 20.0])),
    ("jackobs", Some([25.0, 42.0])),
    ("shahar_1", Some([-115.0, -95.0])),
    ("fares", None),
    ("fares_df1", None),
    ("shahar_4", None),
];
/// The openings were read off by eye.
const TOLERANCE_DEGREES: f64 = 3.0;

/// Direction and width of each exit, best first, to a millionth: the same opening is the same bins.
fn exits(report: &Value) -> Vec<[i64; 4]> {
    let millionths = |value: &Value| (value.as_f64().expect("a number") * 1e6).round() as i64;
    let exits = report["exits"].as_array().expect("a list");
    let exit = |exit: &Value| {
        let direction = &exit["direction"];
        [
            millionths(&direction[0]),
            millionths(&direction[1]),
            millionths(&direction[2]),
            millionths(&exit["width_rad"]),
        ]
    };
    exits.iter().map(exit).collect()
}

#[test]
fn exits_and_map_agree_on_real_rooms() {
    let Some(folder) = data("tello-orbslam-rooms") else {
        return;
    };
    for (name, opening) in ROOMS {
        let input = folder.join(format!("{name}.csv")).display().to_string();
        let of = |command: &str| {
            let [position, up] = ["0,0,0", "0,-1,0"];
            json(&[command, &input, "--position", position, "--up", up])
        };
        let (alone, cleaned) = (of("exits"), of("map"));
        assert_ne!(cleaned["removed_indices"], Value::Array(Vec::new()));
        let (found, in_map) = (exits(&alone), exits(&cleaned));
        assert_eq!(found, in_map, "{name}");
        let Some([low, high]) = opening else {
            assert_eq!(found.len(), 0, "{name}: an unseen sector is no exit");
            continue;
        };
        let best = found.first().expect(name);
        let bearing = (best[2] as f64).atan2(best[0] as f64).to_degrees();
        let labelled = low - TOLERANCE_DEGREES..=high + TOLERANCE_DEGREES;
        assert!(labelled.contains(&bearing), "{name}: {bearing:.1} degrees");
    }
}

/// Walls 3 m away in all directions but the 110 degrees about +x, seen by keyframes near the origin: who looks at +x saw what bounds
/// the gap on both sides. y is down.
fn walls_with_a_gap(tells_observers: bool) -> Map {
    let mut map = Map::default();
    for id in 0..4_u32 {
        let place = Translation3::new(0.0, 0.0, 0.01 * f64::from(id));
        map.keyframes.push(KeyFrame {
            id: KeyFrameId(u64::from(id)),
            time: None,
            world_from_camera: Isometry3::from(place),
        });
    }
    for step in 0..3 * 500_u32 {
        let (level, along) = (step % 3, f64::from(step / 3));
        let bearing = 55.0 + 0.5 * along;
        // The first keyframe looks at the gap, the others at a third of the walls each.
        let turned_to = 1 + (along / 167.0) as u64;
        let mut observers = vec![KeyFrameId(turned_to)];
        if !(85.0..=275.0).contains(&bearing) {
            observers.push(KeyFrameId(0));
        }
        observers.retain(|_| tells_observers);
        let (sin, cos) = bearing.to_radians().sin_cos();
        map.points.push(MapPoint {
            id: PointId(step.into()),
            position: [3.0 * cos, 0.2 * f64::from(level) - 0.2, 3.0 * sin].into(),
            viewing_direction: None,
            max_distance: None,
            observers,
        });
    }
    map
}

#[test]
fn rays_tell_a_wide_gap_that_was_looked_into_from_one_that_was_not() {
    for (tells_observers, unseen) in [(false, 1), (true, 0)] {
        let folder = folder("gap");
        write_map_folder(&walls_with_a_gap(tells_observers), &folder).expect("a map");
        for command in ["exits", "map"] {
            let input = text(&folder);
            let report = json(&[command, &input, "--position", "0,0,0", "--up", "0,-1,0"]);
            let sectors = report["unseen_sectors"].as_u64();
            assert_eq!(sectors, Some(unseen), "{command} {tells_observers}");
        }
    }
}
