//! Land, and ask again until the drone or its height says that it is down.

use super::context::Context;
use super::event::Event;
use super::outcome::Outcome;
use super::phase::Step;
use super::pilot::CommandOutcome;
use tello_sdk::Command;

/// How often to ask; each try waits for the landing's own time limit.
const TRIES: usize = 5;

#[derive(Debug)]
pub(super) struct Landing {
    outcome: Outcome,
    tries: usize,
}

impl Landing {
    pub(super) fn new(outcome: Outcome) -> Self {
        Self { outcome, tries: 0 }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        if self.tries == 0 {
            context.log(Event::Landing {
                outcome: self.outcome.clone(),
            });
        } else if context.last_outcome() == Some(&CommandOutcome::Done) {
            context.set_outcome(self.outcome.clone());
            return Step::Finish;
        }
        if self.tries == TRIES {
            context.set_outcome(Outcome::LandingUnconfirmed);
            return Step::Finish;
        }
        self.tries += 1;
        Step::Send(Command::Land)
    }
}
