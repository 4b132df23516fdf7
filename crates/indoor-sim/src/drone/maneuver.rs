//! What the drone is doing: taking off, a straight move, a turn, braking, sticks, landing, falling.

use nalgebra::Vector3;

use super::profile::Profile;

/// Where the drone wants to be: its position without the wandering, metres, and its heading, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Goal {
    pub(crate) position: Vector3<f64>,
    pub(crate) yaw: f64,
}

impl Goal {
    /// This goal moved by a share of a way and of a turn.
    fn moved(self, way: Vector3<f64>, turn: f64, share: f64) -> Self {
        Self {
            position: self.position + way * share,
            yaw: self.yaw + turn * share,
        }
    }
}

/// `a / b`, and 1 where b is 0: nothing to do is done.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 1.0 }
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
                let done = profile.position(time - dead_time);
                Some(from.moved(way, turn, ratio(done, way.norm().max(turn.abs()))))
            }
            Self::Brake {
                from,
                velocity,
                yaw_rate,
                seconds,
            } => {
                let t = time.min(seconds);
                Some(from.moved(velocity, yaw_rate, t - 0.5 * ratio(t * t, seconds).min(t)))
            }
            Self::Land {
                from,
                floor,
                seconds,
            } => {
                let drop = Vector3::z() * (floor - from.position.z);
                Some(from.moved(drop, 0.0, ratio(time, seconds).min(1.0)))
            }
            Self::Fall { from, floor } => {
                let drop = 0.5 * GRAVITY * time * time;
                let drop = drop.min((from.position.z - floor).max(0.0));
                Some(from.moved(-Vector3::z(), 0.0, drop))
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
