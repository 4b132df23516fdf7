//! The explorer command as a user runs it: results on stdout, one clear line for bad input.

#![allow(clippy::expect_used, reason = "a test that fails should say where")]

mod command;

use std::fs;

use command::{complaint, data, explorer, file, folder, json};
use serde_json::Value;

fn assert_keys(value: &Value, keys: &[&str]) {
    for key in keys {
        assert!(value.get(key).is_some(), "{key} is missing in {value}");
    }
}

/// A room of 6 x 4 m with a door in the wall at x = 3, points in metres, as CSV. The walls are solid
/// with points every 0.1 m, so hulls close them.
fn room() -> String {
    let mut text = String::from("x,y,z\n");
    let mut wall = |x: f64, y: f64| {
        for level in 0..=8 {
            text.push_str(&format!("{x},{y},{}\n", f64::from(level) * 0.25));
        }
    };
    for step in 0..=60 {
        let along = f64::from(step) * 0.1 - 3.0;
        wall(along, 2.0);
        wall(along, -2.0);
    }
    for step in 0..=40 {
        let along = f64::from(step) * 0.1 - 2.0;
        wall(-3.0, along);
        if along.abs() > 0.5 {
            wall(3.0, along);
        }
        // The next room's far wall, seen through the door.
        if along.abs() < 1.0 {
            wall(7.0, along);
        }
    }
    text
}

const CLEAN: [&str; 6] = [
    "points",
    "kept",
    "removed_indices",
    "seconds",
    "iterations",
    "certificate",
];
const OBSTACLES: [&str; 6] = [
    "obstacles",
    "degenerate",
    "inertia",
    "proven_free_voxels",
    "resolution",
    "seconds",
];
const PLAN: [&str; 7] = [
    "status",
    "path",
    "length",
    "raw_length",
    "checks",
    "seconds",
    "min_clearance",
];

const METHODS: [&str; 10] = [
    "submodular",
    "paper",
    "nearest",
    "supported",
    "connected",
    "rays",
    "sor",
    "ror",
    "lof",
    "dbscan",
];

#[test]
fn clean_lists_its_methods_in_the_help_and_when_it_does_not_know_one() {
    let help = String::from_utf8(explorer(&["clean", "--help"]).stdout).expect("text");
    let refused = explorer(&["clean", "map.ply", "--method", "magic"]);
    assert_eq!(refused.status.code(), Some(2));
    let refused = String::from_utf8(refused.stderr).expect("text");
    for method in METHODS {
        assert!(help.contains(&format!("- {method}:")), "{method}: {help}");
        assert!(refused.contains(method), "{method}: {refused}");
    }
}

#[test]
fn clean_keeps_and_writes_what_it_says() {
    let folder = folder("clean");
    let input = file(&folder, "room.csv", &format!("{}40,40,40\n", room()));
    let kept = folder.join("kept.ply").display().to_string();
    for method in METHODS {
        let report = json(&["clean", &input, "--method", method, "-o", &kept, "--json"]);
        assert_keys(&report, &CLEAN);
        let removed = report["removed_indices"].as_array().expect("a list").len() as u64;
        let (points, kept_count) = (report["points"].as_u64(), report["kept"].as_u64());
        assert_eq!(points, kept_count.map(|kept| kept + removed), "{method}");
        let again = json(&["clean", &kept, "--method", "paper", "--json"]);
        assert_eq!(
            again["points"].as_u64(),
            kept_count,
            "{method}: the file holds what was kept"
        );
    }
    let report = json(&["clean", &input, "--json", "--repeat", "3"]);
    let last = report["points"].as_u64().map(|points| points - 1);
    let removed: Vec<Option<u64>> = report["removed_indices"]
        .as_array()
        .expect("a list")
        .iter()
        .map(Value::as_u64)
        .collect();
    assert!(removed.contains(&last), "the point far away stays");
}

#[test]
fn clean_says_so_when_nothing_is_left_and_withstands_absurd_points() {
    let folder = folder("absurd");
    let one = file(&folder, "one.csv", "1,2,3\n");
    let kept = folder.join("kept.ply");
    let output = kept.display().to_string();
    for method in ["ror", "dbscan"] {
        let line = complaint(&["clean", &one, "--method", method, "-o", &output]);
        assert!(line.contains("nothing is left to write"), "{line}");
        assert!(!kept.exists());
        let report = json(&["clean", &one, "--method", method, "--json"]);
        assert_eq!(report["kept"].as_u64(), Some(0), "{method}");
    }
    let far = file(&folder, "far.csv", &format!("{}1e300,-1e300,0\n", room()));
    let last = room().lines().count() as u64 - 1;
    for method in METHODS.into_iter().filter(|method| *method != "paper") {
        let report = json(&["clean", &far, "--method", method, "--json"]);
        let removed = report["removed_indices"].as_array().expect("a list");
        assert_eq!(
            removed.last().and_then(Value::as_u64),
            Some(last),
            "{method}"
        );
        assert!(report["kept"].as_u64() > Some(last / 2), "{method}");
    }
}

#[test]
fn clean_writes_a_score_a_point_and_says_when_it_judged_none() {
    let folder = folder("clean-scores");
    let input = file(&folder, "room.csv", &format!("{}40,40,40\n", room()));
    let path = folder.join("scores.csv");
    let scores = path.display().to_string();
    let report = json(&["clean", &input, "--scores", &scores, "--json"]);
    let text = fs::read_to_string(&path).expect("scores");
    let removed: Vec<u64> = (text.lines().skip(1))
        .filter_map(|line| line.split_once(','))
        .filter(|(_, score)| score.parse::<f64>().expect("a score") >= 0.0)
        .map(|(row, _)| row.parse().expect("a row"))
        .collect();
    assert_eq!(report["removed_indices"], Value::from(removed));
    assert_eq!(text.lines().count() as u64 - 1, report["points"]);
    let kept = folder.join("kept.ply");
    let kept_name = kept.display().to_string();
    let line = complaint(&[
        "clean", &input, "--scores", &scores, "-o", &kept_name, "--method", "sor",
    ]);
    assert!(line.contains("a baseline gives no scores"), "{line}");
    assert!(!kept.exists(), "refused before anything is written");
    let refused = explorer(&["clean", &input, "-o", "kept.txt"]);
    assert_eq!(refused.status.code(), Some(2));
    for rows in [
        "1,2,3\n4,5,6\n",
        "1,1,1\n1,1,1\n1,1,1\n1,1,1\n1,1,1\n2,2,2\n",
    ] {
        let few = file(&folder, "few.csv", rows);
        let told = String::from_utf8(explorer(&["clean", &few]).stdout).expect("text");
        assert!(told.contains("none judged"), "{told}");
    }
}

#[test]
fn exits_finds_the_door() {
    let folder = folder("exits");
    let input = file(&folder, "room.csv", &room());
    let report = json(&[
        "exits",
        &input,
        "--position",
        "0,0,1",
        "--up",
        "0,0,1",
        "--scale",
        "1",
        "--json",
    ]);
    let best = &report["exits"][0];
    assert_keys(
        best,
        &["direction", "position", "width_rad", "range", "score"],
    );
    let x = best["direction"][0].as_f64().expect("a number");
    assert!(x > 0.95, "the door lies at +x: {best}");
    assert_eq!(report["unseen"].as_array().map(Vec::len), Some(0));
}

#[test]
fn obstacles_and_a_path_between_them() {
    let folder = folder("obstacles");
    let input = file(&folder, "room.csv", &room());
    let hulls = folder.join("hulls.obj").display().to_string();
    let report = json(&[
        "obstacles",
        &input,
        "--clusters",
        "80",
        "-o",
        &hulls,
        "--json",
    ]);
    assert_keys(&report, &OBSTACLES);
    assert_eq!(report["obstacles"].as_u64(), Some(80));
    assert!(fs::read_to_string(&hulls).expect("a mesh").contains("\nv "));
    for planner in ["rrt", "rrt-connect", "rrt-star", "informed-rrt-star"] {
        let report = json(&[
            "plan",
            &input,
            "--from",
            "-2,0,1",
            "--to",
            "4.5,0.5,1",
            "--radius",
            "0.15",
            "--scale",
            "1",
            "--planner",
            planner,
            "--json",
        ]);
        assert_keys(&report, &PLAN);
        assert_eq!(report["status"], "found", "{planner}");
        let (length, raw) = (report["length"].as_f64(), report["raw_length"].as_f64());
        assert!(
            length <= raw && length > Some(6.4),
            "{planner}: {length:?} of {raw:?}"
        );
    }
    let line = complaint(&[
        "plan",
        &input,
        "--from",
        "-2,0,1",
        "--to",
        "4.5,0,1",
        "--space",
        "proven-free",
        "--json",
    ]);
    assert!(line.contains("no observations"), "{line}");
}

#[test]
fn map_gives_the_union_and_a_picture() {
    let folder = folder("map");
    let input = file(&folder, "room.csv", &room());
    for (name, begins) in [("map.svg", b"<svg" as &[u8]), ("map.png", b"\x89PNG")] {
        let picture = folder.join(name).display().to_string();
        let report = json(&[
            "map",
            &input,
            "--position",
            "0,0,1",
            "--plot",
            &picture,
            "--json",
        ]);
        assert_keys(&report, &CLEAN);
        assert_keys(&report, &OBSTACLES);
        assert_keys(&report, &PLAN);
        assert_keys(&report, &["exits"]);
        assert!(
            fs::read(&picture).expect("a picture").starts_with(begins),
            "{name}"
        );
    }
    let line = complaint(&["clean", &input, "--plot", "picture.gif"]);
    assert!(line.contains(".svg or .png"), "{line}");
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let folder = folder("seed");
    let input = file(&folder, "room.csv", &room());
    let path = |seed: &str| {
        let plan = [
            "plan",
            &input,
            "--from",
            "-2,1.5,1",
            "--to",
            "4.5,1.7,1",
            "--scale",
            "1",
        ];
        let report = json(&[&plan[..], &["--seed", seed, "--refine", "none", "--json"]].concat());
        report["path"].clone()
    };
    assert_eq!(path("5"), path("5"));
    assert_ne!(path("5"), path("6"));
}

#[test]
fn missing_and_empty_files() {
    let folder = folder("missing");
    let line = complaint(&["clean", "no/such/map.ply"]);
    assert!(line.contains("no/such/map.ply: no such file"), "{line}");
    for name in ["empty.csv", "empty.ply", "empty.pcd"] {
        let line = complaint(&["clean", &file(&folder, name, "")]);
        assert!(line.contains("the file is empty"), "{line}");
    }
    let line = complaint(&["map", &folder.display().to_string()]);
    assert!(line.contains("holds no map.ply"), "{line}");
}

#[test]
fn nan_and_letters_are_named_with_their_line() {
    let folder = folder("letters");
    let line = complaint(&["clean", &file(&folder, "nan.csv", "1,2,3\n1,NaN,3\n")]);
    assert!(
        line.contains("line 2: the value in column 2 is NaN"),
        "{line}"
    );
    let line = complaint(&[
        "map",
        &file(&folder, "letters.csv", "1,2,3\n4,5,6\n7,eight,9\n"),
    ]);
    assert!(
        line.contains("line 3: 'eight' in column 2 is not a number"),
        "{line}"
    );
}

#[test]
fn truncated_and_lying_ply_files() {
    let folder = folder("lies");
    let header = "ply\nformat ascii 1.0\nelement vertex COUNT\nproperty float x\n\
        property float y\nproperty float z\nend_header\n1 2 3\n4 5 6\n";
    for (name, count) in [("truncated.ply", "3"), ("absurd.ply", "999999999999999999")] {
        let line = complaint(&[
            "clean",
            &file(&folder, name, &header.replace("COUNT", count)),
        ]);
        assert!(
            line.contains(&format!("promises {count} vertex rows")),
            "{line}"
        );
    }
    let line = complaint(&[
        "clean",
        &file(&folder, "less.ply", &header.replace("COUNT", "1")),
    ]);
    assert!(line.contains("more data follow (line 9)"), "{line}");
}

#[test]
fn positions_far_outside_and_too_many_clusters() {
    let folder = folder("outside");
    let input = file(&folder, "room.csv", &room());
    for command in ["map", "exits"] {
        let line = complaint(&[command, &input, "--position", "900,0,0", "--up", "0,0,1"]);
        assert!(
            line.contains("--position 900,0,0 lies") && line.contains("outside the map"),
            "{line}"
        );
    }
    let line = complaint(&["plan", &input, "--from", "0,0,1", "--to", "0,0,-5e3"]);
    assert!(line.contains("--to 0,0,-5000 lies"), "{line}");
    let few = file(&folder, "few.csv", "0,0,0\n1,0,0\n0,1,0\n");
    let line = complaint(&["obstacles", &few, "--clusters", "4"]);
    assert!(
        line.contains("--clusters 4 is more than the map's 3 points"),
        "{line}"
    );
    let line = complaint(&["exits", &few, "--position", "0,0,0", "--up", "0,0,1"]);
    assert!(line.contains("3 points"), "{line}");
}

#[test]
fn wrong_usage_is_another_exit_code() {
    for arguments in [
        &["fly-away"][..],
        &["clean"],
        &["exits", "map.ply", "--position", "1,2", "--up", "0,0,1"],
        &["exits", "map.ply", "--position", "1,2,3", "--up", "0,0,0"],
        &["obstacles", "map.ply", "--clusters", "many"],
        &["clean", "map.ply", "--method", "magic"],
        &[
            "plan", "map.ply", "--from", "0,0,0", "--to", "1,1,1", "--radius", "-1",
        ],
    ] {
        assert_eq!(explorer(arguments).status.code(), Some(2), "{arguments:?}");
    }
    assert_eq!(explorer(&["--help"]).status.code(), Some(0));
}

#[test]
fn unknown_worlds_are_refused_with_the_known_ones() {
    let line = complaint(&["simulate", "--world", "castle", "--json"]);
    assert!(
        line.contains("castle") && line.contains("apartment"),
        "{line}"
    );
}

#[test]
fn real_maps_run_to_the_end() {
    let Some(data) = data("") else { return };
    let folder = folder("real");
    for (path, up, points) in [
        ("tello-orbslam-rooms/fares.csv", "0,-1,0", 4_436),
        ("tello-orbslam-rooms/shahar_4.csv", "0,-1,0", 3_406),
        (
            "orbslam3-maps/sevenscenes_kitchen_mono_first500",
            "0,-1,0",
            4_460,
        ),
        ("orbslam3-maps/kitti_mono_51frames", "0,-1,0", 1_132),
        (
            "orbslam3-maps/euroc_v101_stationary_stereo/map.ply",
            "0,-1,0",
            544,
        ),
        ("synthetic-apartment/apt_10k_o15.ply", "0,0,1", 10_000),
    ] {
        let input = data.join(path).display().to_string();
        let picture = folder.join("map.png").display().to_string();
        let report = json(&["map", &input, "--up", up, "--plot", &picture, "--json"]);
        assert_eq!(report["points"].as_u64(), Some(points), "{path}");
        assert_keys(&report, &PLAN);
        assert!(
            fs::metadata(&picture).expect("a picture").len() > 10_000,
            "{path}"
        );
    }
}
