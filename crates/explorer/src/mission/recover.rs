//! Find the lost pose again: back along the last leg, then look around.

use core::f64::consts::TAU;
use core::time::Duration;

use super::context::Context;
use super::event::Event;
use super::maneuver::{back, climb, turn};
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::think::Think;

/// How long to hover before doing anything: a pose is often back after a few frames.
const PATIENCE: Duration = Duration::from_millis(1500);
/// Step of the look around, radians.
const LOOK: f64 = TAU / 12.0;
/// A full look around at each of two heights.
const LOOKS: usize = 24;

#[derive(Debug)]
pub(super) struct Recover {
    /// Length of the leg that was being flown, centimetres: it is known to be free.
    retreat_cm: Option<i64>,
    began: Option<Duration>,
    looks: usize,
}

impl Recover {
    /// After losing the pose while turning on the spot.
    pub(super) fn in_place() -> Self {
        Self {
            retreat_cm: None,
            began: None,
            looks: 0,
        }
    }

    /// After losing the pose on a forward leg of which about `flown_cm` were flown.
    pub(super) fn on_leg(flown_cm: i64) -> Self {
        Self {
            retreat_cm: Some(flown_cm),
            ..Self::in_place()
        }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        let now = context.knowledge.now();
        let began = *self.began.get_or_insert(now);
        if context.knowledge.is_tracking() {
            context.log(Event::Recovered);
            return Step::Become(Phase::Think(Think::again()));
        }
        if now < began + PATIENCE {
            return Step::Wait;
        }
        if let Some(command) = self.retreat_cm.take().and_then(back) {
            return Step::Send(command);
        }
        if self.looks == LOOKS {
            return context.land(Outcome::TrackingLost);
        }
        self.looks += 1;
        let command = if self.looks == LOOKS / 2 {
            climb(-20)
        } else {
            turn(LOOK)
        };
        command.map_or(Step::Wait, Step::Send)
    }
}
