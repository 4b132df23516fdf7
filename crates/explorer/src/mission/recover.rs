//! Find the lost pose again: look around, then go back along the moves since the last scan and look around there.

use core::f64::consts::TAU;
use core::time::Duration;

use super::context::Context;
use super::event::Event;
use super::fly::wrap;
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
/// Looks of one turn. The first is made where the pose was lost, which mostly is enough and loses no ground.
const ROUND: usize = 12;

#[derive(Debug)]
pub(super) struct Recover {
    /// What undoes a move that was broken off or turned the view away: done before any look.
    at_once: Option<Command>,
    /// What is left of the way back, the next move last.
    way_back: Vec<Command>,
    /// A move that the rest of the way back begins at the end of is in flight or has just ended.
    on_the_way: bool,
    began: Option<Duration>,
    looks: usize,
    /// Heading before the first look: the moves of the way back are relative to it.
    heading: Option<f64>,
    /// The drone has turned back to that heading.
    is_straight: bool,
    /// The drone is no longer where the first round was made.
    has_moved: bool,
}

impl Recover {
    /// After losing the pose with this way back, the next move first.
    pub(super) fn new(mut way_back: Vec<Command>) -> Self {
        way_back.reverse();
        Self {
            at_once: None,
            way_back,
            on_the_way: false,
            began: None,
            looks: 0,
            heading: None,
            is_straight: false,
            has_moved: false,
        }
    }

    /// The same, but a turn that comes first is undone at once: the view before it was known.
    pub(super) fn turning_back(way_back: Vec<Command>) -> Self {
        let mut recover = Self::new(way_back);
        recover.at_once = recover
            .way_back
            .pop_if(|next| matches!(next, Command::Clockwise(_) | Command::CounterClockwise(_)));
        recover
    }

    /// The same while that turn is still under way: it has to be done for that.
    pub(super) fn after_turn(way_back: Vec<Command>) -> Self {
        Self {
            on_the_way: true,
            ..Self::turning_back(way_back)
        }
    }

    /// After a move was broken off of which this undoes what was surely flown.
    pub(super) fn broken_off(at_once: Option<Command>) -> Self {
        Self {
            at_once,
            ..Self::new(Vec::new())
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
        self.check_last_move(context);
        if let Some(command) = self.at_once.take() {
            self.on_the_way = true;
            return Step::Send(command);
        }
        if self.looks == 0 {
            self.heading = context.knowledge.heading();
        }
        if self.looks == ROUND
            && let Some(command) = self.elsewhere(context)
        {
            return Step::Send(command);
        }
        if self.looks == 2 * ROUND {
            return context.land(Outcome::TrackingLost);
        }
        self.looks += 1;
        turn(LOOK).map_or(Step::Wait, Step::Send)
    }

    /// Gives up the way back when nobody knows where the drone is on it, or whether it has turned.
    fn check_last_move(&mut self, context: &Context<'_>) {
        let is_lost = match context.last_outcome() {
            Some(CommandOutcome::Unknown) => true,
            // A leg that was stopped may be refused; how far it came has been allowed for.
            Some(CommandOutcome::Refused(_)) => self.on_the_way,
            Some(CommandOutcome::Done) | None => false,
        };
        if is_lost {
            self.at_once = None;
            self.way_back.clear();
        }
        self.on_the_way = false;
    }

    /// To where the second round is made: along the way back, after turning to the heading that it was flown with, or a little lower. `None`
    /// when the drone is there.
    fn elsewhere(&mut self, context: &Context<'_>) -> Option<Command> {
        if !self.is_straight {
            self.is_straight = true;
            match context.knowledge.heading().zip(self.heading) {
                Some((heading, before)) if !self.way_back.is_empty() => {
                    if let Some(command) = turn(wrap(heading - before)) {
                        self.on_the_way = true;
                        return Some(command);
                    }
                }
                Some(_) => {}
                None => self.way_back.clear(),
            }
        }
        if let Some(command) = self.way_back.pop() {
            self.on_the_way = true;
            self.has_moved = true;
            return Some(command);
        }
        if self.has_moved {
            return None;
        }
        self.has_moved = true;
        climb(-20)
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
    use tello_sdk::{Attitude, Source, Telemetry};

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

    /// A frame without a pose, `millis` after the drone was switched on, from a drone that heads so, clockwise.
    fn frame(mission: &mut Mission, millis: u64, yaw_deg: f64) -> Output {
        let now = Duration::from_millis(millis);
        let attitude = Attitude {
            pitch_deg: 0.0,
            roll_deg: 0.0,
            yaw_deg,
        };
        let telemetry = Telemetry::builder(now, Source::Simulated).attitude(attitude);
        mission.handle(Input::Frame {
            now,
            telemetry: Box::new(telemetry.build()),
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
        match frame(mission, millis, 0.0) {
            Output::Send(command) => Some(command),
            _ => None,
        }
    }

    /// The drone's answer to `to`.
    fn answer(mission: &mut Mission, to: Option<Command>, outcome: CommandOutcome) {
        let to = to.unwrap();
        mission.handle(Input::Answer { to, outcome });
    }

    /// Looks once around, every half a second from `millis` on, and ends with this heading; what is sent next.
    fn look_around(mission: &mut Mission, millis: u64, yaw_deg: f64) -> Option<Command> {
        assert_eq!(frame(mission, millis, 0.0), Output::Wait, "patience");
        for look in 1..=ROUND as u64 {
            assert_eq!(command(mission, millis + 1000 * look), turn(LOOK), "{look}");
            answer(mission, turn(LOOK), CommandOutcome::Done);
        }
        match frame(mission, millis + 20_000, yaw_deg) {
            Output::Send(command) => Some(command),
            _ => None,
        }
    }

    #[test]
    fn what_was_flown_since_the_scan_is_undone_after_a_look_around() {
        let mut mission = lost();
        assert_eq!(look_around(&mut mission, 1000, 0.0), right(30));
        answer(&mut mission, right(30), CommandOutcome::Done);
        assert_eq!(command(&mut mission, 23_000), back(60));
        answer(&mut mission, back(60), CommandOutcome::Done);
        assert_eq!(command(&mut mission, 25_000), turn(LOOK));
        let again = mission.shared.retreat.take();
        assert!(again.is_empty(), "nothing is undone twice");
    }

    #[test]
    fn the_way_back_is_flown_with_the_heading_that_it_was_flown_out_with() {
        let mut mission = lost();
        // The turns went on for ten degrees clockwise too far.
        assert_eq!(
            look_around(&mut mission, 1000, 10.0),
            turn(10f64.to_radians())
        );
        answer(&mut mission, turn(10f64.to_radians()), CommandOutcome::Done);
        assert_eq!(command(&mut mission, 23_000), right(30));
    }

    #[test]
    fn without_a_way_back_the_second_look_is_from_below_and_then_the_drone_lands() {
        let mut mission = lost();
        mission.shared.retreat.forget();
        assert_eq!(look_around(&mut mission, 1000, 0.0), climb(-20));
        let mut asked = climb(-20);
        for look in 0..ROUND as u64 {
            answer(&mut mission, asked, CommandOutcome::Done);
            asked = turn(LOOK);
            assert_eq!(
                command(&mut mission, 23_000 + 1000 * look),
                turn(LOOK),
                "{look}"
            );
        }
        answer(&mut mission, asked, CommandOutcome::Done);
        assert_eq!(command(&mut mission, 40_000), Some(Command::Land));
    }

    /// What is sent first after the pose was lost during this command, which then ended so.
    fn lost_during(during: Option<Command>, outcome: CommandOutcome) -> Option<Command> {
        let mut mission = lost();
        mission.phase = Phase::Triangle(Maneuver::default());
        let sent = during.clone().unwrap();
        mission.pilot.start(sent, &mission.shared.knowledge);
        // The pose is lost; a leg is stopped, a turn runs on.
        frame(&mut mission, 1000, 0.0);
        frame(&mut mission, 4000, 0.0);
        assert!(matches!(mission.phase, Phase::Recover(_)));
        answer(&mut mission, during, outcome);
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
        assert_eq!(look_around(&mut mission, 1000, 0.0), right(30));
        let refused = CommandOutcome::Refused("error".to_owned());
        answer(&mut mission, right(30), refused);
        assert_eq!(command(&mut mission, 23_000), turn(LOOK));
    }
}
