//! Radial-tangential lens distortion (Brown 1966, Conrady 1919) and its inverse.
//!
//! ```text
//! r² = x² + y²     x, y on the plane z = 1
//! x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²)
//! y' = y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y
//! ```

use nalgebra::{Matrix2, Vector2};

/// Distortion coefficients in the order that calibration tools print them: k1 k2 p1 p2 k3.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RadialTangential {
    /// Radial, r².
    pub k1: f64,
    /// Radial, r⁴.
    pub k2: f64,
    /// Tangential.
    pub p1: f64,
    /// Tangential.
    pub p2: f64,
    /// Radial, r⁶.
    pub k3: f64,
}

impl RadialTangential {
    /// Where the lens puts an ideal point of the plane z = 1.
    #[must_use]
    pub fn distort(&self, ideal: &Vector2<f64>) -> Vector2<f64> {
        let (x, y) = (ideal.x, ideal.y);
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3));
        Vector2::new(
            x * radial + 2.0 * self.p1 * x * y + self.p2 * (r2 + 2.0 * x * x),
            y * radial + self.p1 * (r2 + 2.0 * y * y) + 2.0 * self.p2 * x * y,
        )
    }

    /// ∂distort/∂ideal.
    #[must_use]
    pub fn jacobian(&self, ideal: &Vector2<f64>) -> Matrix2<f64> {
        let (x, y) = (ideal.x, ideal.y);
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3));
        let slope = 2.0 * (self.k1 + r2 * (2.0 * self.k2 + 3.0 * r2 * self.k3));
        let cross = x * y * slope + 2.0 * self.p1 * x + 2.0 * self.p2 * y;
        Matrix2::new(
            radial + x * x * slope + 2.0 * self.p1 * y + 6.0 * self.p2 * x,
            cross,
            cross,
            radial + y * y * slope + 6.0 * self.p1 * y + 2.0 * self.p2 * x,
        )
    }

    /// The ideal point that the lens puts at `distorted`: Newton's method from there.
    ///
    /// `None` when it does not converge within 20 steps to 1e-10, or ends where the model folds over (a
    /// polynomial is only calibrated inside the image).
    #[must_use]
    pub fn undistort(&self, distorted: &Vector2<f64>) -> Option<Vector2<f64>> {
        let mut ideal = *distorted;
        for _ in 0..20 {
            let jacobian = self.jacobian(&ideal);
            if !(jacobian.determinant() > 1e-6) {
                return None;
            }
            let error = self.distort(&ideal) - distorted;
            if error.norm() < 1e-10 {
                return Some(ideal);
            }
            ideal -= jacobian.try_inverse()? * error;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The calibration of a widely used hand-held Kinect.
    fn lens() -> RadialTangential {
        RadialTangential {
            k1: 0.262383,
            k2: -0.953104,
            p1: -0.005358,
            p2: 0.002628,
            k3: 1.163314,
        }
    }

    proptest! {
        #[test]
        fn undistort_inverts_distort(x in -0.62..0.62f64, y in -0.5..0.5f64) {
            let ideal = Vector2::new(x, y);
            let back = lens().undistort(&lens().distort(&ideal)).unwrap();
            prop_assert!((back - ideal).norm() < 1e-9);
        }

        #[test]
        fn the_jacobian_is_the_derivative(x in -0.7..0.7f64, y in -0.7..0.7f64) {
            let ideal = Vector2::new(x, y);
            let jacobian = lens().jacobian(&ideal);
            for k in 0..2 {
                let mut step = Vector2::zeros();
                step[k] = 1e-6;
                let slope = (lens().distort(&(ideal + step)) - lens().distort(&(ideal - step))) / 2e-6;
                prop_assert!((slope - jacobian.column(k)).norm() < 1e-8);
            }
        }
    }

    #[test]
    fn a_fold_has_no_inverse() {
        let fold = RadialTangential {
            k1: -1.0,
            ..Default::default()
        };
        assert_eq!(fold.undistort(&Vector2::new(2.0, 0.0)), None);
        assert_eq!(fold.undistort(&Vector2::new(f64::NAN, 0.0)), None);
    }
}
