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

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use tello_sdk::{Command, Source, Telemetry};

    use super::super::drawn::Drawn;
    use super::super::maneuver::forward;
    use super::super::{Input, Mission, Output};
    use super::*;

    fn frame(mission: &mut Mission, millis: u64) -> Output {
        let now = Duration::from_millis(millis);
        mission.handle(Input::Frame {
            now,
            telemetry: Box::new(Telemetry::builder(now, Source::Simulated).build()),
            slam: None,
        });
        mission.poll(&mut ())
    }

    #[test]
    fn the_late_answer_of_an_overtaken_move_is_not_the_landings() {
        let mut mission = Drawn::new(&["#####", "#.a.#", "#####"]).mission;
        let leg = forward(60).unwrap();
        mission.pilot.start(leg.clone(), &mission.shared.knowledge);
        mission.handle(Input::Stop);
        assert_eq!(frame(&mut mission, 1000), Output::Send(Command::Land));
        let outcome = CommandOutcome::Done;
        mission.handle(Input::Answer {
            to: leg,
            outcome: outcome.clone(),
        });
        assert_eq!(frame(&mut mission, 3000), Output::Wait);
        let to = Command::Land;
        mission.handle(Input::Answer { to, outcome });
        frame(&mut mission, 4000);
        assert_eq!(
            frame(&mut mission, 5000),
            Output::Finished(Outcome::Stopped)
        );
    }
}
