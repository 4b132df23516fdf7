//! What the drone is doing: taking off, a straight move, a turn, braking, sticks, landing, falling.

use nalgebra::Vector3;

use super::profile::Profile;

/// Where the drone wants to be: its position without the wandering, metres, and its heading, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Goal {
    pub(crate) position: Vector3<f64>,
    pub(crate) yaw: f64,
}

/// One thing at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Maneuver {
    /// Standing, hovering or held by sticks.
    None,
    /// A move along `way`, a turn by `turn`, or both, from `from`, after `dead_time` seconds.
    Move {
        from: Goal,
        way: Vector3<f64>,
        turn: f64,
        profile: Profile,
        dead_time: f64,
    },
    /// Slowing down from `velocity`.
    Brake {
        from: Goal,
        velocity: Vector3<f64>,
        yaw_rate: f64,
        seconds: f64,
    },
    /// Descending to `floor` until something is underneath.
    Land {
        from: Goal,
        floor: f64,
        seconds: f64,
    },
    /// Motors stopped in the air.
    Fall { from: Goal, floor: f64 },
}

impl Maneuver {
    /// Where the drone wants to be `time` seconds after the start; `None` when standing.
    pub(crate) fn goal(&self, time: f64) -> Option<Goal> {
        match *self {
            Self::None => None,
            Self::Move {
                from,
                way,
                turn,
                profile,
                dead_time,
            } => {
                let length = way.norm().max(turn.abs());
                let share = if length > 0.0 {
                    profile.position(time - dead_time) / length
                } else {
                    1.0
                };
                Some(Goal {
                    position: from.position + way * share,
                    yaw: from.yaw + turn * share,
                })
            }
            Self::Brake {
                from,
                velocity,
                yaw_rate,
                seconds,
            } => {
                let t = time.min(seconds);
                let reach = if seconds > 0.0 {
                    t - 0.5 * t * t / seconds
                } else {
                    0.0
                };
                let position = from.position + velocity * reach;
                Some(Goal {
                    position,
                    yaw: from.yaw + yaw_rate * reach,
                })
            }
            Self::Land {
                from,
                floor,
                seconds,
            } => {
                let share = if seconds > 0.0 {
                    (time / seconds).min(1.0)
                } else {
                    1.0
                };
                let mut position = from.position;
                position.z += (floor - position.z) * share;
                Some(Goal {
                    position,
                    yaw: from.yaw,
                })
            }
            Self::Fall { from, floor } => {
                let mut position = from.position;
                position.z = (position.z - 0.5 * GRAVITY * time * time).max(floor);
                Some(Goal {
                    position,
                    yaw: from.yaw,
                })
            }
        }
    }

    /// Seconds until it is over, without settling.
    pub(crate) fn duration(&self) -> f64 {
        match *self {
            Self::None => 0.0,
            Self::Move {
                profile, dead_time, ..
            } => dead_time + profile.duration(),
            Self::Brake { seconds, .. } | Self::Land { seconds, .. } => seconds,
            Self::Fall { from, floor } => {
                (2.0 * (from.position.z - floor).max(0.0) / GRAVITY).sqrt()
            }
        }
    }
}

/// Standard gravity, m/s².
pub(crate) const GRAVITY: f64 = 9.806_65;
