//! `explorer slam` and `explorer evaluate` as a user runs them.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

mod command;

use std::fs;

use command::{complaint, data, explorer, folder, json, text};
use serde_json::Value;

/// A helix, its positions multiplied by `scale`.
fn helix(scale: f64) -> String {
    let line = |index: i32| {
        let s = f64::from(index) * 0.1;
        let [x, y, z] = [s.cos(), s.sin(), 0.2 * s].map(|value| value * scale);
        format!("{s} {x} {y} {z} 0 0 0 1\n")
    };
    (0..80).map(line).collect()
}

#[test]
fn alignment_finds_the_scale_and_none_finds_the_error() {
    let folder = folder("evaluate");
    let (half, truth) = (
        text(&folder.join("half.txt")),
        text(&folder.join("truth.txt")),
    );
    fs::write(&half, helix(0.5)).expect("a file");
    fs::write(&truth, helix(1.0)).expect("a file");
    let picture = text(&folder.join("both.svg"));
    let report = json(&[
        "evaluate", &half, &truth, "--align", "sim3", "--plot", &picture,
    ]);
    for key in ["rmse", "mean", "median", "std", "max", "pairs", "scale"] {
        assert!(report[key].is_number(), "{key} in {report}");
    }
    assert!(report["rmse"].as_f64() < Some(1e-9) && report["pairs"] == 80);
    assert!((report["scale"].as_f64().expect("a number") - 2.0).abs() < 1e-9);
    assert!(fs::read(&picture).expect("a picture").starts_with(b"<svg"));
    let report = json(&[
        "evaluate", &half, &truth, "--align", "none", "--plot", &picture,
    ]);
    assert!(report["rmse"].as_f64() > Some(0.5) && report["scale"] == 1.0);
    assert_eq!(report["align_by"], "nothing");
    assert!(
        fs::read_to_string(&picture)
            .expect("a picture")
            .contains("not aligned")
    );
    // Half of every step of 0.1 is missing.
    let drift = &report["rpe_frame"]["translation"]["mean"];
    assert!((drift.as_f64().expect("a number") - 0.051).abs() < 1e-3);
}

#[test]
fn bad_trajectories_are_named() {
    let folder = folder("bad trajectories");
    let file = |name: &str, content: &str| {
        let path = folder.join(name);
        fs::write(&path, content).expect("a file");
        text(&path)
    };
    let truth = file("truth.txt", &helix(1.0));
    let line = complaint(&["evaluate", "no/such.txt", &truth]);
    assert!(line.contains("no/such.txt"), "{line}");
    let stop = |line: &str| {
        let (_, pose) = line.split_once(' ').expect("a line");
        format!("1 {pose}\n")
    };
    let stopped: String = helix(1.0).lines().map(stop).collect();
    for (content, said) in [
        ("", "empty"),
        ("# nothing\n", "no pose"),
        ("1 2 3\n", "3 columns where 8"),
        ("0 nan 0 0 0 0 0 1\n", "line 1"),
        ("500 0 0 0 0 0 0 1\n", "0 matching pairs"),
        (
            "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.2 2 0 0 0 0 0 1\n",
            "one line",
        ),
        // Every pose meets the same true one, which a scale of 0 would explain without an error.
        (stopped.as_str(), "not unique"),
    ] {
        let line = complaint(&["evaluate", &file("bad.txt", content), &truth]);
        assert!(line.contains(said), "{content:?}: {line}");
    }
    if cfg!(unix) {
        let line = complaint(&["evaluate", "/dev/zero", &truth]);
        assert!(line.contains("more than the"), "{line}");
    }
    let usage = explorer(&["evaluate", &truth, &truth, "--align", "sim2"]);
    assert_eq!(usage.status.code(), Some(2));
}

#[test]
fn folders_that_are_no_sequence_are_refused() {
    let folder = folder("no sequence");
    let out = text(&folder.join("out"));
    let line = complaint(&["slam", &text(&folder), "-o", &out]);
    assert!(
        line.contains("neither rgb.txt nor PNG or JPEG files"),
        "{line}"
    );
    fs::write(folder.join("rgb.txt"), "# none\n").expect("a file");
    let line = complaint(&["slam", &text(&folder), "-o", &out]);
    assert!(line.contains("lists no frame"), "{line}");
    fs::write(folder.join("rgb.txt"), "0.0 missing.png\n").expect("a file");
    let line = complaint(&["slam", &text(&folder), "-o", &out]);
    assert!(line.contains("missing.png cannot be read"), "{line}");
    fs::write(folder.join("missing.png"), "not a picture").expect("a file");
    let line = complaint(&["slam", &text(&folder), "-o", &out]);
    assert!(line.contains("cannot be decoded"), "{line}");
    let line = complaint(&["slam", &text(&folder), "-o", &out, "--depth", "sensor"]);
    assert!(
        line.contains("no frame of the sequence has a depth"),
        "{line}"
    );
    // A picture that breaks off says so, and not only that it cannot be read.
    fs::write(folder.join("missing.png"), b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR").expect("a file");
    let line = complaint(&["slam", &text(&folder), "-o", &out]);
    let (_, cause) = line
        .split_once("the PNG cannot be read: ")
        .expect("a cause");
    assert!(!cause.starts_with(';'), "{line}");
    let line = complaint(&["slam", &text(&folder.join("absent")), "-o", &out]);
    assert!(line.contains("absent cannot be read"), "{line}");
    let usage = explorer(&["slam", &text(&folder), "-o", &out, "--depth", "sonar"]);
    assert_eq!(usage.status.code(), Some(2));
}

#[test]
fn a_kitchen_becomes_a_trajectory_a_map_and_pictures() {
    let Some(sequence) = data("seven_scenes_redkitchen_part1") else {
        return;
    };
    let out = folder("kitchen");
    let (input, output) = (text(&sequence), text(&out));
    let report = json(&["slam", &input, "-o", &output, "--frames", "20"]);
    for key in ["frames", "tracked", "keyframes", "ms_median", "ms_p95"] {
        assert!(report[key].is_number(), "{key} in {report}");
    }
    assert_eq!(
        (&report["frames"], &report["tracked"]),
        (&Value::from(20), &Value::from(20))
    );
    for name in report["files"].as_array().expect("a list") {
        let path = out.join(name.as_str().expect("a name"));
        assert!(fs::metadata(&path).expect("a file").len() > 0, "{name}");
    }
    for name in ["features", "edges", "junctions", "depth", "trajectory"] {
        let picture = fs::read(out.join(name).with_extension("png")).expect("a picture");
        assert!(picture.starts_with(b"\x89PNG"), "{name}");
    }
    let truth = text(&sequence.join("groundtruth_tum.txt"));
    let found = text(&out.join("trajectory.txt"));
    let error = json(&["evaluate", &found, &truth, "--align", "se3"]);
    assert!(
        error["pairs"] == 20 && error["rmse"].as_f64() < Some(0.03),
        "{error}"
    );
    // What slam writes is an INPUT of the other commands.
    let cleaned = json(&["clean", &output]);
    assert_eq!(cleaned["points"], report["points"]);
}

#[test]
fn evaluate_gives_the_published_figures() {
    let Some(folder) = data("trajectories") else {
        return;
    };
    let truth = text(&folder.join("freiburg1_xyz-groundtruth.txt"));
    for (name, align, pairs, rmse, scale) in [
        ("freiburg1_xyz-rgbdslam.txt", "se3", 785, 0.013470, 1.0),
        (
            "freiburg1_xyz-ORB_kf_mono.txt",
            "sim3",
            32,
            0.009755,
            1.105622,
        ),
    ] {
        let report = json(&[
            "evaluate",
            &text(&folder.join(name)),
            &truth,
            "--align",
            align,
        ]);
        let number = |key: &str| report[key].as_f64().expect("a number");
        assert_eq!(report["pairs"], pairs, "{name}");
        assert!((number("rmse") - rmse).abs() < 1e-6, "{name}");
        assert!((number("scale") - scale).abs() < 1e-6, "{name}");
    }
}
