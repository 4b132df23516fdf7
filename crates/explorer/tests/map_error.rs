//! `explorer evaluate --map` on a wall that is GENERATED, seen by a depth camera that moves along it.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

mod command;

use std::fs;
use std::path::{Path, PathBuf};

use command::{complaint, explorer, file, folder, json, text};

const SIZE: [u32; 2] = [80, 60];
const FRAMES: u32 = 6;
/// Metres from the camera's path to the wall.
const WALL: f64 = 2.0;

fn place(frame: u32) -> [f64; 3] {
    let k = f64::from(frame);
    [0.1 * k, 0.02 * k.sin(), 0.0]
}

/// A picture of one grey, of 8 or 16 bits.
fn png(path: &Path, bits: png::BitDepth, pixel: &[u8]) {
    let file = fs::File::create(path).expect("a file");
    let mut encoder = png::Encoder::new(file, SIZE[0], SIZE[1]);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(bits);
    let mut writer = encoder.write_header().expect("a header");
    let pixels = pixel.repeat((SIZE[0] * SIZE[1]) as usize);
    writer.write_image_data(&pixels).expect("pixels");
}

/// Frames in the plain layout whose depth images all read `millimetres`.
fn sequence(place: PathBuf, millimetres: u16) -> PathBuf {
    for name in ["gray", "depth"] {
        fs::create_dir_all(place.join(name)).expect("a folder");
    }
    for frame in 0..FRAMES {
        let name = format!("{frame:04}.png");
        png(&place.join("gray").join(&name), png::BitDepth::Eight, &[90]);
        let reading = millimetres.to_be_bytes();
        png(
            &place.join("depth").join(&name),
            png::BitDepth::Sixteen,
            &reading,
        );
    }
    file(
        &place,
        "camera-intrinsics.txt",
        "100 0 40\n0 100 30\n0 0 1\n",
    );
    place
}

/// Into the estimate's frame: half as large, a quarter turn about z, moved.
fn estimated([x, y, z]: [f64; 3]) -> [f64; 3] {
    [-0.5 * y + 3.0, 0.5 * x - 1.0, 0.5 * z + 0.25]
}

fn line([x, y, z]: [f64; 3]) -> String {
    format!("{x} {y} {z}")
}

/// The true trajectory, and the estimate.
fn trajectories(folder: &Path) -> [String; 2] {
    let poses = |frame: &dyn Fn([f64; 3]) -> [f64; 3], turn: &str| -> String {
        let pose = |k: u32| format!("{} {} {turn}\n", f64::from(k) / 30.0, line(frame(place(k))));
        (0..FRAMES).map(pose).collect()
    };
    let quarter = "0 0 0.7071067811865476 0.7071067811865476";
    [
        file(folder, "truth.txt", &poses(&|p| p, "0 0 0 1")),
        file(folder, "estimate.txt", &poses(&estimated, quarter)),
    ]
}

/// The wall from x = -0.7 to `right` in steps of 5 cm as a map; one point in `spoilt` hangs 0.3 m before it.
fn map(folder: &Path, name: &str, right: f64, spoilt: Option<usize>) -> String {
    let columns = ((right + 0.7) / 0.05).round() as usize;
    let point = |index: usize| {
        let [x, y] = [index % columns, index / columns].map(|k| 0.05 * k as f64);
        let off = spoilt.is_some_and(|each| index.is_multiple_of(each));
        let z = if off { WALL - 0.3 } else { WALL };
        line(estimated([x - 0.7, y - 0.55, z])) + "\n"
    };
    let points: String = (0..columns * 23).map(point).collect();
    file(folder, name, &points)
}

#[test]
fn a_wall_is_measured_in_the_frame_of_the_truth() {
    let folder = folder("map error");
    let input = text(&sequence(folder.join("wall"), 2000));
    let [truth, estimate] = trajectories(&folder);
    let picture = text(&folder.join("wall.svg"));
    let measure = |map: &str| {
        let more = ["--map", map, "--sequence", &input, "--plot", &picture];
        let report = json(&[&["evaluate", &estimate, &truth][..], &more].concat());
        assert!((report["scale"].as_f64().expect("a scale") - 2.0).abs() < 1e-9);
        report["map"].clone()
    };
    let number = |report: &serde_json::Value, key: &str| report[key].as_f64().expect("a number");
    let whole = measure(&map(&folder, "whole.xyz", 1.2, None));
    assert_eq!(whole["depth_images"], FRAMES);
    assert_eq!(number(&whole, "accuracy"), 1.0, "{whole}");
    assert!(number(&whole, "completeness") > 0.9, "{whole}");
    assert!(number(&whole["distance"], "max") < 0.03, "{whole}");
    let spoilt = measure(&map(&folder, "spoilt.xyz", 0.3, Some(4)));
    assert_eq!(number(&spoilt, "accuracy"), 0.75, "{spoilt}");
    assert!(
        (0.35..0.6).contains(&number(&spoilt, "completeness")),
        "{spoilt}"
    );
    assert!(
        (number(&spoilt["distance"], "max") - 0.3).abs() < 0.01,
        "{spoilt}"
    );
    let drawn = fs::read_to_string(&picture).expect("a picture");
    assert!(drawn.starts_with("<svg") && drawn.contains("farther: 25.0 %"));
    let report = json(&["evaluate", &estimate, &truth]);
    assert!(report["map"].is_null(), "{report}");
}

#[test]
fn errors_of_a_short_path_do_not_swing_the_map() {
    let folder = folder("map error short");
    let input = text(&sequence(folder.join("wall"), 2000));
    let [truth, _] = trajectories(&folder);
    // The orientations are right; the positions drift by 4 cm towards the wall over half a metre.
    let drifted = |k: u32| {
        let [x, y, z] = place(k);
        let time = f64::from(k) / 30.0;
        format!("{time} {} 0 0 0 1\n", line([x, y, z + 0.08 * x]))
    };
    let estimate = file(
        &folder,
        "drifted.txt",
        &(0..FRAMES).map(drifted).collect::<String>(),
    );
    let far = |k: u32| line([0.04 * f64::from(k) - 0.7, 0.0, WALL]) + "\n";
    let map = file(&folder, "wall.xyz", &(0..45).map(far).collect::<String>());
    let measure = |more: &[&str]| {
        let arguments = ["--align", "se3", "--map", &map, "--sequence", &input];
        json(&[&["evaluate", &estimate, &truth][..], &arguments, more].concat())
    };
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let usual = measure(&[]);
    assert_eq!(
        (&usual["align_by"], &usual["map"]["align_by"]),
        (&"positions".into(), &"poses".into())
    );
    assert!(number(&usual["map"]["rotation_deg"]) < 1e-6, "{usual}");
    assert_eq!(number(&usual["map"]["accuracy"]), 1.0, "{usual}");
    // Positions tilt everything by four degrees: the wall's right end leaves the threshold.
    let tilted = measure(&["--align-by", "positions"]);
    assert!(number(&tilted["map"]["rotation_deg"]) > 4.0, "{tilted}");
    assert!(number(&tilted["map"]["accuracy"]) < 0.8, "{tilted}");
    assert_eq!(tilted["rmse"], usual["rmse"]);
    let by_poses = measure(&["--align-by", "poses"]);
    assert!(number(&by_poses["rmse"]) > number(&usual["rmse"]));
    assert_eq!(by_poses["map"], usual["map"]);
}

#[test]
fn what_cannot_be_measured_is_said_in_a_line() {
    let folder = folder("map error rubbish");
    let wall = sequence(folder.join("wall"), 2000);
    let [truth, estimate] = trajectories(&folder);
    let good = map(&folder, "good.xyz", 1.2, None);
    let complain = |map: &str, sequence: &Path, said: &str| {
        let sequence = text(sequence);
        let more = ["--map", map, "--sequence", &sequence];
        let line = complaint(&[&["evaluate", &estimate, &truth][..], &more].concat());
        assert!(line.contains(said), "{said:?}: {line}");
    };
    complain(&good, &folder.join("none"), "none cannot be read");
    fs::create_dir(folder.join("void")).expect("a folder");
    complain(&good, &folder.join("void"), "neither rgb.txt nor");
    complain("no/such.ply", &wall, "no/such.ply");
    let header = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n\
                  property float z\nend_header\n";
    complain(&file(&folder, "empty.ply", header), &wall, "no points");
    complain(
        &file(&folder, "far.xyz", "90 90 90\n91 90 90\n"),
        &wall,
        "no point of",
    );
    let blind = sequence(folder.join("blind"), 0);
    complain(&good, &blind, "no usable reading");
    let late = sequence(folder.join("late"), 2000);
    file(&late, "timestamps.txt", "500\n501\n502\n503\n504\n505\n");
    complain(&good, &late, "no frame within 0.01 s");
    fs::remove_file(wall.join("camera-intrinsics.txt")).expect("the camera was there");
    complain(&good, &wall, "names no camera");
    fs::remove_dir_all(wall.join("depth")).expect("depth was there");
    complain(&good, &wall, "has no depth image");
    let usage = explorer(&["evaluate", &estimate, &truth, "--map", &good]);
    assert_eq!(usage.status.code(), Some(2));
}
