//! The evaluator against figures that evo 1.38.1 gives for published trajectories.

#![allow(clippy::unwrap_used, reason = "a test file")]

mod shared;

use edge_slam::evaluation::{
    Alignment, ApeConfig, RpeConfig, RpeInterval, TimedPose, absolute_pose_error,
    relative_pose_error,
};
use shared::shared;
use slam_bridge::read_tum;

fn load(name: &str) -> Option<Vec<TimedPose>> {
    let path = shared(&["data", "trajectories", name])?;
    let text = std::fs::read_to_string(path).unwrap();
    Some(read_tum(text.as_bytes()).unwrap())
}

struct Expected {
    estimate: &'static str,
    alignment: Alignment,
    pairs: usize,
    scale: f64,
    rmse_mean_std_max: [f64; 4],
    frobenius_rmse: f64,
    rpe_rmse: f64,
}

/// What evo 1.38.1 says of published trajectories.
const FIGURES: [Expected; 3] = [
    Expected {
        estimate: "freiburg1_xyz-rgbdslam.txt",
        alignment: Alignment::Se3,
        pairs: 785,
        scale: 1.0,
        rmse_mean_std_max: [0.013470, 0.012024, 0.006071, 0.034760],
        frobenius_rmse: 0.052542,
        rpe_rmse: 0.005764,
    },
    Expected {
        estimate: "freiburg1_xyz-rgbdslam_drift.txt",
        alignment: Alignment::Se3,
        pairs: 785,
        scale: 1.0,
        rmse_mean_std_max: [0.013470, 0.012025, 0.006071, 0.034760],
        frobenius_rmse: 0.052543,
        rpe_rmse: 0.005764,
    },
    Expected {
        estimate: "freiburg1_xyz-ORB_kf_mono.txt",
        alignment: Alignment::Sim3,
        pairs: 32,
        scale: 1.105622,
        rmse_mean_std_max: [0.009755, 0.008219, 0.005254, 0.027924],
        frobenius_rmse: 0.059346,
        rpe_rmse: 0.025266,
    },
];

#[test]
fn absolute_errors_equal_evo() {
    let Some(truth) = load("freiburg1_xyz-groundtruth.txt") else {
        return;
    };
    for row in FIGURES {
        let Some(estimate) = load(row.estimate) else {
            return;
        };
        let config = ApeConfig {
            alignment: row.alignment,
            ..Default::default()
        };
        let ape = absolute_pose_error(&estimate, &truth, &config).unwrap();
        assert_eq!(ape.pairs.len(), row.pairs, "{}", row.estimate);
        assert!(
            (ape.alignment.scale - row.scale).abs() < 1e-6,
            "{}",
            ape.alignment.scale
        );
        let found = &ape.translation;
        for (value, expected) in [found.rmse, found.mean, found.std, found.max]
            .iter()
            .zip(row.rmse_mean_std_max)
        {
            assert!(
                (value - expected).abs() < 1e-6,
                "{}: {value} {expected}",
                row.estimate
            );
        }
        let rpe = relative_pose_error(&estimate, &truth, &RpeConfig::default()).unwrap();
        assert!(
            (ape.frobenius.rmse - row.frobenius_rmse).abs() < 1e-6,
            "{:?}",
            ape.frobenius
        );
        assert!(
            (rpe.translation.rmse - row.rpe_rmse).abs() < 1e-6,
            "{rpe:?}"
        );
    }
}

#[test]
fn rotation_drift_over_thirty_frames_equals_evo() {
    let Some(truth) = load("freiburg1_xyz-groundtruth.txt") else {
        return;
    };
    let Some(estimate) = load("freiburg1_xyz-rgbdslam.txt") else {
        return;
    };
    let config = RpeConfig {
        interval: RpeInterval::Frames(30),
        ..Default::default()
    };
    let rpe = relative_pose_error(&estimate, &truth, &config).unwrap();
    assert!((rpe.rotation.rmse.to_degrees() - 0.887315).abs() < 1e-6);
}
