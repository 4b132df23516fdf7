//! What the filter can be told.

use core::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use super::measurement::VelocityFrame;
use super::{FusionError, ProcessNoise};

/// Parameters of [`Ekf`](super::Ekf).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EkfConfig {
    /// Process noise.
    pub process: ProcessNoise,
    /// Frame of the velocities. Default the body (the paper).
    pub velocity_frame: VelocityFrame,
    /// Standard deviations of the telemetry's roll, pitch and yaw, radians, > 0. Default 1, 1 and 3 degrees.
    pub attitude_sigma: Vector3<f64>,
    /// Standard deviation of visual positions at their anchor, metres, > 0. Default 0.03.
    pub visual_sigma: f64,
    /// Its growth per metre travelled, >= 0. Default 0.02.
    pub visual_drift: f64,
    /// Standard deviation of visual angles, radians, > 0. Default 1 degree.
    pub visual_angle_sigma: f64,
    /// Under this many inliers the visual covariance is four times as great. Default 50.
    pub few_inliers: usize,
    /// Pitch, radians, beyond which Euler angles are refused, in (0, π/2). Default 89 degrees.
    pub steepest_pitch: f64,
    /// Standard deviation of the log scale at the start, >= 0; 0 when the visual scale is known. Default 0.5.
    pub initial_scale_sigma: f64,
    /// Squared Mahalanobis length up to which an attitude is accepted, > 0; infinite for all. Default 7.81, 95 % of χ² with
    /// 3 degrees of freedom.
    pub attitude_gate: f64,
    /// The same for a visual pose or displacement. Default 12.59, 95 % of χ² with 6 degrees of freedom. One good measurement
    /// in twenty is refused, those on which the state is worst, so that the filter is a little too sure of itself.
    pub visual_gate: f64,
}

impl Default for EkfConfig {
    fn default() -> Self {
        Self {
            process: ProcessNoise::default(),
            velocity_frame: VelocityFrame::Body,
            attitude_sigma: Vector3::new(1.0, 1.0, 3.0).map(f64::to_radians),
            visual_sigma: 0.03,
            visual_drift: 0.02,
            visual_angle_sigma: 1_f64.to_radians(),
            few_inliers: 50,
            steepest_pitch: 89_f64.to_radians(),
            initial_scale_sigma: 0.5,
            attitude_gate: 7.81,
            visual_gate: 12.59,
        }
    }
}

impl EkfConfig {
    /// Errs at the first field outside its range.
    ///
    /// # Errors
    /// [`FusionError::Parameter`].
    pub fn validate(&self) -> Result<(), FusionError> {
        self.process.validate()?;
        let positive = (f64::MIN_POSITIVE, f64::MAX, "positive");
        let not_negative = (0.0, f64::MAX, "0 or more");
        let gate = (f64::MIN_POSITIVE, f64::INFINITY, "positive");
        let steepest = FRAC_PI_2.next_down();
        let pitch = (f64::MIN_POSITIVE, steepest, "between 0 and a right angle");
        let fields = [
            ("attitude_sigma", self.attitude_sigma.min(), positive),
            ("visual_sigma", self.visual_sigma, positive),
            ("visual_angle_sigma", self.visual_angle_sigma, positive),
            ("steepest_pitch", self.steepest_pitch, pitch),
            ("visual_drift", self.visual_drift, not_negative),
            (
                "initial_scale_sigma",
                self.initial_scale_sigma,
                not_negative,
            ),
            ("attitude_gate", self.attitude_gate, gate),
            ("visual_gate", self.visual_gate, gate),
        ];
        for (name, value, (least, most, range)) in fields {
            if !(value >= least && value <= most) {
                return Err(FusionError::Parameter { name, value, range });
            }
        }
        Ok(())
    }
}
