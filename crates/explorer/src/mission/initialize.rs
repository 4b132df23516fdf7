//! Translate until SLAM has a map: a monocular camera that hovers or yaws never initialises.

use super::context::Context;
use super::event::Event;
use super::maneuver::{Maneuver, down, left, right, turn, up};
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::scan::Scan;

/// Length of each translation, centimetres: stays within the bubble that the operator keeps clear.
const STEP_CM: i64 = 40;
/// Turn to another view after each fruitless round, radians.
const NEXT_VIEW: f64 = core::f64::consts::FRAC_PI_3;
/// A full turn of views, and one more.
const ROUNDS: usize = 7;

#[derive(Debug, Default)]
pub(super) struct Initialize {
    round: usize,
    initialized: bool,
    maneuver: Maneuver,
}

impl Initialize {
    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        // A map without a scale cannot be flown in: the take-off may have initialised it, so translate all the same.
        if context.knowledge.is_tracking() && context.knowledge.meters_per_unit().is_some() {
            if !self.initialized {
                self.initialized = true;
                context.log(Event::Initialized);
            }
            // What is left of the manoeuvre brings the drone back to where it began: finish that first.
            return match self.maneuver.next() {
                Some(command) => Step::Send(command),
                None => Step::Become(Phase::Scan(Scan::full())),
            };
        }
        if let Some(command) = self.maneuver.next() {
            return Step::Send(command);
        }
        if self.round == ROUNDS {
            return context.land(Outcome::NeverInitialized);
        }
        if self.round > 0 {
            self.maneuver.push(turn(NEXT_VIEW));
        }
        self.round += 1;
        for command in [up(STEP_CM), down(STEP_CM), left(STEP_CM), right(STEP_CM)] {
            self.maneuver.push(command);
        }
        Step::Wait
    }
}
