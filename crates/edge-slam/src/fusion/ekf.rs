//! The extended Kalman filter.
//!
//! ```text
//! predict   p ← p + R(α) v dt      F = I, F[p, α] = [∂R/∂φ v, ∂R/∂θ v, ∂R/∂ψ v] dt      P ← F P Fᵀ + Q
//! update    K = P Hᵀ (H P Hᵀ + R)⁻¹      x ← x + K y      P ← (I − K H) P (I − K H)ᵀ + K R Kᵀ
//! ```
//!
//! An innovation outside its 95 % gate is rejected, and after three rejections in a row the covariance grows tenfold, so that a
//! filter that has gone astray finds back. The measurements are in `update.rs`.

use core::f64::consts::PI;

use nalgebra::{SMatrix, SVector, Vector3};

use super::measurement::{FlightSample, VelocityFrame};
use super::state::{
    NavigationState, StateCovariance, StateVector, rotation, rotation_slopes, wrap,
};
use super::{EkfConfig, FusionError};

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
    pub(super) config: EkfConfig,
    pub(super) state: NavigationState,
    pub(super) covariance: StateCovariance,
    pub(super) time: f64,
    pub(super) fixed_at: f64,
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
        let within = |angle: f64| {
            if angle.abs() <= PI {
                angle
            } else {
                wrap(angle)
            }
        };
        let state = NavigationState {
            position,
            attitude: Vector3::new(within(attitude.x), attitude.y, within(attitude.z)),
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
        let mut state = self.state;
        state.position += self.world_velocity(&sample.velocity).0 * dt;
        let age = sample.time - self.fixed_at;
        let noise = self.config.process.covariance(sample.battery, age, dt);
        let covariance = transition * self.covariance * transition.transpose() + noise;
        if !(state.is_finite() && covariance.iter().all(|value| value.is_finite())) {
            return Err(FusionError::NonFinite {
                name: "what the flight sample leads to",
            });
        }
        (self.state, self.covariance, self.time) = (state, covariance, sample.time);
        Ok(())
    }

    /// One gated update in Joseph's form.
    pub(super) fn correct<const N: usize>(
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
    pub(super) fn judge(&mut self, distance: f64, gate: f64) -> Outcome {
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

    pub(super) fn accept(
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

    pub(super) fn check_pitch(&self, pitch: f64) -> Result<(), FusionError> {
        if pitch.abs() <= self.config.steepest_pitch {
            return Ok(());
        }
        Err(FusionError::GimbalLock {
            pitch_degrees: pitch.to_degrees(),
        })
    }
}

pub(super) fn inverse_of<const N: usize>(
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
