//! The flown path, which moves with its keyframes when the map is corrected.
//!
//! Free space is claimed where the drone has been, and the way home leads back along it: both must stay where the walls are after a loop
//! was closed. A pose hangs on the nearest keyframe of the same pass of a place.

use core::time::Duration;
use std::collections::HashMap;

use nalgebra::Isometry3;
use slam_bridge::{KeyFrame, Map};

/// Keyframes of this time around a pose are of the same pass of a place, seconds.
const SAME_PASS_S: f64 = 10.0;

/// One tracked frame of the flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrailPose {
    /// When, on the caller's clock.
    pub time: Duration,
    /// The map's epoch that the pose belongs to.
    pub epoch: u64,
    /// Camera-to-world, map units.
    pub world_from_camera: Isometry3<f64>,
}

/// The keyframe that a pose moves with.
#[derive(Debug, Clone, Copy)]
struct Anchor {
    keyframe: u64,
    keyframe_from_camera: Isometry3<f64>,
}

/// Every tracked frame, oldest first.
#[derive(Debug, Clone, Default)]
pub(super) struct Trail {
    poses: Vec<TrailPose>,
    /// One for each of the first poses; those since the last map have none yet.
    anchors: Vec<Option<Anchor>>,
}

impl Trail {
    pub(super) fn push(&mut self, pose: TrailPose) {
        self.poses.push(pose);
    }

    pub(super) fn poses(&self) -> &[TrailPose] {
        &self.poses
    }

    /// Moves the poses of the map's epoch with their keyframes, and hangs those since the last map on this one's. A pose whose keyframe
    /// was culled stays and hangs on another. Linear in poses, and in keyframes for each new one.
    pub(super) fn follow_map(&mut self, map: &Map) {
        let keyframes: HashMap<u64, &KeyFrame> = map
            .keyframes
            .iter()
            .map(|keyframe| (keyframe.id.0, keyframe))
            .collect();
        self.anchors.resize(self.poses.len(), None);
        let hung = self.poses.iter_mut().zip(&mut self.anchors);
        for (pose, anchor) in hung.filter(|(pose, _)| pose.epoch == map.epoch) {
            let found = anchor.and_then(|anchor| Some((anchor, keyframes.get(&anchor.keyframe)?)));
            match found {
                Some((anchor, keyframe)) => {
                    pose.world_from_camera =
                        keyframe.world_from_camera * anchor.keyframe_from_camera;
                }
                None => *anchor = nearest(pose, &map.keyframes),
            }
        }
    }
}

/// The keyframe nearest in place among those of about the same time, or of all, where none is: their clock may be another.
fn nearest(pose: &TrailPose, keyframes: &[KeyFrame]) -> Option<Anchor> {
    let time = pose.time.as_secs_f64();
    let is_of_this_pass = |keyframe: &&KeyFrame| {
        let gap = keyframe.time.map(|of| (of - time).abs());
        gap.is_some_and(|gap| gap < SAME_PASS_S)
    };
    let way = |keyframe: &KeyFrame| {
        let (to, from) = (&keyframe.world_from_camera, &pose.world_from_camera);
        (to.translation.vector - from.translation.vector).norm()
    };
    let nearer = |a: &&KeyFrame, b: &&KeyFrame| way(a).total_cmp(&way(b));
    let keyframe = keyframes
        .iter()
        .filter(is_of_this_pass)
        .min_by(nearer)
        .or_else(|| keyframes.iter().min_by(nearer))?;
    Some(Anchor {
        keyframe: keyframe.id.0,
        keyframe_from_camera: keyframe.world_from_camera.inv_mul(&pose.world_from_camera),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Translation3, UnitQuaternion, Vector3};
    use slam_bridge::KeyFrameId;

    fn at(x: f64) -> Isometry3<f64> {
        Isometry3::translation(x, 0.0, 0.0)
    }

    fn pose(seconds: u64, epoch: u64, x: f64) -> TrailPose {
        TrailPose {
            time: Duration::from_secs(seconds),
            epoch,
            world_from_camera: at(x),
        }
    }

    fn map(epoch: u64, keyframes: &[(u64, Option<f64>, Isometry3<f64>)]) -> Map {
        let keyframes = keyframes.iter().map(|&(id, seconds, pose)| KeyFrame {
            id: KeyFrameId(id),
            time: seconds,
            world_from_camera: pose,
        });
        Map {
            epoch,
            keyframes: keyframes.collect(),
            ..Map::default()
        }
    }

    fn trail(poses: &[TrailPose]) -> Trail {
        let mut trail = Trail::default();
        for &pose in poses {
            trail.push(pose);
        }
        trail
    }

    #[test]
    fn each_pass_of_a_place_moves_with_its_own_keyframe() {
        // Out and back to the same place; the correction moves only what was flown later.
        let mut trail = trail(&[pose(0, 1, 0.0), pose(15, 1, 3.0), pose(30, 1, 0.2)]);
        let bend = Isometry3::from_parts(
            Translation3::new(0.0, 0.0, 2.0),
            UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.5),
        );
        trail.follow_map(&map(
            1,
            &[(4, Some(0.0), at(0.0)), (7, Some(30.0), at(0.0))],
        ));
        trail.follow_map(&map(1, &[(4, Some(0.0), at(0.0)), (7, Some(30.0), bend)]));
        let [first, _, last] = [0, 1, 2].map(|i| trail.poses()[i].world_from_camera);
        assert_eq!(first, at(0.0));
        let error = last.to_homogeneous() - (bend * at(0.2)).to_homogeneous();
        assert!(error.norm() < 1e-12, "{error}");
    }

    #[test]
    fn without_times_of_this_clock_the_nearest_place_counts() {
        let mut trail = trail(&[pose(0, 0, 0.0), pose(1, 0, 3.0)]);
        let foreign = Some(1.3e9);
        trail.follow_map(&map(0, &[(1, None, at(0.5)), (2, foreign, at(2.5))]));
        trail.follow_map(&map(0, &[(1, None, at(0.5)), (2, foreign, at(3.5))]));
        let places = trail.poses().iter();
        let places: Vec<f64> = places
            .map(|pose| pose.world_from_camera.translation.x)
            .collect();
        assert!(
            (places[0]).abs() < 1e-12 && (places[1] - 4.0).abs() < 1e-12,
            "{places:?}"
        );
    }

    #[test]
    fn a_culled_keyframe_hands_its_poses_on() {
        let mut trail = trail(&[pose(0, 0, 1.0)]);
        trail.follow_map(&map(0, &[(1, Some(0.0), at(0.0))]));
        trail.follow_map(&map(0, &[(2, Some(3.0), at(5.0))]));
        assert_eq!(trail.poses()[0].world_from_camera, at(1.0));
        trail.follow_map(&map(0, &[(2, Some(3.0), at(6.0))]));
        assert!((trail.poses()[0].world_from_camera.translation.x - 2.0).abs() < 1e-12);
    }

    #[test]
    fn other_epochs_and_empty_maps_move_nothing() {
        let mut trail = trail(&[pose(0, 0, 1.0), pose(1, 1, 2.0)]);
        trail.follow_map(&map(1, &[(1, None, at(0.0))]));
        trail.follow_map(&map(1, &[]));
        trail.follow_map(&map(1, &[(1, None, at(4.0))]));
        assert_eq!(trail.poses()[0], pose(0, 0, 1.0));
        assert_eq!(
            trail.poses()[1],
            pose(1, 1, 2.0),
            "it hung on nothing when the keyframe came back"
        );
    }
}
