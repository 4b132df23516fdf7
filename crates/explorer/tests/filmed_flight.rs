//! `explorer slam` on a flight that is GENERATED: a textured room is drawn frame by frame, and what a Tello would have said meanwhile
//! (rounded as it rounds) is recorded beside the frames.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

mod command;

use std::fs;
use std::path::Path;

use command::{complaint, folder, json, text};
use core::time::Duration;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use resvg::tiny_skia::{IntSize, Pixmap};
use tello_sdk::record::{Channel, Record, encode};
use tello_sdk::{SdkVersion, StateLine};

const WIDTH: u32 = 256;
const HEIGHT: u32 = 192;
const FOCAL: f64 = 168.0;
const RATE: f64 = 12.0;
const FRAMES: u32 = 84;
/// The camera sees nothing in these seconds.
const DARK: core::ops::Range<f64> = 4.0..4.6;

/// Position in metres and yaw in radians, x ahead at the start, y left, z up.
fn truth(time: f64) -> (Vector3<f64>, f64) {
    let phase = 0.9 * time;
    let place = Vector3::new(
        0.3 * (0.5 * time).sin(),
        0.7 * (1.0 - phase.cos()),
        0.25 * (0.7 * time).sin(),
    );
    (place, 0.25 * (0.6 * time).sin())
}

/// World from camera, whose axes are right, down and ahead.
fn turn(yaw: f64) -> Rotation3<f64> {
    let ahead = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
    Rotation3::from_axis_angle(&Vector3::z_axis(), yaw) * Rotation3::from_matrix_unchecked(ahead)
}

/// A value in 0..=1 for a point of a lattice.
fn hash(cell: [i64; 3], salt: u64) -> f64 {
    let mut state = salt;
    for value in cell {
        state = (state ^ value as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        state ^= state >> 29;
    }
    (state >> 40) as f64 / (1_u64 << 24) as f64
}

/// Dark and light tiles of two sizes, soft at their borders.
fn texture(point: &Vector3<f64>) -> f64 {
    let layer = |size: f64, salt: u64| {
        let scaled = point / size;
        let base = scaled.map(f64::floor);
        let soft = (scaled - base).map(|x| x * x * (3.0 - 2.0 * x));
        let corner = |dx: i64, dy: i64, dz: i64| {
            let cell = [base.x as i64 + dx, base.y as i64 + dy, base.z as i64 + dz];
            let weight = |share: f64, up: i64| if up == 1 { share } else { 1.0 - share };
            hash(cell, salt) * weight(soft.x, dx) * weight(soft.y, dy) * weight(soft.z, dz)
        };
        (0..8)
            .map(|k| corner(k & 1, k >> 1 & 1, k >> 2))
            .sum::<f64>()
    };
    0.5 * layer(0.07, 1) + 0.5 * layer(0.22, 2)
}

/// A room, and boxes in front of its wall.
const ROOM: [[f64; 3]; 2] = [[-1.0, -2.0, -1.2], [3.6, 3.0, 1.4]];
const BOXES: [[[f64; 3]; 2]; 5] = [
    [[2.0, 0.2, -1.2], [2.5, 0.9, 0.0]],
    [[1.6, -1.1, -1.2], [2.2, -0.5, 0.4]],
    [[2.6, 1.5, -1.2], [3.1, 2.2, 0.8]],
    [[2.4, -0.4, 0.5], [2.9, 0.4, 1.4]],
    [[1.8, 1.1, -1.2], [2.1, 1.5, -0.5]],
];

/// What the camera sees.
fn draw(time: f64) -> Pixmap {
    let (place, yaw) = truth(time);
    let camera = turn(yaw);
    let dark = DARK.contains(&time);
    let mut data = Vec::new();
    for index in 0..WIDTH * HEIGHT {
        let (u, v) = (f64::from(index % WIDTH), f64::from(index / WIDTH));
        let ray = Vector3::new((u - 127.5) / FOCAL, (v - 95.5) / FOCAL, 1.0);
        let grey = match dark {
            true => 3.0,
            false => 20.0 + 230.0 * texture(&(place + hit(&place, &(camera * ray)))),
        };
        data.extend([grey as u8, grey as u8, grey as u8, 255]);
    }
    let size = IntSize::from_wh(WIDTH, HEIGHT).expect("a size");
    Pixmap::from_vec(data, size).expect("a picture")
}

/// The way from a place to the first surface.
fn hit(place: &Vector3<f64>, ray: &Vector3<f64>) -> Vector3<f64> {
    let ends = |low: [f64; 3], high: [f64; 3]| {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for k in 0..3 {
            let [a, b] = [low[k], high[k]].map(|wall| (wall - place[k]) / ray[k]);
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        }
        (enter, leave)
    };
    let (_, wall) = ends(ROOM[0], ROOM[1]);
    let front = |&[low, high]: &[[f64; 3]; 2]| {
        let (enter, leave) = ends(low, high);
        (enter < leave).then_some(enter)
    };
    ray * BOXES.iter().filter_map(front).fold(wall, f64::min)
}

/// State lines at 10 Hz; velocities with noise of 0.03 m/s, angles of half a degree, both rounded.
fn telemetry() -> Vec<u8> {
    let rng = &mut Pcg64::seed_from_u64(5);
    let mut noise = |sigma: f64| sigma * (rng.random::<f64>() + rng.random::<f64>() - 1.0) * 2.45;
    let mut bytes = Vec::new();
    for step in 0..72_u32 {
        let time = f64::from(step) * 0.1;
        let (place, yaw) = truth(time);
        let velocity = (place - truth(time - 0.1).0) / 0.1;
        let level = Rotation3::from_axis_angle(&Vector3::z_axis(), -yaw) * velocity;
        let level: [f64; 3] = level.into();
        let line = StateLine {
            pitch: Some(noise(0.5).round()),
            roll: Some(noise(0.5).round()),
            yaw: Some((noise(0.5) - yaw.to_degrees()).round()),
            velocity: level.map(|v| Some((10.0 * (v + noise(0.03))).round())),
            bat: Some(80.0),
            ..StateLine::default()
        };
        let line = line.encode(SdkVersion::V1_3);
        let record = Record {
            at: Duration::from_secs_f64(time),
            channel: Channel::State,
            bytes: line.as_bytes(),
        };
        encode(&record, &mut bytes);
    }
    bytes
}

/// Writes frames, camera, telemetry and the true trajectory.
fn film(folder: &Path) {
    fs::create_dir_all(folder.join("gray")).expect("a folder");
    let (mut list, mut poses) = (String::new(), String::new());
    for frame in 0..FRAMES {
        let time = f64::from(frame) / RATE;
        let name = format!("gray/{frame:04}.png");
        let png = draw(time).encode_png().expect("a picture");
        fs::write(folder.join(&name), png).expect("a file");
        list.push_str(&format!("{time} {name}\n"));
        let (p, yaw) = truth(time);
        let q = UnitQuaternion::from_rotation_matrix(&turn(yaw));
        let [x, y, z, w]: [f64; 4] = q.coords.into();
        poses.push_str(&format!("{time} {} {} {} {x} {y} {z} {w}\n", p.x, p.y, p.z));
    }
    let camera = format!("{FOCAL} 0 127.5\n0 {FOCAL} 95.5\n0 0 1\n");
    fs::write(folder.join("rgb.txt"), list).expect("a file");
    fs::write(folder.join("truth.txt"), poses).expect("a file");
    fs::write(folder.join("camera-intrinsics.txt"), camera).expect("a file");
    fs::write(folder.join("flight.tello"), telemetry()).expect("a file");
}

#[test]
fn a_filmed_flight_is_metric_and_without_gaps() {
    let place = folder("filmed flight");
    film(&place);
    let (input, truth) = (text(&place), text(&place.join("truth.txt")));
    let (fused, alone) = (text(&place.join("fused")), text(&place.join("alone")));
    let report = json(&["slam", &input, "-o", &fused]);
    println!("{report}");
    let fusion = &report["fusion"];
    assert_eq!(
        (&fusion["source"], &fusion["samples"]),
        (&"telemetry".into(), &70.into())
    );
    assert_eq!(
        (&report["poses"], &report["metric"]),
        (&FRAMES.into(), &true.into())
    );
    assert!(report["epochs"].as_u64() >= Some(2), "{report}");
    // The filter goes by the camera where it can and by telemetry in the dark.
    let count = |key: &str| fusion[key].as_u64().expect("a count");
    assert!(
        count("accepted") >= 20 && count("dead_reckoned") >= 7,
        "{fusion}"
    );
    assert_eq!(
        count("accepted") + count("rejected") + count("dead_reckoned"),
        u64::from(FRAMES)
    );
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let evaluate = |folder: &str, align: &str| {
        let estimate = format!("{folder}/trajectory.txt");
        json(&["evaluate", &estimate, &truth, "--align", align])
    };
    let metric = evaluate(&fused, "se3");
    let scaled = evaluate(&fused, "sim3");
    println!("{metric}\n{scaled}");
    assert_eq!(metric["pairs"], FRAMES);
    assert!(number(&metric["rmse"]) < 0.1, "{metric}");
    assert!((number(&scaled["scale"]) - 1.0).abs() < 0.1, "{scaled}");
    // Without telemetry the first of these frames give map units.
    let blind = ["slam", &input, "-o", &alone, "--telemetry", "none"];
    let report = json(&[&blind[..], &["--frames", "40"]].concat());
    assert_eq!(report["fusion"]["source"], "none");
    assert_eq!(
        (&report["metric"], &report["poses"]),
        (&false.into(), &report["tracked"])
    );
    let unscaled = evaluate(&alone, "sim3");
    println!("{unscaled}");
    assert!((number(&unscaled["scale"]) - 1.0).abs() > 0.3, "{unscaled}");
    let out = text(&place.join("other clock"));
    let line = complaint(&["slam", &input, "-o", &out, "--telemetry-start", "1e9"]);
    assert!(line.contains("--telemetry-start"), "{line}");
    fs::write(place.join("flight.tello"), "rubbish").expect("a file");
    let line = complaint(&["slam", &input, "-o", &out]);
    assert!(
        line.contains("flight.tello: it has no state line"),
        "{line}"
    );
}
