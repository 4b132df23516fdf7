//! The extended Kalman filter.
//!
//! ```text
//! predict   p ← p + R(α) v dt      F = I, F[p, α] = [∂R/∂φ v, ∂R/∂θ v, ∂R/∂ψ v] dt      P ← F P Fᵀ + Q
//! update    K = P Hᵀ (H P Hᵀ + R)⁻¹      x ← x + K y      P ← (I − K H) P (I − K H)ᵀ + K R Kᵀ
//! ```
//!
//! Innovations of angles are wrapped; an innovation outside its 95 % gate is rejected, and after three rejections in
//! a row the covariance grows tenfold, so that a filter that has gone astray finds back. A displacement of unknown scale is
//! not linearised (see [`Ekf::update_odometry`]).

use nalgebra::{SMatrix, SVector, Vector3};

use super::displacement::predict_displacement;
use super::measurement::{
    AnchoredOdometry, AttitudeSample, FlightSample, VelocityFrame, VisualPose,
};
use super::state::{
    NavigationState, StateCovariance, StateVector, rotation, rotation_slopes, wrap,
};
use super::{FusionError, ProcessNoise};

/// Parameters of [`Ekf`].
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
        let positive = [
            ("attitude_sigma", self.attitude_sigma.min()),
            ("visual_sigma", self.visual_sigma),
            ("visual_angle_sigma", self.visual_angle_sigma),
            ("steepest_pitch", self.steepest_pitch),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(FusionError::Parameter {
                    name,
                    value,
                    range: "positive",
                });
            }
        }
        let others = [
            ("visual_drift", self.visual_drift),
            ("initial_scale_sigma", self.initial_scale_sigma),
        ];
        for (name, value) in others {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(FusionError::Parameter {
                    name,
                    value,
                    range: "0 or more",
                });
            }
        }
        let gates = [
            ("attitude_gate", self.attitude_gate),
            ("visual_gate", self.visual_gate),
        ];
        if let Some((name, value)) = gates.into_iter().find(|(_, gate)| !(*gate > 0.0)) {
            return Err(FusionError::Parameter {
                name,
                value,
                range: "positive",
            });
        }
        let value = self.steepest_pitch;
        let below = value < core::f64::consts::FRAC_PI_2;
        let range = "below a right angle";
        if below {
            Ok(())
        } else {
            Err(FusionError::Parameter {
                name: "steepest_pitch",
                value,
                range,
            })
        }
    }
}

/// What became of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Whether it was used.
    pub accepted: bool,
    /// Squared Mahalanobis length of the innovation.
    pub distance: f64,
    /// The gate it was held against.
    pub gate: f64,
}

const INITIAL_POSITION_SIGMA: f64 = 0.01;
const REJECTIONS: u32 = 3;
const INFLATION: f64 = 10.0;

/// The filter. Feed samples in the order of their times.
///
/// ```
/// use edge_slam::fusion::{Ekf, EkfConfig, FlightSample};
/// use edge_slam::nalgebra::Vector3;
/// let mut ekf = Ekf::new(EkfConfig::default(), 0.0, Vector3::zeros(), Vector3::zeros())?;
/// let velocity = Vector3::new(1.0, 0.0, 0.0);
/// ekf.predict(&FlightSample { time: 2.0, velocity, battery: 0.9 })?;
/// assert_eq!(ekf.state().position.x, 2.0);
/// # Ok::<(), edge_slam::fusion::FusionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Ekf {
    config: EkfConfig,
    state: NavigationState,
    covariance: StateCovariance,
    time: f64,
    fixed_at: f64,
    rejected: u32,
}

impl Ekf {
    /// A filter at rest at a known place and attitude (standard deviations of 1 cm and 1 degree).
    ///
    /// # Errors
    /// [`FusionError`] for bad parameters, numbers that are not finite and steep pitch.
    pub fn new(
        config: EkfConfig,
        time: f64,
        position: Vector3<f64>,
        attitude: Vector3<f64>,
    ) -> Result<Self, FusionError> {
        config.validate()?;
        let state = NavigationState {
            position,
            attitude,
            log_scale: 0.0,
        };
        if !(state.is_finite() && time.is_finite()) {
            return Err(FusionError::NonFinite {
                name: "the initial state",
            });
        }
        let (p, a) = (INITIAL_POSITION_SIGMA.powi(2), 1_f64.to_radians().powi(2));
        let s = config.initial_scale_sigma.powi(2);
        let covariance = StateCovariance::from_diagonal(&SVector::from([p, p, p, a, a, a, s]));
        let filter = Self {
            config,
            state,
            covariance,
            time,
            fixed_at: time,
            rejected: 0,
        };
        filter.check_pitch(attitude.y)?;
        Ok(filter)
    }

    /// The newest estimate.
    #[must_use]
    pub fn state(&self) -> &NavigationState {
        &self.state
    }

    /// Its covariance.
    #[must_use]
    pub fn covariance(&self) -> &StateCovariance {
        &self.covariance
    }

    /// Time of the newest sample, seconds.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Sets the scale (for example the median ratio of displacements) with its standard deviation of the logarithm.
    ///
    /// # Errors
    /// [`FusionError::Parameter`] unless both are positive.
    pub fn set_scale(&mut self, scale: f64, sigma: f64) -> Result<(), FusionError> {
        for (name, value) in [("scale", scale), ("sigma", sigma)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(FusionError::Parameter {
                    name,
                    value,
                    range: "positive",
                });
            }
        }
        self.state.log_scale = scale.ln();
        self.covariance.row_mut(6).fill(0.0);
        self.covariance.column_mut(6).fill(0.0);
        self.covariance[(6, 6)] = sigma * sigma;
        Ok(())
    }

    /// Takes the present position for exact (1 cm, as at the start), so that the covariance from now on is that of the
    /// way since here: what an odometry measures that is anchored here. Without this the doubt about where the anchor
    /// lies would be taken for a doubt about the way from it, and the scale would be bent to fit.
    pub fn anchor_here(&mut self) {
        self.covariance.fixed_rows_mut::<3>(0).fill(0.0);
        self.covariance.fixed_columns_mut::<3>(0).fill(0.0);
        for k in 0..3 {
            self.covariance[(k, k)] = INITIAL_POSITION_SIGMA * INITIAL_POSITION_SIGMA;
        }
    }

    /// Moves the state to the sample's time with its velocity.
    ///
    /// # Errors
    /// [`FusionError`] for samples out of order or not finite.
    pub fn predict(&mut self, sample: &FlightSample) -> Result<(), FusionError> {
        let finite = sample.velocity.iter().all(|v| v.is_finite());
        if !(finite && sample.time.is_finite() && sample.battery.is_finite()) {
            return Err(FusionError::NonFinite {
                name: "the flight sample",
            });
        }
        if sample.time < self.time {
            return Err(FusionError::TimeBackwards {
                time: sample.time,
                now: self.time,
            });
        }
        let dt = sample.time - self.time;
        let transition = self.transition(&sample.velocity, dt);
        self.state.position += self.world_velocity(&sample.velocity).0 * dt;
        let age = sample.time - self.fixed_at;
        let noise = self.config.process.covariance(sample.battery, age, dt);
        self.covariance = transition * self.covariance * transition.transpose() + noise;
        self.time = sample.time;
        Ok(())
    }

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

    /// One gated update in Joseph's form.
    fn correct<const N: usize>(
        &mut self,
        innovation: &SVector<f64, N>,
        matrix: &SMatrix<f64, N, 7>,
        noise: &SMatrix<f64, N, N>,
        gate: f64,
    ) -> Result<Outcome, FusionError> {
        let spread = matrix * self.covariance * matrix.transpose() + noise;
        let inverse = inverse_of(&spread)?;
        let distance = innovation.dot(&(inverse * innovation));
        let outcome = self.judge(distance, gate);
        if outcome.accepted {
            let gain = self.covariance * matrix.transpose() * inverse;
            let rest = StateCovariance::identity() - gain * matrix;
            let joseph =
                rest * self.covariance * rest.transpose() + gain * noise * gain.transpose();
            self.accept(&(gain * innovation), &joseph)?;
        }
        Ok(outcome)
    }

    /// Holds a distance against its gate; after several rejections in a row the filter doubts itself.
    fn judge(&mut self, distance: f64, gate: f64) -> Outcome {
        let accepted = distance.is_finite() && distance <= gate;
        if !accepted {
            self.rejected += 1;
            if self.rejected >= REJECTIONS {
                self.covariance *= INFLATION;
                self.rejected = 0;
            }
        }
        Outcome {
            accepted,
            distance,
            gate,
        }
    }

    fn accept(
        &mut self,
        step: &StateVector,
        covariance: &StateCovariance,
    ) -> Result<(), FusionError> {
        let next = self.state.moved(step);
        self.check_pitch(next.attitude.y)?;
        self.state = next;
        self.covariance = (covariance + covariance.transpose()) * 0.5;
        self.rejected = 0;
        Ok(())
    }

    /// F: how the state after `dt` seconds depends on the state now.
    fn transition(&self, velocity: &Vector3<f64>, dt: f64) -> StateCovariance {
        let (_, slopes) = self.world_velocity(velocity);
        let mut transition = StateCovariance::identity();
        for (k, slope) in slopes.into_iter().enumerate() {
            transition
                .fixed_view_mut::<3, 1>(0, 3 + k)
                .copy_from(&(slope * dt));
        }
        transition
    }

    /// The velocity in the world and its derivatives by roll, pitch and yaw.
    fn world_velocity(&self, velocity: &Vector3<f64>) -> (Vector3<f64>, [Vector3<f64>; 3]) {
        let attitude = match self.config.velocity_frame {
            VelocityFrame::World => return (*velocity, [Vector3::zeros(); 3]),
            VelocityFrame::Body => self.state.attitude,
            VelocityFrame::YawLevelled => Vector3::new(0.0, 0.0, self.state.attitude.z),
        };
        let mut slopes = rotation_slopes(&attitude).map(|slope| slope * velocity);
        if self.config.velocity_frame == VelocityFrame::YawLevelled {
            slopes[..2].fill(Vector3::zeros());
        }
        (rotation(&attitude) * velocity, slopes)
    }

    fn check_pitch(&self, pitch: f64) -> Result<(), FusionError> {
        if pitch.abs() <= self.config.steepest_pitch {
            return Ok(());
        }
        Err(FusionError::GimbalLock {
            pitch_degrees: pitch.to_degrees(),
        })
    }
}

fn inverse_of<const N: usize>(
    spread: &SMatrix<f64, N, N>,
) -> Result<SMatrix<f64, N, N>, FusionError> {
    let factor = spread.cholesky().ok_or(FusionError::NonFinite {
        name: "the innovation's covariance",
    })?;
    Ok(factor.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A filter somewhere, turned, with a scale.
    fn filter(state: [f64; 7], velocity_frame: VelocityFrame) -> Ekf {
        let config = EkfConfig {
            velocity_frame,
            ..EkfConfig::default()
        };
        let [x, y, z, roll, pitch, yaw, s] = state;
        let attitude = Vector3::new(roll, pitch, yaw);
        let mut ekf = Ekf::new(config, 0.0, Vector3::new(x, y, z), attitude).unwrap();
        ekf.state.log_scale = s;
        ekf
    }

    #[test]
    fn the_gate_parts_what_is_taken_from_what_is_not() {
        let mut ekf = filter([0.0; 7], VelocityFrame::Body);
        for gate in [ekf.config.attitude_gate, ekf.config.visual_gate] {
            assert!(ekf.judge(gate, gate).accepted);
            assert!(!ekf.judge(1.001 * gate, gate).accepted);
        }
        assert!(!ekf.judge(f64::NAN, f64::INFINITY).accepted);
        assert!(!ekf.judge(f64::INFINITY, f64::INFINITY).accepted);
    }

    fn vector(state: &NavigationState) -> SVector<f64, 7> {
        let (p, a) = (state.position, state.attitude);
        SVector::from([p.x, p.y, p.z, a.x, a.y, a.z, state.log_scale])
    }

    /// Central differences of what is computed from the state, by all seven of its parts.
    fn differences<const N: usize>(
        ekf: &Ekf,
        compute: impl Fn(&Ekf) -> SVector<f64, N>,
    ) -> SMatrix<f64, N, 7> {
        let mut matrix = SMatrix::<f64, N, 7>::zeros();
        for k in 0..7 {
            let at = |step: f64| {
                let mut moved = ekf.clone();
                let mut change = SVector::<f64, 7>::zeros();
                change[k] = step;
                moved.state = ekf.state.moved(&change);
                compute(&moved)
            };
            matrix.set_column(k, &((at(1e-6) - at(-1e-6)) / 2e-6));
        }
        matrix
    }

    proptest! {
        #[test]
        fn the_transition_is_the_derivative_of_the_prediction(
            state in prop::array::uniform7(-1.2..1.2f64), velocity in prop::array::uniform3(-2.0..2.0f64),
            dt in 0.01..1.0f64,
        ) {
            for frame in [VelocityFrame::Body, VelocityFrame::YawLevelled, VelocityFrame::World] {
                let ekf = filter(state, frame);
                let velocity = Vector3::from(velocity);
                let numeric = differences(&ekf, |ekf| {
                    let mut ekf = ekf.clone();
                    ekf.predict(&FlightSample { time: dt, velocity, battery: 0.7 }).unwrap();
                    vector(&ekf.state)
                });
                let error = (numeric - ekf.transition(&velocity, dt)).abs().max();
                prop_assert!(error < 1e-8, "{frame:?} {error}");
            }
        }
    }
}
