//! The ideal pinhole camera: projection, rays and Jacobians.

use nalgebra::{Matrix2x3, Matrix3, Point2, Point3, Vector3};

/// Why numbers cannot be a camera.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A focal length is not positive, or some parameter is not finite.
    #[error(
        "focal lengths {fx}, {fy} must be positive and the centre {cx}, {cy} finite, in pixels"
    )]
    Intrinsics {
        /// Horizontal focal length, pixels.
        fx: f64,
        /// Vertical focal length, pixels.
        fy: f64,
        /// Column of the optical axis, pixels.
        cx: f64,
        /// Row of the optical axis, pixels.
        cy: f64,
    },
}

/// Focal lengths and optical centre, pixels. Camera frame: x right, y down, z forward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinholeCamera {
    /// Horizontal focal length, pixels, positive.
    pub fx: f64,
    /// Vertical focal length, pixels, positive.
    pub fy: f64,
    /// Column of the optical axis, pixels.
    pub cx: f64,
    /// Row of the optical axis, pixels.
    pub cy: f64,
}

impl PinholeCamera {
    /// A camera from checked numbers.
    ///
    /// # Errors
    /// [`CameraError::Intrinsics`] for focal lengths that are not positive and numbers that are not finite.
    ///
    /// ```
    /// use edge_slam::camera::PinholeCamera;
    /// let camera = PinholeCamera::new(585.0, 585.0, 320.0, 240.0)?;
    /// let pixel = camera.project(&[0.1, 0.0, 2.0].into()).map(|p| [p.x, p.y]);
    /// assert_eq!(pixel, Some([349.25, 240.0]));
    /// # Ok::<(), edge_slam::camera::CameraError>(())
    /// ```
    pub fn new(fx: f64, fy: f64, cx: f64, cy: f64) -> Result<Self, CameraError> {
        let good = fx > 0.0 && fy > 0.0 && [fx, fy, cx, cy].iter().all(|v| v.is_finite());
        if good {
            Ok(Self { fx, fy, cx, cy })
        } else {
            Err(CameraError::Intrinsics { fx, fy, cx, cy })
        }
    }

    /// π(p): the pixel that shows a point of the camera frame; `None` at or behind the camera (z <= 0).
    #[must_use]
    pub fn project(&self, point: &Point3<f64>) -> Option<Point2<f64>> {
        if !(point.z > 0.0) {
            return None;
        }
        let x = self.fx * point.x / point.z + self.cx;
        let y = self.fy * point.y / point.z + self.cy;
        (x.is_finite() && y.is_finite()).then(|| Point2::new(x, y))
    }

    /// K⁻¹ (u, 1): the ray through a pixel, with z = 1.
    #[must_use]
    pub fn ray(&self, pixel: &Point2<f64>) -> Vector3<f64> {
        Vector3::new(
            (pixel.x - self.cx) / self.fx,
            (pixel.y - self.cy) / self.fy,
            1.0,
        )
    }

    /// ∂π/∂p, 2x3 pixels per unit. Holds for z > 0.
    #[must_use]
    pub fn jacobian(&self, point: &Point3<f64>) -> Matrix2x3<f64> {
        let inverse = 1.0 / point.z;
        let (a, b) = (self.fx * inverse, self.fy * inverse);
        Matrix2x3::new(
            a,
            0.0,
            -a * point.x * inverse,
            0.0,
            b,
            -b * point.y * inverse,
        )
    }

    /// K.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<f64> {
        Matrix3::new(self.fx, 0.0, self.cx, 0.0, self.fy, self.cy, 0.0, 0.0, 1.0)
    }

    /// Mean of the two focal lengths, pixels: turns pixels into radians near the axis.
    #[must_use]
    pub fn mean_focal(&self) -> f64 {
        0.5 * (self.fx + self.fy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn camera() -> PinholeCamera {
        PinholeCamera::new(517.0, 516.0, 318.0, 255.0).unwrap()
    }

    proptest! {
        #[test]
        fn rays_project_back(x in -50.0..700.0f64, y in -50.0..500.0f64, depth in 0.01..90.0f64) {
            let pixel = Point2::new(x, y);
            let point = Point3::from(camera().ray(&pixel) * depth);
            prop_assert!((camera().project(&point).unwrap() - pixel).norm() < 1e-9);
        }

        #[test]
        fn the_jacobian_is_the_derivative(
            x in -2.0..2.0f64, y in -2.0..2.0f64, z in 0.5..9.0f64,
        ) {
            let point = Point3::new(x, y, z);
            let jacobian = camera().jacobian(&point);
            for k in 0..3 {
                let mut step = Vector3::zeros();
                step[k] = 1e-6;
                let ahead = camera().project(&(point + step)).unwrap();
                let behind = camera().project(&(point - step)).unwrap();
                prop_assert!(((ahead - behind) / 2e-6 - jacobian.column(k)).norm() < 1e-5);
            }
        }
    }

    #[test]
    fn nothing_behind_the_camera_is_seen() {
        for z in [0.0, -1.0, f64::NAN] {
            assert_eq!(camera().project(&Point3::new(0.0, 0.0, z)), None);
        }
        assert!(PinholeCamera::new(0.0, 1.0, 0.0, 0.0).is_err());
        assert!(PinholeCamera::new(1.0, 1.0, f64::NAN, 0.0).is_err());
    }
}
