//! Find the lost pose again: back along the moves since the last scan, then look around.

use core::f64::consts::TAU;
use core::time::Duration;

use super::context::Context;
use super::event::Event;
use super::maneuver::{climb, turn};
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::pilot::CommandOutcome;
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
    /// What is left of the way back, the next move last.
    way_back: Vec<Command>,
    /// A move that the rest of the way back begins at the end of is in flight or has just ended.
    on_the_way: bool,
    began: Option<Duration>,
    looks: usize,
}

impl Recover {
    /// After losing the pose with this way back, the next move first.
    pub(super) fn new(way_back: Vec<Command>) -> Self {
        Self::starting(way_back, false)
    }

    /// The same while a move is under way whose whole is to be undone first: it has to be done for that.
    pub(super) fn after_move(way_back: Vec<Command>) -> Self {
        Self::starting(way_back, true)
    }

    fn starting(mut way_back: Vec<Command>, on_the_way: bool) -> Self {
        way_back.reverse();
        Self {
            way_back,
            on_the_way,
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
        let is_lost = match context.last_outcome() {
            Some(CommandOutcome::Unknown) => true,
            // A leg that was stopped may be refused; how far it came has been allowed for.
            Some(CommandOutcome::Refused(_)) => self.on_the_way,
            Some(CommandOutcome::Done) | None => false,
        };
        if is_lost {
            // Nobody knows where the drone is on the way back, or whether it has turned.
            self.way_back.clear();
        }
        self.on_the_way = false;
        if let Some(command) = self.way_back.pop() {
            self.on_the_way = true;
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

#[cfg(test)]
mod tests {
    use super::super::drawn::Drawn;
    use super::super::maneuver::{Maneuver, back, forward, left, right};
    use super::super::pilot::Finished;
    use super::super::{Input, Mission, Output};
    use super::*;
    use slam_bridge::{SlamUpdate, TrackingState};
    use tello_sdk::{Source, Telemetry};

    /// A mission that flew forward and left after its last scan and lost the pose while deciding what to do next.
    fn lost() -> Mission {
        let mut mission = Drawn::new(&["#####", "#.a.#", "#####"]).mission;
        for command in [forward(60), left(30)].into_iter().flatten() {
            mission.shared.retreat.note(&Finished {
                command,
                outcome: CommandOutcome::Done,
            });
        }
        mission.phase = Phase::Think(Think::again());
        mission
    }

    /// A frame without a pose, `millis` after the drone was switched on.
    fn frame(mission: &mut Mission, millis: u64) -> Output {
        let now = Duration::from_millis(millis);
        mission.handle(Input::Frame {
            now,
            telemetry: Box::new(Telemetry::builder(now, Source::Simulated).build()),
            slam: Some(SlamUpdate {
                time: now,
                state: TrackingState::Lost,
                world_from_camera: None,
                epoch: 0,
                tracked_points: 0,
            }),
        });
        mission.poll(&mut ())
    }

    fn command(mission: &mut Mission, millis: u64) -> Option<Command> {
        match frame(mission, millis) {
            Output::Send(command) => Some(command),
            _ => None,
        }
    }

    #[test]
    fn what_was_flown_since_the_scan_is_undone_before_the_look_around() {
        let mut mission = lost();
        assert_eq!(frame(&mut mission, 1000), Output::Wait, "patience");
        assert_eq!(command(&mut mission, 2000), right(30));
        mission.handle(Input::Answer(CommandOutcome::Done));
        assert_eq!(command(&mut mission, 3000), back(60));
        mission.handle(Input::Answer(CommandOutcome::Done));
        assert_eq!(command(&mut mission, 5000), turn(LOOK));
        assert!(
            mission.shared.retreat.take().is_empty(),
            "nothing is undone twice"
        );
    }

    /// What is sent first after the pose was lost during this command, which then ended so.
    fn lost_during(during: Option<Command>, outcome: CommandOutcome) -> Option<Command> {
        let mut mission = lost();
        mission.phase = Phase::Triangle(Maneuver::default());
        mission
            .pilot
            .start(during.unwrap(), &mission.shared.knowledge);
        // The pose is lost; a leg is stopped, a turn runs on.
        frame(&mut mission, 1000);
        frame(&mut mission, 4000);
        assert!(matches!(mission.phase, Phase::Recover(_)));
        mission.handle(Input::Answer(outcome));
        let mut sent = (41..60).filter_map(|tenths| command(&mut mission, 100 * tenths));
        sent.next()
    }

    #[test]
    fn after_a_turn_that_was_not_done_nothing_is_flown_blind() {
        let refused = || CommandOutcome::Refused("error".to_owned());
        assert_eq!(lost_during(turn(0.5), CommandOutcome::Done), turn(-0.5));
        assert_eq!(lost_during(turn(0.5), refused()), turn(LOOK));
        assert_eq!(lost_during(turn(0.5), CommandOutcome::Unknown), turn(LOOK));
        // A leg that was stopped is undone in part, unless it may never have begun.
        let back = |sent: Option<Command>| matches!(sent, Some(Command::Back(_)));
        assert!(back(lost_during(forward(60), CommandOutcome::Done)));
        assert!(back(lost_during(forward(60), refused())));
        assert!(!back(lost_during(forward(60), CommandOutcome::Unknown)));
    }

    #[test]
    fn a_refused_way_back_ends_it() {
        let mut mission = lost();
        assert_eq!(frame(&mut mission, 1000), Output::Wait, "patience");
        assert_eq!(command(&mut mission, 2000), right(30));
        mission.handle(Input::Answer(CommandOutcome::Refused("error".to_owned())));
        assert_eq!(command(&mut mission, 3000), turn(LOOK));
    }
}
