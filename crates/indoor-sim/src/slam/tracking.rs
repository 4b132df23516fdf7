//! What happens with each picture: track the map, extend it, lose it, find back.

use core::time::Duration;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand::RngExt;
use slam_bridge::{SlamUpdate, TrackingState};

use super::SyntheticSlam;
use super::detection::{Detection, detect};
use super::drift::{Drift, mean_at};
use super::mapping::{Frame, Surroundings};
use crate::random::normal3;

/// Two keyframes are at least this far apart, seconds.
const KEYFRAME_PAUSE: Duration = Duration::from_millis(200);

/// A frame becomes a keyframe when it tracks less than this share of what the last keyframe tracked (ORB-SLAM: 0.9).
const KEYFRAME_SHARE: f64 = 0.9;

/// A frame becomes a keyframe when it is farther from the last one than this share of the median range. Real maps: half
/// of the keyframes are within 0.02 to 0.034 of their neighbours.
const KEYFRAME_BASELINE: f64 = 0.03;

/// Points born this many keyframes ago anchor the drift.
const OLD: usize = 20;

/// Fewer old points than this anchor nothing.
const FEW: f64 = 10.0;

/// Chance, relative to a right point, that a wrong point is matched again.
const WRONG_MATCH: f64 = 0.75;

/// Turning speed that blurs the picture until nothing is matched, rad/s.
const BLUR_RATE: f64 = 4.0;

impl SyntheticSlam {
    /// Takes a picture from the true pose of a camera that turns at `turn_rate` rad/s.
    pub(crate) fn observe(
        &mut self,
        time: Duration,
        world_from_camera: &Isometry3<f64>,
        turn_rate: f64,
    ) {
        let budget = self.config.feature_budget;
        let detections = detect(&self.world, &self.camera, world_from_camera, budget);
        let (pose, tracked) = match self.state {
            TrackingState::NotInitialized => self.try_to_begin(time, world_from_camera, detections),
            _ => self.track(time, world_from_camera, turn_rate, &detections),
        };
        let epoch = self.epoch;
        let tracked_points = tracked;
        let state = self.state;
        let world_from_camera = pose.filter(|_| state == TrackingState::Tracking);
        self.updates.push_back(SlamUpdate {
            time,
            state,
            world_from_camera,
            epoch,
            tracked_points,
        });
    }

    /// Tracks the map, or tries to recognise it when lost.
    fn track(
        &mut self,
        time: Duration,
        pose: &Isometry3<f64>,
        turn_rate: f64,
        detections: &[Detection],
    ) -> (Option<Isometry3<f64>>, usize) {
        let (right, wrong) = self.match_points(turn_rate, detections);
        let needed = match self.state {
            TrackingState::Lost => self.config.relocalization_points,
            _ => self.config.least_tracked,
        };
        if right.len() < needed {
            self.fail(time);
            if self.state != TrackingState::Tracking {
                return (None, 0);
            }
        } else {
            self.state = TrackingState::Tracking;
            self.failing_since = None;
        }
        let Some(estimate) = self.estimate_pose(pose, detections, &right) else {
            return (None, 0);
        };
        if right.len() >= needed && self.wants_keyframe(time, pose, detections, right.len()) {
            let mut matched = [right.as_slice(), &wrong].concat();
            self.add_keyframe(time, (pose, &estimate), detections, &mut matched);
        }
        let first = self
            .mapping
            .frames
            .first()
            .map(|frame| frame.estimate.inverse());
        (
            first.map(|map_from_space| self.in_map(&map_from_space, &estimate)),
            right.len(),
        )
    }

    /// Indices of the map points matched in the picture: those that agree with the pose, and wrong ones.
    fn match_points(&mut self, turn_rate: f64, detections: &[Detection]) -> (Vec<u32>, Vec<u32>) {
        let sharp = (1.0 - turn_rate.abs() / BLUR_RATE).clamp(0.0, 1.0);
        let chance = self.config.match_chance * sharp;
        let (mut right, mut wrong) = (Vec::new(), Vec::new());
        for detection in detections {
            let Some(index) = self.mapping.index_of(detection.landmark) else {
                continue;
            };
            let landmark = &self.world.landmarks()[detection.landmark as usize];
            let chance = (chance * (0.5 + 0.7 * landmark.strength)).min(1.0);
            let draw = self.rng.random::<f64>();
            if self.mapping.points[index as usize].outlier.is_none() {
                if draw < chance {
                    right.push(index);
                }
            } else if draw < chance * WRONG_MATCH {
                wrong.push(index);
            }
        }
        (right, wrong)
    }

    /// Too little to track: after a while the map is lost, and after a longer while forgotten if so configured.
    fn fail(&mut self, time: Duration) {
        let since = *self.failing_since.get_or_insert(time);
        if time >= since + self.config.patience {
            self.state = TrackingState::Lost;
        }
        if self
            .config
            .reset_after
            .is_some_and(|limit| time >= since + limit)
        {
            self.reset();
        }
    }

    /// The pose as measured against the matched points: drifted as they are, and noisy.
    fn estimate_pose(
        &mut self,
        pose: &Isometry3<f64>,
        detections: &[Detection],
        matched: &[u32],
    ) -> Option<Isometry3<f64>> {
        self.slide(pose, matched);
        let last = self.last.as_mut()?;
        let range = median_range(detections);
        let scarce = (100.0 / (matched.len() as f64 + 1.0))
            .sqrt()
            .clamp(0.5, 3.0);
        // The error changes slowly from frame to frame, as that of a filter does.
        let fresh = normal3(&mut self.rng) * (self.config.pose_noise * range * scarce);
        last.jitter = last.jitter * 0.7 + fresh * (1.0_f64 - 0.7 * 0.7).sqrt();
        let attitude = normal3(&mut self.rng) * (self.config.attitude_noise * scarce);
        let truth = last.drift * pose;
        let rotation = UnitQuaternion::from_scaled_axis(attitude) * truth.rotation;
        let place = Translation3::from(truth.translation.vector + last.jitter);
        Some(Isometry3::from_parts(place, rotation))
    }

    /// Lets the drift grow with the motion since the last frame, and pulls it back to that of old points in view.
    fn slide(&mut self, pose: &Isometry3<f64>, matched: &[u32]) {
        let center = pose.translation.vector;
        let (anchor, share) = self.anchor(center, matched);
        let Some(last) = self.last.as_mut() else {
            return;
        };
        let moved = (center - last.pose.translation.vector).norm();
        let turned = pose.rotation.angle_to(&last.pose.rotation);
        let config = &self.config;
        let amount = (
            config.drift_per_meter * moved,
            config.drift_per_radian * turned,
        );
        let open = last.slide.apply(&last.drift, center, amount);
        last.pose = *pose;
        let parts = [(anchor, share), (open, 1.0 - share)];
        last.drift = mean_at(center, parts.into_iter()).unwrap_or(open);
    }

    /// The mean drift of the old points in view, and their share of the matched ones; share 0 when they are few.
    fn anchor(&self, center: Vector3<f64>, matched: &[u32]) -> (Drift, f64) {
        let frames = &self.mapping.frames;
        let mut weights = vec![0.0; frames.len()];
        let mut old = 0.0;
        for &index in matched {
            let born = self.mapping.points[index as usize].born as usize;
            if born + OLD < frames.len() {
                weights[born] += 1.0;
                old += 1.0;
            }
        }
        let used = weights
            .iter()
            .zip(frames)
            .filter(|(weight, _)| **weight > 0.0);
        let anchor = mean_at(center, used.map(|(&weight, frame)| (frame.drift, weight)));
        match anchor {
            Some(anchor) if old >= FEW => (anchor, old / matched.len() as f64),
            _ => (Drift::identity(), 0.0),
        }
    }

    /// Whether the picture shows so much that the last keyframe did not that it should become one.
    fn wants_keyframe(
        &mut self,
        time: Duration,
        pose: &Isometry3<f64>,
        detections: &[Detection],
        tracked: usize,
    ) -> bool {
        let Some(last) = self.last.as_mut() else {
            return false;
        };
        let few = (tracked as f64) < KEYFRAME_SHARE * last.keyframe_tracked as f64;
        let moved = (pose.translation.vector - last.keyframe_pose.translation.vector).norm();
        let far = moved > KEYFRAME_BASELINE * median_range(detections);
        let wanted = (few || far) && time >= last.keyframe_time + KEYFRAME_PAUSE;
        last.keyframe_tracked = last.keyframe_tracked.max(tracked);
        wanted
    }

    /// Makes the picture a keyframe.
    fn add_keyframe(
        &mut self,
        time: Duration,
        (pose, estimate): (&Isometry3<f64>, &Isometry3<f64>),
        detections: &[Detection],
        matched: &mut [u32],
    ) {
        let Some(last) = self.last.as_mut() else {
            return;
        };
        last.slide.change(&mut self.rng);
        last.keyframe_time = time;
        last.keyframe_pose = *pose;
        // The next frames say what can be expected to be tracked.
        last.keyframe_tracked = 0;
        matched.sort_unstable();
        self.mapping.insert(
            Frame::new(time.as_secs_f64(), *pose, *estimate, last.drift),
            detections,
            matched,
            &mut Surroundings {
                world: &self.world,
                config: &self.config,
                focal: self.camera.fx,
                rng: &mut self.rng,
            },
        );
    }
}

/// Median distance to what the picture shows, metres; 3 when it shows nothing.
fn median_range(detections: &[Detection]) -> f64 {
    let mut ranges: Vec<f64> = detections.iter().map(|detection| detection.range).collect();
    if ranges.is_empty() {
        return 3.0;
    }
    let middle = ranges.len() / 2;
    *ranges.select_nth_unstable_by(middle, f64::total_cmp).1
}
