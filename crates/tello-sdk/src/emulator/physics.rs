//! The hook for a model of the drone's movement: the emulator speaks, the physics flies.

use crate::reply::Refusal;
use crate::session::Sticks;
use core::time::Duration;

/// What the drone is told to do. Lengths in metres: x forward, y left, z up, relative to the drone at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Action {
    /// Take off and hover.
    TakeOff,
    /// Land and stop the motors.
    Land,
    /// Fly straight.
    Move {
        /// Where to, m.
        offset: [f64; 3],
        /// How fast, m/s.
        speed: f64,
    },
    /// Fly an arc.
    Arc {
        /// A point on the way, m.
        via: [f64; 3],
        /// The end, m.
        to: [f64; 3],
        /// How fast, m/s.
        speed: f64,
    },
    /// Turn on the spot, degrees, clockwise from above positive.
    Turn {
        /// Angle, degrees.
        degrees: f64,
    },
    /// Flip over.
    Flip,
    /// Stop where it is.
    Hover,
    /// Cut the motors: fall.
    CutMotors,
    /// Turn the motors on the ground on or off.
    Idle(bool),
}

/// How far the current action is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Progress {
    /// Nothing runs.
    Idle,
    /// It runs.
    Running,
    /// It has ended since the last question.
    Ended(Result<(), Refusal>),
}

/// What the sensors of the drone would see without error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Truth {
    /// Pitch, roll, yaw in degrees; yaw clockwise positive.
    pub attitude_deg: [f64; 3],
    /// Velocity in m/s: x forward, y left, z up.
    pub velocity: [f64; 3],
    /// Position in m in the frame at power-on: x forward, y left, z up.
    pub position: [f64; 3],
    /// Height over the take-off point, m.
    pub height: f64,
    /// Distance to the ground below, m.
    pub ground_distance: f64,
    /// Specific force in m/s^2, sensor axes (about -9.8 on z at rest).
    pub acceleration: [f64; 3],
    /// Whether the motors turn.
    pub motors: bool,
}

/// A model of the drone's movement. Times never go back.
pub trait Physics {
    /// Starts an action; whatever ran before is over.
    ///
    /// # Errors
    /// The drone's own word for why it does not: [`Refusal::MotorStop`] on the ground, for example.
    fn begin(&mut self, now: Duration, action: Action) -> Result<(), Refusal>;

    /// Sets the velocity command of the sticks; it holds until the next one or the next action.
    fn set_sticks(&mut self, now: Duration, sticks: Sticks);

    /// Moves everything forward to this time.
    fn advance(&mut self, now: Duration);

    /// How far the current action is; an end is told once.
    fn progress(&mut self) -> Progress;

    /// What the sensors would see.
    fn truth(&self) -> Truth;
}
