//! One sample of a trajectory: a time stamp and a pose.

use nalgebra::Isometry3;

use super::EvaluationError;

/// A pose at a time. A trajectory is a slice of these, in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StampedPose {
    /// Seconds on any clock that the two compared trajectories share.
    pub time: f64,
    /// Camera-to-world (or body-to-world), metres or map units.
    pub world_from_camera: Isometry3<f64>,
}

impl StampedPose {
    /// A sample from its parts.
    #[must_use]
    pub fn new(time: f64, world_from_camera: Isometry3<f64>) -> Self {
        Self {
            time,
            world_from_camera,
        }
    }

    /// The camera's position.
    #[must_use]
    pub fn position(&self) -> [f64; 3] {
        self.world_from_camera.translation.vector.into()
    }

    fn is_finite(&self) -> bool {
        let pose = &self.world_from_camera;
        self.time.is_finite()
            && pose
                .translation
                .vector
                .iter()
                .all(|value| value.abs() < LARGEST)
            && pose.rotation.coords.iter().all(|value| value.is_finite())
    }
}

/// Coordinates beyond this would overflow when squared and summed.
const LARGEST: f64 = 1e100;

/// Errs at the first sample that holds NaN or infinity.
pub(super) fn check_finite(trajectory: &[StampedPose]) -> Result<(), EvaluationError> {
    match trajectory.iter().position(|sample| !sample.is_finite()) {
        Some(index) => Err(EvaluationError::NonFinite { index }),
        None => Ok(()),
    }
}
