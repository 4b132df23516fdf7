//! The way back to where the pose was sure: the moves since the last scan undone, the newest first.
//!
//! SLAM recognises a place from where it was mapped, and a scan maps all around. What was just flown is free, as far as the drone's errors
//! allow: each move adds its own, so that the way is short, and a move whose end is not known cuts it off.

use tello_sdk::{Command, Waypoint};

use super::pilot::{CommandOutcome, Finished, displacement};

/// Longest way back without a pose, metres: a long leg, whose errors its room allows for.
const FARTHEST_M: f64 = 1.5;

/// The moves since the last scan, oldest first.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Retreat {
    flown: Vec<Command>,
}

impl Retreat {
    /// Remembers a move that ended.
    pub(super) fn note(&mut self, finished: &Finished) {
        if finished.outcome == CommandOutcome::Done {
            self.flown.push(finished.command.clone());
        } else {
            self.flown.clear();
        }
    }

    /// From here on the pose is sure.
    pub(super) fn forget(&mut self) {
        self.flown.clear();
    }

    /// The way back in commands, in the order in which they are flown; it is remembered no longer.
    pub(super) fn take(&mut self) -> Vec<Command> {
        let flown = core::mem::take(&mut self.flown);
        let undone = flown.iter().rev().map_while(undo);
        let mut left = FARTHEST_M;
        let within = |command: &Command| {
            left -= displacement(command).norm();
            left >= 0.0
        };
        undone.take_while(within).collect()
    }
}

/// The command that undoes another; `None` for what is no move.
pub(super) fn undo(command: &Command) -> Option<Command> {
    Some(match *command {
        Command::Forward(leg) => Command::Back(leg),
        Command::Back(leg) => Command::Forward(leg),
        Command::Left(leg) => Command::Right(leg),
        Command::Right(leg) => Command::Left(leg),
        Command::Up(leg) => Command::Down(leg),
        Command::Down(leg) => Command::Up(leg),
        Command::Clockwise(turn) => Command::CounterClockwise(turn),
        Command::CounterClockwise(turn) => Command::Clockwise(turn),
        Command::Go { to, speed } => {
            let [x, y, z] = to.cm().map(|part| -i64::from(part));
            Command::Go {
                to: Waypoint::from_cm(x, y, z).ok()?,
                speed,
            }
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::maneuver::{back, forward, left, right, turn, up};
    use super::*;
    use tello_sdk::Speed;

    fn retreat(flown: &[Option<Command>]) -> Retreat {
        let mut retreat = Retreat::default();
        for command in flown.iter().flatten() {
            retreat.note(&done(command));
        }
        retreat
    }

    fn done(command: &Command) -> Finished {
        Finished {
            command: command.clone(),
            outcome: CommandOutcome::Done,
        }
    }

    #[test]
    fn moves_are_undone_newest_first_and_once() {
        let mut retreat = retreat(&[turn(0.5), forward(60), left(30)]);
        let way = [right(30), back(60), turn(-0.5)].map(Option::unwrap);
        assert_eq!(retreat.take(), way);
        assert_eq!(retreat.take(), []);
    }

    #[test]
    fn every_move_and_its_undoing_lead_nowhere() {
        let to = Waypoint::from_cm(50, 0, -30).unwrap();
        let speed = Speed::from_cm_per_s(40).unwrap();
        let slanted = Some(Command::Go { to, speed });
        for command in [forward(40), back(40), left(40), right(40), up(40), slanted] {
            let command = command.unwrap();
            let back = undo(&command).unwrap();
            assert_eq!(displacement(&command), -displacement(&back));
            assert_eq!(undo(&back), Some(command));
        }
        assert_eq!(undo(&Command::Stop), None);
    }

    #[test]
    fn the_way_is_short_and_ends_where_the_place_was_not_known() {
        let long = [forward(50), left(50), forward(45), left(45)];
        assert_eq!(retreat(&long).take().len(), 3, "a fourth would go too far");
        let mut unsure = retreat(&long);
        unsure.note(&Finished {
            command: Command::Stop,
            outcome: CommandOutcome::Unknown,
        });
        unsure.note(&done(&forward(40).unwrap()));
        assert_eq!(unsure.take(), [back(40).unwrap()]);
        let mut scanned = retreat(&long);
        scanned.forget();
        assert_eq!(scanned.take(), []);
    }
}
