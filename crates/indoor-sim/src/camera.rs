//! A pinhole camera: what falls into its picture.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use slam_bridge::Frustum;

use crate::ConfigError;
use crate::config_error::within;

/// A pinhole camera without distortion, mounted on the drone's nose. Pixels, rad, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Focal length in x, pixels, 10..=10000.
    pub fx: f64,
    /// Focal length in y, pixels, 10..=10000.
    pub fy: f64,
    /// Width of the picture, pixels, 16..=10000.
    pub width: f64,
    /// Height of the picture, pixels, 16..=10000.
    pub height: f64,
    /// How far the optical axis points below the body's x axis, rad, -1.5..=1.5.
    pub tilt: f64,
    /// Pictures per second, 1..=60.
    pub rate: f64,
}

impl Default for Camera {
    /// The Tello's video as five published calibrations have it: 960 × 720, fx 920 to 936, that is 55.1 by 42.8 degrees.
    fn default() -> Self {
        Self {
            fx: 920.0,
            fy: 920.0,
            width: 960.0,
            height: 720.0,
            tilt: 0.0,
            rate: 10.0,
        }
    }
}

impl Camera {
    /// Checks every number.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] names the first number that is out of its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        within("camera.fx", self.fx, 10.0, 1e4)?;
        within("camera.fy", self.fy, 10.0, 1e4)?;
        within("camera.width", self.width, 16.0, 1e4)?;
        within("camera.height", self.height, 16.0, 1e4)?;
        within("camera.tilt", self.tilt, -1.5, 1.5)?;
        within("camera.rate", self.rate, 1.0, 60.0)
    }

    /// Half opening angles.
    ///
    /// ```
    /// let frustum = indoor_sim::Camera::default().frustum();
    /// assert!((2.0 * frustum.half_horizontal.to_degrees() - 55.1).abs() < 0.05);
    /// ```
    #[must_use]
    pub fn frustum(&self) -> Frustum {
        Frustum {
            half_horizontal: (0.5 * self.width / self.fx).atan(),
            half_vertical: (0.5 * self.height / self.fy).atan(),
        }
    }

    /// Camera coordinates (x right, y down, z forward) to the body's (x forward, y left, z up).
    #[must_use]
    pub fn body_from_camera(&self) -> Isometry3<f64> {
        let axes = Matrix3::from_columns(&[-Vector3::y(), -Vector3::z(), Vector3::x()]);
        let mount = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        let tilt = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), self.tilt);
        Isometry3::from_parts(Translation3::identity(), tilt * mount)
    }

    /// Whether a point in camera coordinates falls into the picture.
    pub(crate) fn contains(&self, point: Vector3<f64>) -> bool {
        let half_x = 0.5 * self.width / self.fx;
        let half_y = 0.5 * self.height / self.fy;
        point.z > 0.0 && point.x.abs() <= half_x * point.z && point.y.abs() <= half_y * point.z
    }

    /// Whether any point of a ball in camera coordinates may fall into the picture.
    pub(crate) fn may_show(&self, center: Vector3<f64>, radius: f64) -> bool {
        let half_x = 0.5 * self.width / self.fx;
        let half_y = 0.5 * self.height / self.fy;
        let inside = |half: f64, side: f64| {
            half * center.z - side.abs() > -radius * (1.0 + half * half).sqrt()
        };
        center.z > -radius && inside(half_x, center.x) && inside(half_y, center.y)
    }
}
