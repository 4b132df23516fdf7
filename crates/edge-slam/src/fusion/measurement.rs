//! What the filter is told.

use nalgebra::{Rotation3, Vector3};

/// Velocity and battery from the drone's telemetry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightSample {
    /// Seconds on the caller's clock.
    pub time: f64,
    /// Metres per second, in the frame that [`super::EkfConfig::velocity_frame`] names.
    pub velocity: Vector3<f64>,
    /// Charge, 0 empty to 1 full (not per cent).
    pub battery: f64,
}

/// The frame of the telemetry's velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum VelocityFrame {
    /// The body, as the paper has it.
    #[default]
    Body,
    /// Turned with yaw only, roll and pitch taken out.
    YawLevelled,
    /// The world.
    World,
}

/// Attitude from the drone's telemetry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttitudeSample {
    /// Roll, pitch, yaw, radians.
    pub angles: Vector3<f64>,
}

/// An absolute pose from visual odometry that already has the world's frame and scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisualPose {
    /// World frame, metres.
    pub position: Vector3<f64>,
    /// Roll, pitch, yaw, radians.
    pub attitude: Vector3<f64>,
    /// Metres travelled since the visual system's last anchor, >= 0: its drift grows with this.
    pub distance: f64,
    /// Matches that support the pose.
    pub inliers: usize,
}

/// A displacement from visual odometry whose scale is not known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnchoredOdometry {
    /// The filter's position when the odometry was anchored, metres.
    pub anchor_position: Vector3<f64>,
    /// World from the odometry's frame at the anchor.
    pub anchor_rotation: Rotation3<f64>,
    /// Displacement since then in the odometry's frame and units.
    pub displacement: Vector3<f64>,
    /// Roll, pitch, yaw, radians.
    pub attitude: Vector3<f64>,
    /// Matches that support it.
    pub inliers: usize,
}
