//! Analytic rooms with 0 to 4 doors of known width, seen through or not.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod walls;

use std::f64::consts::{FRAC_PI_2, TAU};

use exit_finder::{
    AffinePlane, ExitConfig, ExitKind, ExitReport, ExitView, Gaze, HeightBand, Ray, Rejection,
    find_exits,
};
use walls::{Walls, room};

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn search(points: &[[f64; 3]], eye: [f64; 2], config: &ExitConfig) -> ExitReport {
    let agent = [eye[0], eye[1], 1.0];
    let plane = AffinePlane::from_up(UP, agent).unwrap();
    find_exits(points, agent, &plane, &ExitView::default(), config).unwrap()
}

/// A 4 m × 4 m room around the origin with doors of 0.9 m in the middle of the first `doors` sides.
fn square(doors: usize) -> Walls {
    room(
        [-2.0; 2],
        [2.0; 2],
        std::array::from_fn(|i| (i < doors).then_some([1.55, 2.45])),
    )
}

/// The same inside a larger hall whose walls are seen through the doors.
fn square_in_hall(doors: usize) -> Walls {
    let hall = room([-6.0; 2], [6.0; 2], [None; 4]);
    Walls([square(doors).0, hall.0].concat())
}

fn assert_doors(report: &ExitReport, doors: usize, kind: ExitKind) {
    assert_eq!(
        report.exits.len(),
        doors,
        "{:?} {:?}",
        report.exits,
        report.rejected
    );
    let bearings: Vec<f64> = report.exits.iter().map(|exit| exit.bearing_rad).collect();
    for door in 0..doors {
        let expected = (door as f64 - 1.0) * FRAC_PI_2;
        let near = |bearing: &f64| {
            let off = (bearing - expected + 0.5).rem_euclid(TAU) - 0.5;
            off.abs() < 3f64.to_radians()
        };
        assert!(bearings.iter().any(near), "{expected} {bearings:?}");
    }
    for exit in &report.exits {
        assert_eq!(exit.kind, kind);
        // A gap ends where the window of the smoothing ends, an opening in a wall at its jambs.
        let spare = if kind == ExitKind::Empty { 0.25 } else { 0.1 };
        assert!((exit.width - 0.9).abs() < spare, "width {}", exit.width);
        let [a, b] = exit.jambs;
        let between = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
        assert!((between - exit.width).abs() < 1e-9 && exit.sector.width_rad == exit.width_rad);
        assert!((exit.range - 2.4).abs() < 0.3, "range {}", exit.range);
    }
}

#[test]
fn dark_doors_are_found_as_gaps() {
    for doors in 0..=4 {
        let report = search(
            &square(doors).seen_from([0.0; 2], 1080, 20.0),
            [0.0; 2],
            &ExitConfig::default(),
        );
        assert_doors(&report, doors, ExitKind::Empty);
        assert!(report.unseen.is_empty());
    }
}

#[test]
fn doors_seen_through_are_found_as_range_jumps() {
    for doors in 0..=4 {
        let points = square_in_hall(doors).seen_from([0.0; 2], 1080, 20.0);
        assert_doors(
            &search(&points, [0.0; 2], &ExitConfig::default()),
            doors,
            ExitKind::RangeJump,
        );
    }
}

#[test]
fn the_paper_finds_gaps_only() {
    for config in [ExitConfig::paper(), ExitConfig::paper_repaired()] {
        let dark = square(2).seen_from([0.3, 0.1], 1080, 20.0);
        let best = search(&dark, [0.3, 0.1], &config).exits[0].clone();
        assert!((best.bearing_rad).rem_euclid(TAU) > 0.1 || best.bearing_rad < 6.2);
    }
    let seen_through = square_in_hall(2).seen_from([0.0; 2], 1080, 20.0);
    assert!(
        search(&seen_through, [0.0; 2], &ExitConfig::paper_repaired())
            .exits
            .is_empty()
    );
    // As printed, the bin [360°, 361°) is always empty: an enclosed room has an exit there.
    let literal = search(&seen_through, [0.0; 2], &ExitConfig::paper());
    assert_eq!(literal.exits.len(), 1);
    assert!((literal.exits[0].width_rad - 1f64.to_radians()).abs() < 1e-9);
}

#[test]
fn rooms_without_doors_are_enclosed() {
    for (low, high, eye) in [
        ([-2.0, -2.0], [2.0, 2.0], [0.0, 0.0]),
        ([-2.0, -2.0], [2.0, 2.0], [1.2, -1.3]),
        ([-1.0, -1.0], [7.0, 1.0], [0.0, 0.2]),
        ([-1.0, -0.9], [9.0, 0.9], [0.0, 0.0]),
        ([-5.0, -0.9], [5.0, 0.9], [0.0, 0.1]),
    ] {
        let points = room(low, high, [None; 4]).seen_from(eye, 1080, 20.0);
        let report = search(&points, eye, &ExitConfig::default());
        assert!(
            report.exits.is_empty(),
            "{low:?} {high:?} {:?}",
            report.exits
        );
    }
}

#[test]
fn an_l_shaped_room_opens_round_its_corner() {
    let corners = [
        [-2.0, -2.0],
        [5.0, -2.0],
        [5.0, 0.0],
        [1.0, 0.0],
        [1.0, 4.0],
        [-2.0, 4.0],
    ];
    let walls = (0..6).fold(Walls::default(), |w, i| {
        w.wall(corners[i], corners[(i + 1) % 6])
    });
    let eye = [-1.0, 3.0];
    let report = search(
        &walls.seen_from(eye, 1080, 20.0),
        eye,
        &ExitConfig::default(),
    );
    assert!(report.exits.len() <= 1, "{:?}", report.exits);
}

#[test]
fn a_circle_without_an_empty_bin_is_enclosed() {
    let circle: Vec<[f64; 3]> = (0..1440)
        .map(|i| (f64::from(i) * 0.25 + 0.1).to_radians())
        .map(|bearing| [3.0 * bearing.cos(), 3.0 * bearing.sin(), 1.0])
        .collect();
    for config in [ExitConfig::default(), ExitConfig::paper_repaired()] {
        let report = search(&circle, [0.0; 2], &config);
        assert!(report.profile.bins.iter().all(|bin| bin.count > 0));
        assert!(report.exits.is_empty() && report.unseen.is_empty());
    }
}

#[test]
fn a_round_room_opens_where_its_door_is() {
    for (radius, half) in [(3.0, 10.0f64), (2.0, 14.0), (4.0, 8.0)] {
        let points: Vec<[f64; 3]> = (0..1440)
            .map(|i| (f64::from(i) * 0.25 + 0.1).to_radians())
            .map(|bearing| {
                let range = if bearing.cos() > half.to_radians().cos() {
                    8.0
                } else {
                    radius
                };
                [range * bearing.cos(), range * bearing.sin(), 1.0]
            })
            .collect();
        let report = search(&points, [0.0; 2], &ExitConfig::default());
        assert_eq!(report.exits.len(), 1, "{radius} {:?}", report.exits);
        assert!(report.exits[0].direction[0] > 0.99);
    }
}

#[test]
fn a_circle_of_empty_bins_is_one_sector() {
    // Every bin holds fewer points than it needs to count as occupied.
    let points = square(0).seen_from([0.0; 2], 360, 20.0);
    let config = |base: ExitConfig| ExitConfig {
        min_count: 1000,
        ..base
    };
    let paper = search(&points, [0.0; 2], &config(ExitConfig::paper_repaired()));
    assert_eq!(paper.exits.len(), 1);
    assert!((paper.exits[0].width_rad - TAU).abs() < 1e-9);
    assert!(paper.exits[0].position.iter().all(|x| x.is_finite()));
    let default = search(&points, [0.0; 2], &config(ExitConfig::default()));
    assert!(default.exits.is_empty());
    assert!((default.unseen[0].width_rad - TAU).abs() < 1e-9);
}

#[test]
fn too_narrow_a_gap_is_turned_down_and_said_so() {
    let points = square_in_hall(1).seen_from([0.0; 2], 1080, 20.0);
    let config = ExitConfig {
        min_width: Some(1.5),
        ..Default::default()
    };
    let report = search(&points, [0.0; 2], &config);
    assert!(report.exits.is_empty());
    assert!(
        report
            .rejected
            .iter()
            .any(|r| matches!(r.reason, Rejection::TooNarrow { .. }))
    );
}

#[test]
fn a_gap_across_zero_is_one() {
    let walls = room([-2.0; 2], [2.0; 2], [None, Some([1.55, 2.45]), None, None]);
    let points = walls.seen_from([0.0; 2], 1080, 20.0);
    let repaired = search(&points, [0.0; 2], &ExitConfig::paper_repaired());
    assert_eq!(repaired.exits.len(), 1);
    let linear = search(&points, [0.0; 2], &ExitConfig::paper());
    assert_eq!(
        linear.exits.len(),
        2,
        "the text's segment of [0, 2π] is cut in two"
    );
}

#[test]
fn jambs_are_the_two_ends_of_the_door() {
    // A door from x = 0.6 to 1.5 in the wall y = −2, seen at a slant: its jambs are 2.09 and 2.5 away.
    let door = [Some([2.6, 3.5]), None, None, None];
    let hall = room([-6.0; 2], [6.0; 2], [None; 4]);
    let walls = Walls([room([-2.0; 2], [2.0; 2], door).0, hall.0].concat());
    let points = walls.seen_from([0.0; 2], 1440, 20.0);
    let report = search(&points, [0.0; 2], &ExitConfig::default());
    assert_eq!(report.exits.len(), 1);
    let exit = &report.exits[0];
    for (jamb, expected) in exit.jambs.iter().zip([[0.6, -2.0, 1.0], [1.5, -2.0, 1.0]]) {
        let off = (0..3).map(|i| (jamb[i] - expected[i]).powi(2)).sum::<f64>();
        assert!(off.sqrt() < 0.08, "{jamb:?} {expected:?}");
    }
    assert!((exit.width - 0.9).abs() < 0.1, "{}", exit.width);
}

#[test]
fn a_jamb_is_where_the_wall_was_seen_last() {
    // Four degrees of the wall beside the door are blank.
    let degrees = |p: &[f64; 3]| p[1].atan2(p[0]).to_degrees();
    let door = [Some([2.6, 3.5]), None, None, None];
    let hall = room([-6.0; 2], [6.0; 2], [None; 4]);
    let walls = Walls([room([-2.0; 2], [2.0; 2], door).0, hall.0].concat());
    let mut points = walls.seen_from([0.0; 2], 1440, 20.0);
    points.retain(|p| !(-53.3..-49.0).contains(&degrees(p)));
    let exit = &search(&points, [0.0; 2], &ExitConfig::default()).exits[0];
    assert!(
        (degrees(&exit.jambs[1]) + 49.0).abs() < 1.1,
        "{:?}",
        exit.jambs
    );
}

#[test]
fn half_an_opening_at_the_border_of_a_scan_is_not_judged() {
    let degrees = |p: &[f64; 3]| p[1].atan2(p[0]).to_degrees();
    let mut points = square_in_hall(1).seen_from([0.0; 2], 1440, 20.0);
    points.retain(|p| !(-68.0..-40.0).contains(&degrees(p)));
    let agent = [0.0, 0.0, 1.0];
    let plane = AffinePlane::from_up(UP, agent).unwrap();
    // Somebody looked from −40 degrees on to −68 all the way round, or all the way round.
    let exits = |width: f64| {
        let count = 12;
        let gaze = |k: usize| (-40.0 + width * (k as f64 + 0.5) / count as f64).to_radians();
        let gaze = |k: usize| Gaze {
            position: agent,
            forward: [gaze(k).cos(), gaze(k).sin(), 0.0],
            half_fov_rad: (0.5 * width / count as f64).to_radians(),
        };
        let gazes: Vec<Gaze> = (0..count).map(gaze).collect();
        let view = ExitView {
            gazes: &gazes,
            ..Default::default()
        };
        find_exits(&points, agent, &plane, &view, &ExitConfig::default()).unwrap()
    };
    let partial = exits(332.0);
    assert!(partial.exits.is_empty() && partial.unseen.len() == 1);
    let full = exits(361.0);
    let door = |exit: &exit_finder::Exit| exit.sector.contains(1.5 * std::f64::consts::PI);
    assert!(full.unseen.is_empty() && full.exits.iter().any(door));
}

#[test]
fn gazes_tell_unseen_from_empty() {
    let points = square(1).seen_from([0.0; 2], 1080, 20.0);
    let agent = [0.0, 0.0, 1.0];
    let plane = AffinePlane::from_up(UP, agent).unwrap();
    let gaze = |bearing: f64| Gaze {
        position: agent,
        forward: [bearing.cos(), bearing.sin(), 0.0],
        half_fov_rad: 0.6,
    };
    // The door is at −90 degrees. Somebody looked everywhere else.
    let elsewhere: Vec<Gaze> = (0..8).map(|i| gaze(-0.2 + 0.45 * f64::from(i))).collect();
    let view = ExitView {
        gazes: &elsewhere,
        ..Default::default()
    };
    let config = ExitConfig::default();
    let report = find_exits(&points, agent, &plane, &view, &config).unwrap();
    assert!(report.exits.is_empty());
    assert_eq!(report.unseen.len(), 1);
    let everywhere: Vec<Gaze> = (0..12).map(|i| gaze(0.55 * f64::from(i))).collect();
    let view = ExitView {
        gazes: &everywhere,
        ..Default::default()
    };
    let report = find_exits(&points, agent, &plane, &view, &config).unwrap();
    assert_eq!((report.exits.len(), report.unseen.len()), (1, 0));
}

#[test]
fn rays_tell_unseen_from_empty_where_there_are_no_gazes() {
    let points = square(1).seen_from([0.0; 2], 1080, 20.0);
    let agent = [0.0, 0.0, 1.0];
    let plane = AffinePlane::from_up(UP, agent).unwrap();
    // Twelve keyframes about the agent, each of which sees 70 degrees; the door is at −90 degrees.
    let keyframe = |k: usize| TAU * k as f64 / 12.0;
    let rays = |keyframes: &[usize]| -> Vec<Ray> {
        let sees = |k: usize, end: [f64; 3]| {
            let off = end[1].atan2(end[0]) - keyframe(k) + 0.5 * TAU;
            (off.rem_euclid(TAU) - 0.5 * TAU).abs() < 35f64.to_radians()
        };
        let of_point = |&end: &[f64; 3]| {
            let seeing = keyframes.iter().filter(move |&&k| sees(k, end));
            seeing.map(move |&k| Ray {
                origin: [0.01 * k as f64, 0.0, 1.0],
                end,
            })
        };
        points.iter().flat_map(of_point).collect()
    };
    let report = |rays: &[Ray]| {
        let view = ExitView {
            rays,
            ..Default::default()
        };
        find_exits(&points, agent, &plane, &view, &ExitConfig::default()).unwrap()
    };
    // The keyframe in the middle looked across the door, the others to its sides end within it.
    let all: Vec<usize> = (0..12).collect();
    let seen = report(&rays(&all));
    assert_eq!((seen.exits.len(), seen.unseen.len()), (1, 0));
    let away: Vec<usize> = (0..12).filter(|k| !(8..=10).contains(k)).collect();
    let unseen = report(&rays(&away));
    assert!(unseen.exits.is_empty() && unseen.unseen.len() == 1);
    assert!(unseen.unseen[0].contains(1.5 * std::f64::consts::PI));
}

#[test]
fn ties_go_to_the_smallest_turn() {
    let points = square_in_hall(4).seen_from([0.0; 2], 1440, 20.0);
    let agent = [0.0, 0.0, 1.0];
    let plane = AffinePlane::from_up(UP, agent).unwrap();
    for heading in [
        [1.0, 0.1, 0.0],
        [0.1, 1.0, 0.0],
        [-1.0, 0.1, 0.3],
        [0.0, -1.0, 0.0],
    ] {
        let view = ExitView {
            heading: Some(heading),
            ..Default::default()
        };
        let report = find_exits(&points, agent, &plane, &view, &ExitConfig::default()).unwrap();
        let best = report.best().unwrap();
        let along: f64 = (0..3).map(|i| best.direction[i] * heading[i]).sum();
        assert!(along > 0.9, "{heading:?} {:?}", best.direction);
    }
}

#[test]
fn a_coarse_profile_still_finds_a_wide_door() {
    let walls = room([-2.0; 2], [2.0; 2], [Some([1.0, 3.0]), None, None, None]);
    let points = walls.seen_from([0.0; 2], 1080, 20.0);
    for bins in [8, 12, 36, 90, 720, 1000] {
        let config = ExitConfig {
            bins,
            ..ExitConfig::paper_repaired()
        };
        let report = search(&points, [0.0; 2], &config);
        // A door of 53 degrees need not leave one of eight bins empty.
        assert_eq!(report.exits.len(), usize::from(bins > 16), "{bins} bins");
        let default = ExitConfig {
            bins,
            band: HeightBand::Off,
            ..Default::default()
        };
        let exits = search(&points, [0.0; 2], &default).exits;
        assert!(
            exits
                .iter()
                .all(|exit| (exit.bearing_rad - 1.5 * std::f64::consts::PI).abs() < 0.5)
        );
    }
}
