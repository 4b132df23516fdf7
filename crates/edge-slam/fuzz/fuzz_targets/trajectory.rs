//! Any bytes as two trajectories, of text or of numbers, read, associated, aligned in every way and compared: figures or an error, no panic.

#![no_main]

use edge_slam::evaluation::{
    AlignBy, Alignment, ApeConfig, RpeConfig, RpeInterval, absolute_pose_error, relative_pose_error,
};
use libfuzzer_sys::fuzz_target;
use slam_bridge::nalgebra::{Isometry3, Vector3};
use slam_bridge::{TimedPose, read_tum};

/// The text's poses; where it is no trajectory, seven bytes are a time, a place and a turn.
fn trajectory(bytes: &[u8]) -> Vec<TimedPose> {
    read_tum(bytes).unwrap_or_else(|_| {
        let number = |byte: u8| f64::from(byte as i8) / 8.0;
        let pose = |bytes: &[u8]| {
            let vector = |k: usize| Vector3::new(number(bytes[k]), number(bytes[k + 1]), number(bytes[k + 2]));
            TimedPose { time: f64::from(bytes[0]), pose: Isometry3::new(vector(1), vector(4)) }
        };
        bytes.chunks_exact(7).map(pose).collect()
    })
}

fuzz_target!(|data: &[u8]| {
    let mut parts = data.splitn(2, |byte| *byte == 0xFF).map(trajectory);
    let (Some(estimate), Some(reference)) = (parts.next(), parts.next()) else {
        return;
    };
    for alignment in [Alignment::None, Alignment::Se3, Alignment::Sim3] {
        for align_by in [AlignBy::Positions, AlignBy::Poses] {
            let config = ApeConfig { alignment, align_by, max_difference: 0.5 };
            if let Ok(error) = absolute_pose_error(&estimate, &reference, &config) {
                assert!(error.alignment.scale > 0.0);
            }
        }
    }
    for interval in [RpeInterval::Frames(1), RpeInterval::Seconds(1.0)] {
        let config = RpeConfig { interval, max_difference: 0.5, ..RpeConfig::default() };
        let _ = relative_pose_error(&estimate, &reference, &config);
    }
});
