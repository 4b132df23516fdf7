//! The SLAM stand-in initialises, errs, loses and finds back as a monocular system does.

#![allow(
    clippy::unwrap_used,
    reason = "a broken expectation must fail the test"
)]

use core::time::Duration;

use indoor_sim::slam_bridge::{SlamSource, SlamUpdate, TrackingState};
use indoor_sim::{DroneConfig, SimConfig, Simulator, SlamConfig, World};
use tello_sdk::{Command, Distance, Turn};

fn simulator(name: &str, slam: SlamConfig, seed: u64) -> Simulator {
    let config = SimConfig {
        slam,
        ..SimConfig::default()
    };
    Simulator::new(World::named(name, seed).unwrap(), config, seed).unwrap()
}

/// Sends commands one after the other and collects the updates.
fn fly(sim: &mut Simulator, commands: &[Command]) -> Vec<SlamUpdate> {
    let mut updates = Vec::new();
    for command in commands {
        sim.send(command).unwrap();
        while sim.poll_reply().is_none() {
            sim.advance(Duration::from_millis(100));
        }
        updates.extend(core::iter::from_fn(|| sim.slam().poll()));
    }
    updates
}

fn turn(degrees: i64) -> Command {
    let turn = Turn::from_degrees(degrees.abs()).unwrap();
    if degrees > 0 {
        Command::Clockwise(turn)
    } else {
        Command::CounterClockwise(turn)
    }
}

/// A full turn in 18 steps, each with 40 cm up or down.
fn scan() -> Vec<Command> {
    let level = Distance::from_cm(40).unwrap();
    let step = |index| {
        if index % 2 == 0 {
            Command::Up(level)
        } else {
            Command::Down(level)
        }
    };
    (0..18).flat_map(|index| [step(index), turn(20)]).collect()
}

#[test]
fn neither_standing_nor_hovering_nor_turning_begins_a_map() {
    for seed in 0..2 {
        let mut sim = simulator("two-rooms", SlamConfig::default(), seed);
        sim.advance(Duration::from_secs(5));
        fly(&mut sim, &[Command::TakeOff]);
        sim.slam().reset();
        while sim.slam().poll().is_some() {}
        let mut updates = fly(&mut sim, &vec![turn(45); 16]);
        sim.advance(Duration::from_secs(10));
        updates.extend(core::iter::from_fn(|| sim.slam().poll()));
        assert!(updates.len() > 250);
        for update in &updates {
            assert_eq!(update.state, TrackingState::NotInitialized);
            assert!(update.world_from_camera.is_none());
        }
        assert!(sim.slam_ref().map().points.is_empty() && sim.world_from_map().is_none());
        let distance = Distance::from_cm(50).unwrap();
        fly(
            &mut sim,
            &[Command::Left(distance), Command::Right(distance)],
        );
        assert_eq!(sim.slam_ref().state(), TrackingState::Tracking);
        assert_eq!(sim.slam_ref().map().epoch, 1);
    }
}

#[test]
fn without_noise_map_and_poses_are_exact() {
    let config = SimConfig {
        drone: DroneConfig::default(),
        ..SimConfig::exact()
    };
    let mut sim = Simulator::new(World::named("two-rooms", 2).unwrap(), config, 2).unwrap();
    fly(&mut sim, &[Command::TakeOff]);
    fly(&mut sim, &scan()[..16]);
    let world_from_map = sim.world_from_map().unwrap();
    let map = sim.slam_ref().map();
    assert!(map.points.len() > 2000 && (world_from_map.scaling() - 1.0).abs() < 1e-12);
    for point in &map.points {
        let truth = sim.slam_ref().point_truth(point.id).unwrap();
        assert!(truth.outlier.is_none());
        let place = world_from_map * point.position;
        let error = (place.coords - nalgebra::Vector3::from(truth.position)).norm();
        assert!(error < 1e-4, "{error}");
    }
    for keyframe in &map.keyframes {
        let center = world_from_map * keyframe.center();
        assert!(sim.world().clearance(center.into()) > 0.05);
    }
}

#[test]
fn maps_are_well_formed() {
    let mut sim = simulator("apartment", SlamConfig::default(), 3);
    let mut updates = fly(&mut sim, &[Command::TakeOff]);
    updates.extend(fly(&mut sim, &scan()));
    for pair in updates.windows(2) {
        assert!(pair[0].time < pair[1].time);
        let tracking = pair[1].state == TrackingState::Tracking;
        assert_eq!(tracking, pair[1].world_from_camera.is_some());
    }
    let map = sim.slam_ref().map();
    assert!(map.has_observations() && map.frustum.is_some());
    assert!(map.points.windows(2).all(|pair| pair[0].id < pair[1].id));
    assert!(map.keyframes.windows(2).all(|pair| pair[0].id < pair[1].id));
    for point in &map.points {
        assert!(point.observers.len() >= 2);
        assert!(point.observers.windows(2).all(|pair| pair[0] < pair[1]));
        assert!(point.observers.iter().all(|&id| map.keyframe(id).is_some()));
        assert!(point.position.coords.iter().all(|value| value.is_finite()));
    }
    let first = map.keyframes[0].world_from_camera;
    assert!(first.translation.vector.norm() < 1e-9 && first.rotation.angle() < 1e-6);
}

#[test]
fn poses_follow_the_truth_within_centimetres() {
    let mut sim = simulator("apartment", SlamConfig::default(), 4);
    fly(&mut sim, &[Command::TakeOff]);
    let mut errors = Vec::new();
    for command in scan() {
        fly(&mut sim, &[command]);
        sim.advance(Duration::from_millis(200));
        let truth = sim.camera_pose().translation.vector;
        let Some(update) = core::iter::from_fn(|| sim.slam().poll()).last() else {
            continue;
        };
        let Some(pose) = update.world_from_camera else {
            continue;
        };
        let place = sim.world_from_map().unwrap() * nalgebra::Point3::from(pose.translation.vector);
        errors.push((place.coords - truth).norm());
    }
    errors.sort_by(f64::total_cmp);
    let median = errors[errors.len() / 2];
    assert!(
        errors.len() > 30 && (0.003..0.06).contains(&median),
        "{median}"
    );
}

#[test]
fn turning_away_loses_the_map_and_turning_back_finds_it() {
    let mut sim = simulator("two-rooms", SlamConfig::default(), 6);
    fly(&mut sim, &[Command::TakeOff]);
    assert_eq!(sim.slam_ref().state(), TrackingState::Tracking);
    fly(&mut sim, &[turn(180)]);
    sim.advance(Duration::from_secs(1));
    assert_eq!(sim.slam_ref().state(), TrackingState::Lost);
    fly(&mut sim, &[turn(-180)]);
    sim.advance(Duration::from_secs(1));
    assert_eq!(sim.slam_ref().state(), TrackingState::Tracking);
    assert_eq!(sim.slam_ref().map().epoch, 0);
}

#[test]
fn a_loss_may_begin_a_new_epoch_with_another_scale() {
    let slam = SlamConfig {
        reset_after: Some(Duration::from_secs(3)),
        ..SlamConfig::default()
    };
    let mut sim = simulator("two-rooms", slam, 6);
    fly(&mut sim, &[Command::TakeOff]);
    let before = sim.world_from_map().unwrap().scaling();
    fly(&mut sim, &[turn(180)]);
    sim.advance(Duration::from_secs(5));
    let up = Distance::from_cm(60).unwrap();
    fly(&mut sim, &[Command::Up(up), Command::Down(up)]);
    assert_eq!(sim.slam_ref().map().epoch, 1);
    assert_eq!(sim.slam_ref().state(), TrackingState::Tracking);
    assert!((sim.world_from_map().unwrap().scaling() / before - 1.0).abs() > 1e-3);
}

#[test]
fn drift_grows_into_the_unknown_and_shrinks_where_the_map_is_known() {
    let slam = SlamConfig {
        drift_per_radian: 0.05,
        pose_noise: 0.0,
        attitude_noise: 0.0,
        ..SlamConfig::default()
    };
    let heading_error = |sim: &mut Simulator| {
        sim.advance(Duration::from_millis(300));
        let update = core::iter::from_fn(|| sim.slam().poll()).last().unwrap();
        let estimate = update.world_from_camera.unwrap().rotation;
        let world_from_map = sim.world_from_map().unwrap().isometry.rotation;
        (world_from_map * estimate).angle_to(&sim.camera_pose().rotation)
    };
    let (mut away, mut home) = (0.0, 0.0);
    for seed in 0..4 {
        let mut sim = simulator("apartment", slam.clone(), seed);
        fly(&mut sim, &[Command::TakeOff]);
        fly(&mut sim, &scan()[..18]);
        if sim.slam_ref().state() != TrackingState::Tracking {
            continue;
        }
        away += heading_error(&mut sim);
        fly(&mut sim, &vec![turn(-20); 9]);
        home += heading_error(&mut sim);
    }
    assert!(away > 0.03 && home < 0.4 * away, "{away} {home}");
}

#[test]
fn numbers_out_of_range_are_refused() {
    let world = World::named("closed-room", 1).unwrap();
    for bad in [f64::NAN, -0.1, 0.95, f64::INFINITY] {
        let slam = SlamConfig {
            outlier_rate: bad,
            ..SlamConfig::default()
        };
        let config = SimConfig {
            slam,
            ..SimConfig::default()
        };
        let error = Simulator::new(world.clone(), config, 1).unwrap_err();
        assert!(error.to_string().contains("slam.outlier_rate"), "{error}");
    }
}
