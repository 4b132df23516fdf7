//! Turn on the spot while going up and down: the turn shows everything, the climbs give the parallax that triangulates it.

use core::f64::consts::TAU;

use super::context::Context;
use super::event::Event;
use super::maneuver::{climb, turn};
use super::phase::{Phase, Step};
use super::recover::Recover;
use super::think::Think;
use tello_sdk::Command;

/// A turn in steps, a climb or a descent after each.
#[derive(Debug)]
pub(super) struct Scan {
    purpose: Purpose,
    /// Turns still to be made, radians, counterclockwise positive; last one first.
    turns: Vec<f64>,
    climb_next: bool,
    raised: bool,
    started: bool,
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
    pub(super) fn full(context: &Context<'_>) -> Self {
        let steps = context.config.scan_steps.max(3);
        Self::new(Purpose::Site, vec![TAU / steps as f64; steps])
    }

    /// A look around the direction that is `towards` radians from the present heading.
    pub(super) fn look(context: &Context<'_>, towards: f64) -> Self {
        let step = TAU / context.config.scan_steps.max(3) as f64;
        Self::new(Purpose::Look, vec![step, step, towards - step])
    }

    fn new(purpose: Purpose, turns: Vec<f64>) -> Self {
        Self {
            purpose,
            turns,
            climb_next: false,
            raised: false,
            started: false,
        }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        if !self.started {
            self.started = true;
            if self.purpose == Purpose::Site {
                context.begin_scan();
                let number = context.scans.len();
                context.log(Event::ScanStarted { number });
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

    /// Up, then down again at the next stop, where the space above is known to be free.
    fn climb(&mut self, context: &Context<'_>) -> Option<Command> {
        if self.raised {
            self.raised = false;
            return climb(-context.config.scan_climb_cm);
        }
        let meters = context.config.scan_climb_cm as f64 / 100.0;
        if !context.vertical_is_free(meters) {
            return None;
        }
        self.raised = true;
        climb(context.config.scan_climb_cm)
    }

    fn end(&mut self, context: &mut Context<'_>) -> Step {
        if self.raised {
            self.raised = false;
            return climb(-context.config.scan_climb_cm).map_or(Step::Wait, Step::Send);
        }
        if !context.knowledge.is_tracking() {
            return Step::Become(Phase::Recover(Recover::in_place()));
        }
        match self.purpose {
            Purpose::Site if context.needs_triangle() => Step::Become(context.triangle()),
            Purpose::Site => Step::Become(Phase::Think(Think::after_scan())),
            Purpose::Look => Step::Become(Phase::Think(Think::again())),
        }
    }
}
