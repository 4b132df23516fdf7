//! Find the lost pose again: back along the last leg, then look around.

use core::f64::consts::TAU;
use core::time::Duration;

use super::context::Context;
use super::event::Event;
use super::maneuver::{climb, turn};
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::think::Think;
use tello_sdk::Command;

/// How long to hover before doing anything: a pose is often back after a few frames.
const PATIENCE: Duration = Duration::from_millis(800);
/// Step of the look around, radians.
const LOOK: f64 = TAU / 12.0;
/// A full look around at each of two heights.
const LOOKS: usize = 24;

#[derive(Debug)]
pub(super) struct Recover {
    /// Back along the leg that was being flown: it is known to be free.
    way_back: Option<Command>,
    began: Option<Duration>,
    looks: usize,
}

impl Recover {
    /// After losing the pose on the spot.
    pub(super) fn in_place() -> Self {
        Self::new(None)
    }

    /// After losing the pose on a leg with this way back, if any.
    pub(super) fn new(way_back: Option<Command>) -> Self {
        Self {
            way_back,
            began: None,
            looks: 0,
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
        if let Some(command) = self.way_back.take() {
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
