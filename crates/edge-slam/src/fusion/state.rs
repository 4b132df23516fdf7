//! What the filter estimates: position, Euler angles and the logarithm of the visual scale.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Vector3};

/// Covariance of position (m²), roll, pitch, yaw (rad²) and log scale, in this order.
pub type StateCovariance = SMatrix<f64, 7, 7>;

pub(super) type StateVector = SVector<f64, 7>;

/// Position, attitude and scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NavigationState {
    /// World frame, metres.
    pub position: Vector3<f64>,
    /// Roll φ, pitch θ, yaw ψ, radians, world from body = Rz(ψ) Ry(θ) Rx(φ); roll and yaw in −π..=π.
    pub attitude: Vector3<f64>,
    /// log(metres per unit of the visual odometry).
    pub log_scale: f64,
}

impl NavigationState {
    /// World from body.
    #[must_use]
    pub fn rotation(&self) -> Rotation3<f64> {
        Rotation3::from_matrix_unchecked(rotation(&self.attitude))
    }

    /// Metres per unit of the visual odometry.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.log_scale.exp()
    }

    pub(super) fn moved(&self, step: &StateVector) -> Self {
        let mut next = *self;
        next.position += step.fixed_rows::<3>(0);
        next.attitude += step.fixed_rows::<3>(3);
        next.log_scale += step[6];
        next.attitude.x = wrap(next.attitude.x);
        next.attitude.z = wrap(next.attitude.z);
        next
    }

    pub(super) fn is_finite(&self) -> bool {
        self.position
            .iter()
            .chain(self.attitude.iter())
            .all(|v| v.is_finite())
            && self.log_scale.is_finite()
    }
}

/// The same angle in −π..=π.
pub(super) fn wrap(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

/// Rz(ψ) Ry(θ) Rx(φ).
pub(super) fn rotation(attitude: &Vector3<f64>) -> Matrix3<f64> {
    let (x, y, z) = axes(attitude);
    z * y * x
}

/// Derivatives of [`rotation`] by φ, θ and ψ: R ê_x, Rz Ry ê_y Rx, ê_z R.
pub(super) fn rotation_slopes(attitude: &Vector3<f64>) -> [Matrix3<f64>; 3] {
    let (x, y, z) = axes(attitude);
    let hat = |axis: Vector3<f64>| axis.cross_matrix();
    [
        z * y * x * hat(Vector3::x()),
        z * y * hat(Vector3::y()) * x,
        hat(Vector3::z()) * z * y * x,
    ]
}

fn axes(attitude: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>, Matrix3<f64>) {
    let ((sx, cx), (sy, cy), (sz, cz)) = (
        attitude.x.sin_cos(),
        attitude.y.sin_cos(),
        attitude.z.sin_cos(),
    );
    (
        Matrix3::new(1.0, 0.0, 0.0, 0.0, cx, -sx, 0.0, sx, cx),
        Matrix3::new(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy),
        Matrix3::new(cz, -sz, 0.0, sz, cz, 0.0, 0.0, 0.0, 1.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn slopes_are_the_derivatives(angles in prop::array::uniform3(-3.0..3.0f64)) {
            let attitude = Vector3::from(angles);
            for (k, slope) in rotation_slopes(&attitude).iter().enumerate() {
                let mut step = Vector3::zeros();
                step[k] = 1e-6;
                let numeric = (rotation(&(attitude + step)) - rotation(&(attitude - step))) / 2e-6;
                prop_assert!((numeric - slope).norm() < 1e-8);
            }
        }

        #[test]
        fn wrapping_keeps_the_direction(angle in -50.0..50.0f64) {
            let wrapped = wrap(angle);
            prop_assert!(wrapped.abs() <= core::f64::consts::PI + 1e-12);
            prop_assert!((wrapped.sin() - angle.sin()).abs() < 1e-9);
        }
    }
}
