//! Body-frame geometry of a level drone: headings, turns and displacements about an up vector.

use nalgebra::{Isometry3, Point3, Vector3};

/// Where the drone is and which way it looks, in the map's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelPose {
    /// Position, map units.
    pub position: Point3<f64>,
    /// Unit vector of the camera's axis, made level.
    pub forward: Vector3<f64>,
    /// Unit up vector.
    pub up: Vector3<f64>,
}

impl LevelPose {
    /// Levels a camera pose about `up` (unit length). `None` where the camera looks straight up or down.
    #[must_use]
    pub fn from_camera(world_from_camera: &Isometry3<f64>, up: Vector3<f64>) -> Option<Self> {
        let axis = world_from_camera.rotation * Vector3::z();
        let forward = (axis - up * axis.dot(&up)).try_normalize(1e-6)?;
        Some(Self {
            position: Point3::from(world_from_camera.translation.vector),
            forward,
            up,
        })
    }

    /// Unit vector to the drone's left.
    #[must_use]
    pub fn left(&self) -> Vector3<f64> {
        self.up.cross(&self.forward)
    }

    /// The turn that faces `target`, radians in (−π, π], counterclockwise seen from above; 0 straight above or below.
    #[must_use]
    pub fn turn_to(&self, target: &Point3<f64>) -> f64 {
        self.turn_along(&(target - self.position))
    }

    /// The turn that faces along `direction`, as [`Self::turn_to`].
    #[must_use]
    pub fn turn_along(&self, direction: &Vector3<f64>) -> f64 {
        direction
            .dot(&self.left())
            .atan2(direction.dot(&self.forward))
    }

    /// Displacement to `target` as (forward, left, up), map units.
    #[must_use]
    pub fn body_displacement(&self, target: &Point3<f64>) -> Vector3<f64> {
        let delta = target - self.position;
        Vector3::new(
            delta.dot(&self.forward),
            delta.dot(&self.left()),
            delta.dot(&self.up),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first camera of a map: looks along z, y down.
    fn first_camera() -> LevelPose {
        LevelPose::from_camera(&Isometry3::identity(), Vector3::new(0.0, -1.0, 0.0)).unwrap()
    }

    #[test]
    fn left_of_the_first_camera_is_minus_x() {
        assert!((first_camera().left() - Vector3::new(-1.0, 0.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn a_target_on_the_left_needs_a_counterclockwise_turn() {
        let turn = first_camera().turn_to(&Point3::new(-2.0, 0.5, 0.0));
        assert!((turn - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn body_displacement_has_up_last() {
        let delta = first_camera().body_displacement(&Point3::new(1.0, -2.0, 3.0));
        assert!((delta - Vector3::new(3.0, -1.0, 2.0)).norm() < 1e-12);
    }

    #[test]
    fn a_camera_that_looks_up_has_no_heading() {
        let up = Vector3::new(0.0, 0.0, 1.0);
        assert!(LevelPose::from_camera(&Isometry3::identity(), up).is_none());
    }
}
