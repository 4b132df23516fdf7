//! Real recorded sequences through the whole chain; skipped where the recordings are not there.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test file")]
#![cfg(feature = "image-files")]

mod shared;

use std::path::PathBuf;

use edge_slam::camera::Camera;
use edge_slam::edge::{CannyConfig, JunctionConfig, canny, find_junctions, trace_chains};
use edge_slam::evaluation::{Alignment, ApeConfig, TimedPose, absolute_pose_error};
use edge_slam::odometry::{Odometry, OdometryConfig};
use edge_slam::sequence::ImageSequence;
use rand::SeedableRng;
use shared::shared;
use slam_bridge::read_tum;

fn folder(name: &str) -> Option<PathBuf> {
    shared(&["data", name])
}

fn run(sequence: &ImageSequence, camera: Camera, frames: usize, use_depth: bool) -> Vec<TimedPose> {
    let mut odometry = Odometry::new(camera, OdometryConfig::default()).unwrap();
    let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
    let mut trajectory = Vec::new();
    for index in 0..frames.min(sequence.len()) {
        let loaded = sequence.load(index).unwrap().unwrap();
        let depth = loaded.depth.as_ref().filter(|_| use_depth);
        if let Some(pose) = odometry
            .track(&loaded.frame(), depth, rng)
            .world_from_camera
        {
            trajectory.push(TimedPose {
                time: loaded.time,
                pose,
            });
        }
    }
    trajectory
}

#[test]
fn a_kitchen_is_tracked_with_depth() {
    let Some(folder) = folder("seven_scenes_redkitchen_part1") else {
        return;
    };
    let sequence = ImageSequence::open(&folder).unwrap();
    let camera = sequence.camera.unwrap();
    let trajectory = run(&sequence, camera, 30, true);
    assert!(trajectory.len() >= 29, "{}", trajectory.len());
    let truth = std::fs::read(folder.join("groundtruth_tum.txt")).unwrap();
    let truth = read_tum(&truth[..]).unwrap();
    let config = ApeConfig {
        alignment: Alignment::Se3,
        ..Default::default()
    };
    let ape = absolute_pose_error(&trajectory, &truth, &config).unwrap();
    assert!(ape.translation.rmse < 0.06, "{}", ape.translation.rmse);
}

#[test]
fn a_turning_camera_is_tracked_with_depth() {
    let Some(folder) = folder("tum_fr1_rpy_part1") else {
        return;
    };
    let sequence = ImageSequence::open(&folder).unwrap();
    let trajectory = run(&sequence, sequence.camera.unwrap(), 60, true);
    assert!(trajectory.len() >= 27, "{}", trajectory.len());
    let truth = std::fs::read(folder.join("groundtruth.txt")).unwrap();
    let truth = read_tum(&truth[..]).unwrap();
    let config = ApeConfig {
        alignment: Alignment::Se3,
        max_difference: 0.02,
        ..Default::default()
    };
    let ape = absolute_pose_error(&trajectory, &truth, &config).unwrap();
    assert!(ape.translation.rmse < 0.06, "{}", ape.translation.rmse);
}

#[test]
fn a_kitchen_has_edges_and_corners() {
    let Some(folder) = folder("seven_scenes_redkitchen_part1") else {
        return;
    };
    let loaded = ImageSequence::open(&folder)
        .unwrap()
        .load(0)
        .unwrap()
        .unwrap();
    let edges = canny(&loaded.image.view(), &CannyConfig::default()).unwrap();
    let chains = trace_chains(&edges, 20);
    let config = JunctionConfig::default();
    let all = find_junctions(&edges, &chains, None, &config);
    let solid = find_junctions(&edges, &chains, loaded.depth.as_ref(), &config);
    assert!(chains.len() > 50 && all.len() > 3);
    assert!(solid.len() <= all.len());
    println!(
        "{} chains, {} junctions, {} not at depth jumps",
        chains.len(),
        all.len(),
        solid.len()
    );
}
