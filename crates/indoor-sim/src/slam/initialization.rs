//! Beginning a map: two pictures that share enough, taken from places far enough apart.

use core::time::Duration;

use nalgebra::{Isometry3, Vector3};
use slam_bridge::TrackingState;

use super::detection::Detection;
use super::drift::{Drift, Slide};
use super::mapping::{Frame, Mapping, Surroundings};
use super::triangulation::parallax;
use super::{LastFrame, Reference, SyntheticSlam};

/// A picture that a map may begin with is given up after this long.
const REFERENCE_AGE: Duration = Duration::from_secs(20);

impl Reference {
    /// As the keyframe of a map without drift.
    fn frame(&self) -> Frame {
        Frame::new(
            self.time.as_secs_f64(),
            self.pose,
            self.pose,
            Drift::identity(),
        )
    }
}

impl SyntheticSlam {
    /// Compares with the reference picture; begins a map when the camera was truly translated.
    pub(super) fn try_to_begin(
        &mut self,
        time: Duration,
        pose: &Isometry3<f64>,
        detections: Vec<Detection>,
    ) -> (Option<Isometry3<f64>>, usize) {
        let fresh = Reference {
            time,
            pose: *pose,
            detections,
        };
        let Some(reference) = self.reference.take() else {
            self.reference =
                Some(fresh).filter(|frame| frame.detections.len() >= self.config.least_common);
            return (None, 0);
        };
        let common = self.common_parallax(&reference, &fresh);
        if common.len() < self.config.least_common || time > reference.time + REFERENCE_AGE {
            self.reference =
                Some(fresh).filter(|frame| frame.detections.len() >= self.config.least_common);
            return (None, 0);
        }
        let baseline = (reference.pose.translation.vector - pose.translation.vector).norm();
        let median = common[common.len() / 2];
        if baseline < self.config.least_baseline || median < self.config.least_parallax {
            self.reference = Some(reference);
            return (None, 0);
        }
        self.begin_map(&reference, &fresh)
    }

    /// Parallax of the landmarks that both pictures show, ascending, rad.
    fn common_parallax(&self, a: &Reference, b: &Reference) -> Vec<f64> {
        let centers = [a.pose, b.pose].map(|pose| pose.translation.vector);
        let shared = |detection: &&Detection| {
            a.detections
                .binary_search_by_key(&detection.landmark, |other| other.landmark)
                .is_ok()
        };
        let mut angles: Vec<f64> = b
            .detections
            .iter()
            .filter(shared)
            .map(|detection| {
                let place = self.world.landmarks()[detection.landmark as usize].position;
                parallax(place.into(), centers[0], centers[1])
            })
            .collect();
        angles.sort_unstable_by(f64::total_cmp);
        angles
    }

    /// Makes a map of the two pictures; keeps waiting when too few points come of it.
    fn begin_map(
        &mut self,
        first: &Reference,
        second: &Reference,
    ) -> (Option<Isometry3<f64>>, usize) {
        let mut mapping = Mapping::new(self.world.landmarks().len());
        mapping.begin(
            (first.frame(), &first.detections),
            (second.frame(), &second.detections),
            &mut Surroundings {
                world: &self.world,
                config: &self.config,
                focal: self.camera.fx,
                rng: &mut self.rng,
            },
        );
        let points = mapping.points.len();
        if points < self.config.least_common / 2 {
            self.reference = Some(first.clone());
            return (None, 0);
        }
        self.mapping = mapping;
        self.state = TrackingState::Tracking;
        self.failing_since = None;
        self.last = Some(LastFrame {
            keyframe_time: second.time,
            keyframe_pose: second.pose,
            keyframe_tracked: 0,
            pose: second.pose,
            drift: Drift::identity(),
            slide: Slide::new(&mut self.rng),
            jitter: Vector3::zeros(),
        });
        (
            Some(self.in_map(&first.pose.inverse(), &second.pose)),
            points,
        )
    }
}
