//! One command at a time: sends it, waits for the answer, lets the drone settle, and measures what the move did.

use core::time::Duration;

use nalgebra::{Point3, Vector3};
use tello_sdk::{Command, Distance};

use super::knowledge::Knowledge;
use super::retreat::undo;

/// How a command ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CommandOutcome {
    /// The drone said that it did it.
    Done,
    /// The drone refused, in its own words.
    Refused(String),
    /// No answer in time: it may or may not have been done.
    Unknown,
}

/// Time that SLAM needs after a move until its pose counts: frames come at about 10 Hz.
const SETTLE: Duration = Duration::from_millis(300);

/// Time from a command to the first movement, seconds (0.3 to 0.4 were seen).
const REACTION_S: f64 = 0.35;
/// Speed that a leg is taken to be flown with, metres per second: rather too slow, so that a retreat stays on the leg.
const CRUISE_M_PER_S: f64 = 0.35;

/// A command that has ended and settled.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Finished {
    pub(super) command: Command,
    pub(super) outcome: CommandOutcome,
}

#[derive(Debug, Clone, PartialEq)]
enum State {
    Idle,
    InFlight(Flight),
    Settling {
        flight: Flight,
        outcome: CommandOutcome,
        until: Duration,
    },
}

#[derive(Debug, Clone, PartialEq)]
struct Flight {
    command: Command,
    since: Duration,
    deadline: Duration,
    /// Epoch and position when the command left, if tracked.
    before: Option<(u64, Point3<f64>)>,
    /// A stop was sent meanwhile: the length flown is not the length commanded.
    interrupted: bool,
}

/// What undoes the last move.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Undo {
    /// No move is in flight or settles.
    Nothing,
    /// The move has just been done; this undoes it.
    Done(Command),
    /// A turn is in flight and runs to its end; this undoes it then.
    Turning(Command),
    /// This undoes at most what was flown of it, and rather less; `None` where nothing is known to.
    Part(Option<Command>),
}

/// Keeps the one command in flight.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pilot {
    state: State,
}

impl Pilot {
    pub(super) fn new() -> Self {
        Self { state: State::Idle }
    }

    pub(super) fn is_idle(&self) -> bool {
        self.state == State::Idle
    }

    /// Whether the drone is on its way along a straight move right now.
    pub(super) fn is_moving(&self) -> bool {
        match &self.state {
            State::InFlight(flight) => {
                !flight.interrupted && displacement(&flight.command).norm() > 0.0
            }
            State::Idle | State::Settling { .. } => false,
        }
    }

    /// Takes charge of `command`, which the caller sends now.
    pub(super) fn start(&mut self, command: Command, knowledge: &Knowledge) {
        let since = knowledge.now();
        let deadline = since + time_limit(&command);
        let before = knowledge.tracked_position();
        self.state = State::InFlight(Flight {
            command,
            since,
            deadline,
            before,
            interrupted: false,
        });
    }

    /// Marks the move in flight as cut short by a stop.
    pub(super) fn interrupt(&mut self) {
        if let State::InFlight(flight) = &mut self.state {
            flight.interrupted = true;
        }
    }

    /// What undoes the move in flight, or the one that has just ended and settles.
    pub(super) fn undo_last(&self, now: Duration) -> Undo {
        let flight = match &self.state {
            State::Idle => return Undo::Nothing,
            State::InFlight(flight) => flight,
            State::Settling {
                flight, outcome, ..
            } => {
                let whole = *outcome == CommandOutcome::Done && !flight.interrupted;
                return match undo(&flight.command) {
                    Some(command) if whole => Undo::Done(command),
                    _ => Undo::Part(None),
                };
            }
        };
        // Turns are not stopped.
        if let Command::Clockwise(_) | Command::CounterClockwise(_) = flight.command {
            return undo(&flight.command).map_or(Undo::Nothing, Undo::Turning);
        }
        let seconds = now.saturating_sub(flight.since).as_secs_f64();
        let cruised = (CRUISE_M_PER_S * (seconds - REACTION_S)).max(0.0);
        let flown = |leg: Distance| Distance::from_meters(cruised.min(leg.meters())).ok();
        Undo::Part(match flight.command {
            Command::Forward(leg) => flown(leg).map(Command::Back),
            Command::Back(leg) => flown(leg).map(Command::Forward),
            Command::Left(leg) => flown(leg).map(Command::Right),
            Command::Right(leg) => flown(leg).map(Command::Left),
            _ => None,
        })
    }

    /// Forgets the command in flight: something more urgent goes out.
    pub(super) fn abandon(&mut self) {
        self.state = State::Idle;
    }

    /// The drone's answer to a command: it counts if that is in flight, or if it is the stop that cut it short.
    pub(super) fn answer(&mut self, to: &Command, outcome: CommandOutcome, now: Duration) {
        let State::InFlight(flight) = &self.state else {
            return;
        };
        if *to == flight.command || (flight.interrupted && *to == Command::Stop) {
            self.state = State::Settling {
                flight: flight.clone(),
                outcome,
                until: now + SETTLE,
            };
        }
    }

    /// Lets time pass; hands out the command once it has ended and settled, after adding its move to the calibration.
    pub(super) fn tick(&mut self, knowledge: &mut Knowledge) -> Option<Finished> {
        let now = knowledge.now();
        match &self.state {
            State::InFlight(flight) if now >= flight.deadline => {
                self.state = State::Settling {
                    flight: flight.clone(),
                    outcome: CommandOutcome::Unknown,
                    until: now + SETTLE,
                };
                None
            }
            State::Settling {
                flight,
                outcome,
                until,
            } if now >= *until => {
                let finished = Finished {
                    command: flight.command.clone(),
                    outcome: outcome.clone(),
                };
                if finished.outcome == CommandOutcome::Done && !flight.interrupted {
                    measure(flight, knowledge);
                }
                self.state = State::Idle;
                Some(finished)
            }
            State::Idle | State::InFlight(_) | State::Settling { .. } => None,
        }
    }
}

/// Compares what was commanded with what the map saw, if both ends were tracked in one epoch.
fn measure(flight: &Flight, knowledge: &mut Knowledge) {
    let (Some((epoch, before)), Some((now_epoch, after))) =
        (flight.before, knowledge.tracked_position())
    else {
        return;
    };
    if epoch == now_epoch {
        knowledge.calibrate(displacement(&flight.command), after - before);
    }
}

/// The commanded displacement (forward, left, up) in metres; zero for everything that does not translate.
pub(super) fn displacement(command: &Command) -> Vector3<f64> {
    match *command {
        Command::Up(d) => Vector3::new(0.0, 0.0, d.meters()),
        Command::Down(d) => Vector3::new(0.0, 0.0, -d.meters()),
        Command::Left(d) => Vector3::new(0.0, d.meters(), 0.0),
        Command::Right(d) => Vector3::new(0.0, -d.meters(), 0.0),
        Command::Forward(d) => Vector3::new(d.meters(), 0.0, 0.0),
        Command::Back(d) => Vector3::new(-d.meters(), 0.0, 0.0),
        Command::Go { to, .. } => Vector3::from(to.meters()),
        _ => Vector3::zeros(),
    }
}

/// Longest wait for an answer; take-offs were seen to take up to 20 s, the drone itself gives up a move after about 15 s.
fn time_limit(command: &Command) -> Duration {
    match command {
        Command::TakeOff | Command::Land => Duration::from_secs(20),
        _ => Duration::from_secs(16),
    }
}

#[cfg(test)]
mod tests {
    use super::super::maneuver::{back, forward, turn};
    use super::*;
    use tello_sdk::{Source, Telemetry};

    fn at(millis: u64) -> Knowledge {
        let now = Duration::from_millis(millis);
        let mut knowledge = Knowledge::default();
        knowledge.observe(
            now,
            &Telemetry::builder(now, Source::Simulated).build(),
            None,
        );
        knowledge
    }

    /// What undoes `command`, which was sent at once and is answered after `answered` milliseconds if at all, `millis` after that.
    fn undone(command: Option<Command>, answered: Option<u64>, millis: u64) -> Undo {
        let mut pilot = Pilot::new();
        let command = command.unwrap();
        pilot.start(command.clone(), &at(0));
        if let Some(answered) = answered {
            let at = Duration::from_millis(answered);
            pilot.answer(&command, CommandOutcome::Done, at);
        }
        pilot.undo_last(Duration::from_millis(millis))
    }

    #[test]
    fn of_a_move_in_flight_only_what_was_flown_is_undone() {
        assert_eq!(undone(forward(100), None, 300), Undo::Part(None));
        let Undo::Part(Some(Command::Back(part))) = undone(forward(100), None, 2350) else {
            panic!("no way back")
        };
        assert!((part.meters() - 0.7).abs() < 0.011, "{part:?}");
        assert_eq!(undone(forward(40), None, 9000), Undo::Part(back(40)));
        // A turn runs to its end.
        assert_eq!(
            undone(turn(0.5), None, 10),
            Undo::Turning(turn(-0.5).unwrap())
        );
    }

    #[test]
    fn only_an_answer_to_the_command_in_flight_ends_it() {
        let leg = forward(100).unwrap();
        let is_ended_by = |to: &Command, interrupted: bool| {
            let mut pilot = Pilot::new();
            pilot.start(leg.clone(), &at(0));
            if interrupted {
                pilot.interrupt();
            }
            pilot.answer(to, CommandOutcome::Done, Duration::from_millis(500));
            matches!(pilot.state, State::Settling { .. })
        };
        for interrupted in [false, true] {
            assert!(is_ended_by(&leg, interrupted));
            assert!(!is_ended_by(&back(100).unwrap(), interrupted));
        }
        assert!(!is_ended_by(&Command::Stop, false));
        assert!(is_ended_by(&Command::Stop, true));
    }

    #[test]
    fn a_move_that_has_just_ended_is_undone_whole() {
        assert_eq!(
            undone(forward(100), Some(2000), 2100),
            Undo::Done(back(100).unwrap())
        );
        assert_eq!(Pilot::new().undo_last(Duration::ZERO), Undo::Nothing);
    }
}
