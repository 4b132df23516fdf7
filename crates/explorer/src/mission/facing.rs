//! Which way the camera looks while the drone flies: ahead where tracking will hold, otherwise where it will.

use core::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Rotation3, Unit, Vector3};
use tello_sdk::{Command, Distance};

use crate::heading::LevelPose;
use crate::scene::Scene;

/// Points that a leg should keep in view to be flown looking ahead: three times what SLAM systems call lost.
pub(super) const COMFORTABLE: usize = 60;

/// Where the direction of travel lies in the drone's body frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Facing {
    Ahead,
    Left,
    Right,
    Back,
}

impl Facing {
    pub(super) const ALL: [Self; 4] = [Self::Ahead, Self::Left, Self::Right, Self::Back];

    /// Bearing of the direction of travel in the body frame, counterclockwise.
    pub(super) fn bearing(self) -> f64 {
        match self {
            Self::Ahead => 0.0,
            Self::Left => FRAC_PI_2,
            Self::Right => -FRAC_PI_2,
            Self::Back => PI,
        }
    }

    /// The direction of travel as (forward, left, up).
    pub(super) fn axis(self) -> Vector3<f64> {
        match self {
            Self::Ahead => Vector3::x(),
            Self::Left => Vector3::y(),
            Self::Right => -Vector3::y(),
            Self::Back => -Vector3::x(),
        }
    }

    pub(super) fn command(self, distance: Distance) -> Command {
        match self {
            Self::Ahead => Command::Forward(distance),
            Self::Left => Command::Left(distance),
            Self::Right => Command::Right(distance),
            Self::Back => Command::Back(distance),
        }
    }

    /// The facing for a leg of `units` along the bearing `angle` from the present heading: ahead if enough is in view all along,
    /// else whatever keeps most in view.
    pub(super) fn choose(scene: &Scene, pose: &LevelPose, angle: f64, units: f64) -> Self {
        let axis = Unit::new_normalize(pose.up);
        let travel = Rotation3::from_axis_angle(&axis, angle) * pose.forward;
        let mut best = (Self::Ahead, 0);
        for facing in Self::ALL {
            let look = Rotation3::from_axis_angle(&axis, -facing.bearing()) * travel;
            let at = |share: f64| {
                scene
                    .sight
                    .expected(&(pose.position + travel * (units * share)), &look, &pose.up)
            };
            let least = at(0.5).min(at(1.0));
            if facing == Self::Ahead && least >= COMFORTABLE {
                return facing;
            }
            if least > best.1 {
                best = (facing, least);
            }
        }
        best.0
    }
}
