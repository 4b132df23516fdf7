//! Mission pads on the floor: which one the drone sees, where it is in the pad's frame, and the way to a point in it.
//!
//! The downward camera sees a pad from 0.3 to 1.2 m above it within the camera's cone (the heights are the maker's, the
//! cone an assumption); the forward camera sees none here. Without the standard library nothing is ever seen.

use super::Emulator;
use super::physics::{Action, Physics, Truth};
use crate::command::{Command, Pad, PadDirection, Waypoint};
use crate::state::StateLine;
use crate::units::PadNumber;

/// A pad on the floor, in the frame at power-on: x forward, y left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorPad {
    /// Its number.
    pub number: PadNumber,
    /// Where it lies, m.
    pub position: [f64; 2],
    /// Where its x axis points, degrees clockwise from the drone's nose at power-on.
    pub yaw_deg: f64,
}

/// Heights over a pad at which it is seen, m.
const SEEN_FROM: core::ops::RangeInclusive<f64> = 0.25..=1.25;
/// Half the width of the camera's cone over its height, and a pad's own half width, m.
const CONE: f64 = 0.5;
const HALF_PAD: f64 = 0.1;

impl FloorPad {
    /// The drone in this pad's frame, m.
    fn see(&self, truth: &Truth) -> [f64; 3] {
        let [x, y, z] = truth.position;
        let [px, py] = self.position;
        turned([x - px, y - py, z], self.yaw_deg)
    }

    fn is_seen(&self, truth: &Truth) -> bool {
        let [x, y, _] = self.see(truth);
        let height = truth.ground_distance;
        let reach = CONE * height + HALF_PAD;
        cfg!(feature = "std") && SEEN_FROM.contains(&height) && x * x + y * y <= reach * reach
    }

    /// From the drone to a point in this pad's frame, in the drone's frame, m.
    fn way(&self, truth: &Truth, to: Waypoint) -> [f64; 3] {
        let ([x, y, z], here) = (to.meters(), self.see(truth));
        let level = [x - here[0], y - here[1], z - here[2]];
        turned(level, truth.attitude_deg[2] - self.yaw_deg)
    }
}

/// A vector in a frame that is turned clockwise by so many degrees.
fn turned([x, y, z]: [f64; 3], degrees: f64) -> [f64; 3] {
    #[cfg(feature = "std")]
    {
        let (sin, cos) = degrees.to_radians().sin_cos();
        [x * cos - y * sin, x * sin + y * cos, z]
    }
    #[cfg(not(feature = "std"))]
    {
        let _ = degrees;
        [x, y, z]
    }
}

impl<P: Physics> Emulator<P> {
    /// The pad that a command means, if it is in sight.
    fn pad_in_sight(&self, wanted: Option<Pad>) -> Option<FloorPad> {
        if !self.looks_for_pads || self.pad_direction == PadDirection::Forward {
            return None;
        }
        let truth = self.body.physics.truth();
        let distance = |pad: &FloorPad| {
            let [x, y, _] = pad.see(&truth);
            x * x + y * y
        };
        let fits = |pad: &&FloorPad| match wanted {
            Some(Pad::Number(number)) => pad.number == number,
            _ => true,
        };
        let seen = self.config.pads.iter().filter(|pad| pad.is_seen(&truth));
        seen.filter(fits)
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .copied()
    }

    /// What a command in a pad's frame asks for; `None` if that pad is not in sight.
    pub(super) fn pad_action(&self, command: &Command) -> Option<Action> {
        let truth = self.body.physics.truth();
        match command {
            Command::GoPad { to, speed, pad } => Some(Action::Move {
                offset: self.pad_in_sight(Some(*pad))?.way(&truth, *to),
                speed: speed.meters_per_s(),
            }),
            Command::CurvePad { arc, speed, pad } => {
                let pad = self.pad_in_sight(Some(*pad))?;
                Some(Action::Arc {
                    via: pad.way(&truth, arc.via()),
                    to: pad.way(&truth, arc.to()),
                    speed: f64::from(speed.cm_per_s()) / 100.0,
                })
            }
            Command::Jump {
                to,
                speed,
                from_pad,
                ..
            } => Some(Action::Move {
                offset: self.pad_in_sight(Some(*from_pad))?.way(&truth, *to),
                speed: speed.meters_per_s(),
            }),
            _ => None,
        }
    }

    /// The turn after the first part of a jump; `None` if the second pad is not in sight.
    pub(super) fn second_part(&self, command: &Command) -> Option<Action> {
        let Command::Jump {
            yaw_degrees,
            to_pad,
            ..
        } = command
        else {
            return None;
        };
        let pad = self.pad_in_sight(Some(*to_pad))?;
        let now = self.body.physics.truth().attitude_deg[2];
        let turn = (pad.yaw_deg + f64::from(*yaw_degrees) - now) % 360.0;
        let degrees = if turn > 180.0 {
            turn - 360.0
        } else if turn < -180.0 {
            turn + 360.0
        } else {
            turn
        };
        Some(Action::Turn { degrees })
    }

    /// The pad's part of a state line: -2 when not looking, -1 when none is in sight.
    pub(super) fn add_pad(&self, line: &mut StateLine) {
        let nothing = if self.looks_for_pads { -1.0 } else { -2.0 };
        line.mid = Some(nothing);
        line.pad_position = [Some(nothing * 100.0); 3];
        line.mpry = Some([0.0; 3]);
        if let Some(pad) = self.pad_in_sight(None) {
            let truth = self.body.physics.truth();
            let yaw = (truth.attitude_deg[2] - pad.yaw_deg) % 360.0;
            line.mid = Some(f64::from(pad.number.number()));
            line.pad_position = pad.see(&truth).map(|meters| Some(meters * 100.0));
            line.mpry = Some([truth.attitude_deg[0], truth.attitude_deg[1], yaw]);
        }
    }
}
