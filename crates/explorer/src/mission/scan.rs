//! Look all around, or once in one direction from two heights, since a map point needs parallax.

use super::context::Context;
use super::event::Event;
use super::maneuver::{climb, turn};
use super::phase::{Phase, Step};
use super::recover::Recover;
use super::spin::{Spin, Spun};
use super::think::Think;
use tello_sdk::Command;

/// The drone cannot climb by less.
const SHORTEST_CLIMB_CM: i64 = 20;

/// Turns below this show nothing new, radians.
const SMALLEST_LOOK: f64 = 0.15;

/// A full turn by sticks, or a list of turns with a climb or a descent after each.
#[derive(Debug)]
pub(super) struct Scan {
    purpose: Purpose,
    /// Turns still to be made, radians, counterclockwise positive; last one first.
    turns: Vec<f64>,
    climb_next: bool,
    /// How far above the flying height the drone is now, centimetres.
    raised: Option<i64>,
    started: bool,
    /// The full turn under way.
    spin: Option<Spin>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// All around, a new scan site.
    Site,
    /// A look at one direction, to prove more space free.
    Look,
}

impl Scan {
    /// A full turn.
    pub(super) fn full() -> Self {
        Self::new(Purpose::Site, Vec::new())
    }

    /// A look, from two heights, in the direction that is `towards` radians from the present heading; `None` when that is where the
    /// drone looks already and there is no room to climb.
    pub(super) fn look(context: &Context<'_>, towards: f64) -> Option<Self> {
        let turns = towards.abs() >= SMALLEST_LOOK;
        let climbs = free_climb(context).is_some();
        (turns || climbs).then(|| Self::new(Purpose::Look, vec![towards]))
    }

    fn new(purpose: Purpose, turns: Vec<f64>) -> Self {
        Self {
            purpose,
            turns,
            climb_next: false,
            raised: None,
            started: false,
            spin: None,
        }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        if !self.started {
            self.started = true;
            if self.purpose == Purpose::Site {
                context.begin_scan();
                let number = context.scans.len();
                context.log(Event::ScanStarted { number });
                self.spin = Some(Spin::new(context));
            }
        }
        if let Some(spin) = &mut self.spin {
            match spin.next(context) {
                Spun::Send(command) => return Step::Send(command),
                Spun::Wait => return Step::Wait,
                Spun::Done => self.spin = None,
            }
        }
        loop {
            if self.climb_next {
                self.climb_next = false;
                if let Some(command) = self.climb(context) {
                    return Step::Send(command);
                }
            }
            let Some(angle) = self.turns.pop() else {
                return self.end(context);
            };
            self.climb_next = true;
            if let Some(command) = turn(angle) {
                return Step::Send(command);
            }
        }
    }

    /// Away from the flying height, then back to it at the next stop; only where the space is known to be free.
    fn climb(&mut self, context: &Context<'_>) -> Option<Command> {
        if let Some(centimeters) = self.raised.take() {
            return climb(-centimeters);
        }
        let chosen = free_climb(context)?;
        self.raised = Some(chosen);
        climb(chosen)
    }

    fn end(&mut self, context: &mut Context<'_>) -> Step {
        if let Some(centimeters) = self.raised.take() {
            return climb(-centimeters).map_or(Step::Wait, Step::Send);
        }
        if !context.knowledge.is_tracking() {
            return Step::Become(Phase::Recover(Recover::turning_back(
                context.retreat.take(),
            )));
        }
        match self.purpose {
            Purpose::Site if context.needs_triangle() => Step::Become(context.triangle()),
            Purpose::Site => Step::Become(Phase::Think(Think::after_scan())),
            Purpose::Look => Step::Become(Phase::Think(Think::again())),
        }
    }
}

/// The most useful climb, centimetres, that leads through free space.
fn free_climb(context: &Context<'_>) -> Option<i64> {
    let full = context.config.scan_climb_cm;
    [
        full,
        full * 3 / 4,
        full / 2,
        -full / 2,
        -full * 3 / 4,
        -full,
    ]
    .into_iter()
    .find(|&centimeters| {
        centimeters.abs() >= SHORTEST_CLIMB_CM
            && context.vertical_is_free(centimeters as f64 / 100.0)
    })
}
