//! Odometry and the drone's telemetry in one estimate: metric, and without gaps where tracking breaks off.
//!
//! 1. Telemetry moves the filter (velocity, battery) and corrects its attitude.
//! 2. The first pose of an epoch is an anchor: later ones are displacements from it, in the odometry's frame.
//! 3. Without metric depth their unit is learnt first: over a second of flight the median ratio of what the
//!    velocities say was travelled and what the odometry says; from then on it is a state of the filter.
//! 4. A new epoch is anchored where the filter is then.

use nalgebra::{Isometry3, Matrix3, Rotation3, Similarity3, UnitQuaternion, Vector3};

use super::Tracked;
use crate::fusion::{
    AnchoredOdometry, AttitudeSample, Ekf, EkfConfig, FlightSample, FusionError, NavigationState,
    Outcome, VelocityFrame,
};

/// Odometry fused with telemetry. World and body have x ahead, y to the left and z up.
#[derive(Debug, Clone, PartialEq)]
pub struct TelemetryFusion {
    ekf: Ekf,
    velocity_frame: VelocityFrame,
    body_from_camera: Rotation3<f64>,
    latest: Option<FlightSample>,
    epoch: Option<u64>,
    anchor: Option<Anchor>,
    start: ScaleStart,
}

/// Where an epoch's odometry lies in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Anchor {
    position: Vector3<f64>,
    world_from_odometry: Rotation3<f64>,
    origin: Vector3<f64>,
}

/// What is known after a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FusedPose {
    /// Position in metres, attitude and scale of the filter at the frame's time.
    pub state: NavigationState,
    /// World from camera, metres.
    pub world_from_camera: Isometry3<f64>,
    /// What became of the odometry's pose; `None` when there was none, or it only served as an anchor.
    pub outcome: Option<Outcome>,
}

/// Relative deviation of the scale of metric depth, and of one that was just learnt.
const METRIC_SIGMA: f64 = 0.02;
const LEARNT_SIGMA: f64 = 0.2;

impl TelemetryFusion {
    /// Begins at rest in the world's origin at `time`, with this attitude (roll, pitch, yaw).
    /// `body_from_camera` is where the camera points: [`TelemetryFusion::looking_ahead`] for most drones.
    ///
    /// # Errors
    /// [`FusionError`] for bad parameters and numbers.
    pub fn new(
        config: EkfConfig,
        body_from_camera: Rotation3<f64>,
        time: f64,
        attitude: Vector3<f64>,
    ) -> Result<Self, FusionError> {
        Ok(Self {
            ekf: Ekf::new(config, time, Vector3::zeros(), attitude)?,
            velocity_frame: config.velocity_frame,
            body_from_camera,
            latest: None,
            epoch: None,
            anchor: None,
            start: ScaleStart::default(),
        })
    }

    /// Parameters for a drone that turns: the filter knows no turn rate, so that its process noise must allow for what
    /// the drone turns between two samples (β_a = (30 degrees)² a second; with the default (2 degrees)² a yaw of
    /// 23 degrees a second lags 25 degrees behind). Velocities are turned with yaw only, as the Tello's are.
    #[must_use]
    pub fn turning() -> EkfConfig {
        let mut config = EkfConfig {
            velocity_frame: VelocityFrame::YawLevelled,
            ..EkfConfig::default()
        };
        config.process.attitude = 30_f64.to_radians().powi(2);
        config
    }

    /// A camera that looks ahead: its right, down and forward are the body's −y, −z and x.
    #[must_use]
    pub fn looking_ahead() -> Rotation3<f64> {
        Rotation3::from_matrix_unchecked(Matrix3::new(
            0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0,
        ))
    }

    /// The filter.
    #[must_use]
    pub fn ekf(&self) -> &Ekf {
        &self.ekf
    }

    /// Takes the present epoch's odometry (poses, map) to the filter's world, with the newest scale; `None` until the
    /// unit is known. Only as good as the anchor: the filter's own position has less drift.
    #[must_use]
    pub fn world_from_odometry(&self) -> Option<Similarity3<f64>> {
        let anchor = self.anchor?;
        let turn = UnitQuaternion::from_rotation_matrix(&anchor.world_from_odometry);
        let scale = self.ekf.state().scale();
        let shift = anchor.position - turn * anchor.origin * scale;
        Some(Similarity3::from_parts(shift.into(), turn, scale))
    }

    /// World from camera by the filter, metres.
    #[must_use]
    pub fn world_from_camera(&self) -> Isometry3<f64> {
        let state = self.ekf.state();
        let rotation = state.rotation() * self.body_from_camera;
        let turn = UnitQuaternion::from_rotation_matrix(&rotation);
        Isometry3::from_parts(state.position.into(), turn)
    }

    /// Takes a sample of the telemetry, in the order of time, and its attitude where it has one.
    ///
    /// # Errors
    /// [`FusionError`] for samples out of order, not finite, or with a pitch that is too steep.
    pub fn telemetry(
        &mut self,
        sample: &FlightSample,
        attitude: Option<&AttitudeSample>,
    ) -> Result<(), FusionError> {
        self.advance(sample)?;
        self.latest = Some(*sample);
        if let Some(attitude) = attitude {
            self.ekf.update_attitude(attitude)?;
        }
        Ok(())
    }

    /// Takes what the odometry made of a frame, with its map's epoch and whether its unit is the metre.
    ///
    /// # Errors
    /// [`FusionError`] for a time before the newest sample's, or a pitch that is too steep.
    pub fn observe(
        &mut self,
        time: f64,
        tracked: &Tracked,
        epoch: u64,
        is_metric: bool,
    ) -> Result<FusedPose, FusionError> {
        if let Some(latest) = self.latest {
            // Between two samples the drone is taken to keep its velocity.
            self.advance(&FlightSample { time, ..latest })?;
        }
        if self.epoch != Some(epoch) {
            (self.epoch, self.anchor) = (Some(epoch), None);
            self.start = ScaleStart::default();
        }
        let outcome = match &tracked.world_from_camera {
            Some(pose) => self.fuse(time, pose, tracked.inliers, is_metric)?,
            None => None,
        };
        Ok(FusedPose {
            state: *self.ekf.state(),
            world_from_camera: self.world_from_camera(),
            outcome,
        })
    }

    fn advance(&mut self, sample: &FlightSample) -> Result<(), FusionError> {
        let dt = sample.time - self.ekf.time();
        self.ekf.predict(sample)?;
        let attitude = self.ekf.state().attitude;
        let turned = match self.velocity_frame {
            VelocityFrame::World => sample.velocity,
            VelocityFrame::Body => self.ekf.state().rotation() * sample.velocity,
            VelocityFrame::YawLevelled => {
                Rotation3::from_axis_angle(&Vector3::z_axis(), attitude.z) * sample.velocity
            }
        };
        self.start.travelled += turned * dt;
        Ok(())
    }

    fn fuse(
        &mut self,
        time: f64,
        pose: &Isometry3<f64>,
        inliers: usize,
        is_metric: bool,
    ) -> Result<Option<Outcome>, FusionError> {
        let camera = pose.rotation.to_rotation_matrix();
        let Some(anchor) = self.anchor else {
            let scale = if is_metric {
                Some((1.0, METRIC_SIGMA))
            } else {
                self.start.add(time, pose.translation.vector);
                self.start.ratio().map(|ratio| (ratio, LEARNT_SIGMA))
            };
            if let Some((scale, sigma)) = scale {
                self.ekf.set_scale(scale, sigma)?;
                self.ekf.anchor_here();
                let world_from_body = self.ekf.state().rotation();
                self.anchor = Some(Anchor {
                    position: self.ekf.state().position,
                    world_from_odometry: world_from_body * self.body_from_camera * camera.inverse(),
                    origin: pose.translation.vector,
                });
            }
            return Ok(None);
        };
        let body = anchor.world_from_odometry * camera * self.body_from_camera.inverse();
        let (roll, pitch, yaw) = body.euler_angles();
        let odometry = AnchoredOdometry {
            anchor_position: anchor.position,
            anchor_rotation: anchor.world_from_odometry,
            displacement: pose.translation.vector - anchor.origin,
            attitude: Vector3::new(roll, pitch, yaw),
            inliers,
        };
        self.ekf.update_odometry(&odometry).map(Some)
    }
}

/// Learns what a unit of the odometry is worth.
#[derive(Debug, Clone, PartialEq, Default)]
struct ScaleStart {
    /// The integral of the velocity since the epoch began, metres.
    travelled: Vector3<f64>,
    /// Time, that integral, and the odometry's position.
    samples: Vec<(f64, Vector3<f64>, Vector3<f64>)>,
}

/// Seconds that must be seen, seconds between the two ends of a ratio, and the least speed, m/s.
const WINDOW: f64 = 1.0;
const STRIDE: f64 = 0.5;
const LEAST_SPEED: f64 = 0.15;

impl ScaleStart {
    fn add(&mut self, time: f64, position: Vector3<f64>) {
        self.samples.push((time, self.travelled, position));
    }

    /// The median of metres over units, once there is a second of it and some speed.
    fn ratio(&self) -> Option<f64> {
        let (first, last) = (self.samples.first()?, self.samples.last()?);
        if last.0 - first.0 < WINDOW {
            return None;
        }
        let mut ratios = Vec::new();
        let mut from = 0;
        for (time, travelled, position) in &self.samples {
            while time - self.samples[from].0 > STRIDE {
                from += 1;
            }
            let (since, before, place) = &self.samples[from];
            let metres = (travelled - before).norm();
            let units = (position - place).norm();
            let span = time - since;
            if span > 0.8 * STRIDE && metres > LEAST_SPEED * span && units > 0.0 {
                ratios.push(metres / units);
            }
        }
        // Half a stride's worth of ratios, so that one jump does not decide.
        ratios.sort_by(f64::total_cmp);
        (ratios.len() >= 5).then(|| ratios[ratios.len() / 2])
    }
}
