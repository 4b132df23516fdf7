//! What each measurement says of the state: telemetry's attitude, a visual pose, a displacement of unknown scale.
//!
//! Innovations of angles are wrapped. A displacement of unknown scale is not linearised (see [`Ekf::update_odometry`]).

use nalgebra::{SMatrix, SVector, Vector3};

use super::displacement::predict_displacement;
use super::ekf::inverse_of;
use super::measurement::{AnchoredOdometry, AttitudeSample, VisualPose};
use super::state::wrap;
use super::{Ekf, FusionError, Outcome};

impl Ekf {
    /// Corrects the attitude with the telemetry's.
    ///
    /// # Errors
    /// [`FusionError`] for angles that are not finite or too steep.
    pub fn update_attitude(&mut self, sample: &AttitudeSample) -> Result<Outcome, FusionError> {
        if !sample.angles.iter().all(|v| v.is_finite()) {
            return Err(FusionError::NonFinite {
                name: "the attitude sample",
            });
        }
        self.check_pitch(sample.angles.y)?;
        let innovation = (sample.angles - self.state.attitude).map(wrap);
        let mut matrix = SMatrix::<f64, 3, 7>::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
        let noise = SMatrix::from_diagonal(&self.config.attitude_sigma.map(|s| s * s));
        self.correct(&innovation, &matrix, &noise, self.config.attitude_gate)
    }

    /// Corrects position and attitude with a visual pose of known scale.
    ///
    /// # Errors
    /// [`FusionError`] for numbers that are not finite or a pitch that is too steep.
    pub fn update_visual(&mut self, pose: &VisualPose) -> Result<Outcome, FusionError> {
        let numbers = pose.position.iter().chain(pose.attitude.iter());
        if !(numbers.copied().all(f64::is_finite) && pose.distance.is_finite()) {
            return Err(FusionError::NonFinite {
                name: "the visual pose",
            });
        }
        self.check_pitch(pose.attitude.y)?;
        let position = pose.position - self.state.position;
        let mut matrix = SMatrix::<f64, 6, 7>::zeros();
        matrix.fixed_view_mut::<6, 6>(0, 0).fill_with_identity();
        self.fix(position, pose.attitude, matrix, pose.distance, pose.inliers)
    }

    /// Corrects position, attitude and scale with a displacement d since an anchor, d = e⁻ˢ (R₀ᵀ (p − p₀) + n).
    ///
    /// A product of scale and position is not linear: the update uses its exact mean and covariance under what is known
    /// before, instead of slopes at the state, so that the filter does not grow too sure of the scale.
    ///
    /// # Errors
    /// [`FusionError`] for numbers that are not finite or a pitch that is too steep.
    pub fn update_odometry(&mut self, odometry: &AnchoredOdometry) -> Result<Outcome, FusionError> {
        let numbers = odometry
            .anchor_position
            .iter()
            .chain(odometry.displacement.iter());
        if !numbers
            .chain(odometry.attitude.iter())
            .all(|v| v.is_finite())
        {
            return Err(FusionError::NonFinite {
                name: "the odometry",
            });
        }
        self.check_pitch(odometry.attitude.y)?;
        let back = odometry.anchor_rotation.inverse();
        let way = back * (self.state.position - odometry.anchor_position);
        let weak = self.weakness(odometry.inliers);
        let noise = [self.config.visual_sigma, self.config.visual_drift].map(|s| weak * s * s);
        let predicted = predict_displacement(&self.covariance, &way, back.matrix(), noise);
        let angle = weak * self.config.visual_angle_sigma.powi(2);
        let mut spread = predicted.spread;
        (3..6).for_each(|k| spread[(k, k)] += angle);
        let position = odometry.displacement * self.state.scale() - predicted.mean;
        let angles = (odometry.attitude - self.state.attitude).map(wrap);
        let innovation: SVector<f64, 6> =
            SVector::from_iterator(position.iter().chain(&angles).copied());
        let inverse = inverse_of(&spread)?;
        let distance = innovation.dot(&(inverse * innovation));
        let outcome = self.judge(distance, self.config.visual_gate);
        if outcome.accepted {
            let gain = predicted.cross * inverse;
            let covariance = self.covariance - gain * predicted.cross.transpose();
            self.accept(&(gain * innovation), &covariance)?;
            self.fixed_at = self.time;
        }
        Ok(outcome)
    }

    /// By how much the covariance of a visual pose is greater when few matches support it.
    fn weakness(&self, inliers: usize) -> f64 {
        if inliers < self.config.few_inliers {
            4.0
        } else {
            1.0
        }
    }

    fn fix(
        &mut self,
        position: Vector3<f64>,
        attitude: Vector3<f64>,
        matrix: SMatrix<f64, 6, 7>,
        distance: f64,
        inliers: usize,
    ) -> Result<Outcome, FusionError> {
        let angles = (attitude - self.state.attitude).map(wrap);
        let [x, y, z]: [f64; 3] = position.into();
        let innovation = SVector::from([x, y, z, angles.x, angles.y, angles.z]);
        let weak = self.weakness(inliers);
        let p = weak
            * (self.config.visual_sigma.powi(2)
                + (self.config.visual_drift * distance.max(0.0)).powi(2));
        let a = weak * self.config.visual_angle_sigma.powi(2);
        let noise = SMatrix::from_diagonal(&SVector::from([p, p, p, a, a, a]));
        let outcome = self.correct(&innovation, &matrix, &noise, self.config.visual_gate)?;
        if outcome.accepted {
            self.fixed_at = self.time;
        }
        Ok(outcome)
    }
}
