//! A fixed list of commands, flown one after the other.

use std::collections::VecDeque;

use tello_sdk::{Command, Distance, Turn};

/// The commands still to be flown.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Maneuver {
    commands: VecDeque<Command>,
}

impl Maneuver {
    pub(super) fn next(&mut self) -> Option<Command> {
        self.commands.pop_front()
    }

    pub(super) fn push(&mut self, command: Option<Command>) {
        self.commands.extend(command);
    }

    /// The paper's triangle (section IV-C): three legs in one plane, back where it began. `side_cm` within 20..=500.
    pub(super) fn triangle(side_cm: i64) -> Self {
        // Left, forward right, back: a right triangle flown by its two legs and their return, since single-axis moves have
        // no doubtful sign on any firmware.
        let mut maneuver = Self::default();
        maneuver.push(left(side_cm));
        maneuver.push(forward(side_cm));
        maneuver.push(right(side_cm));
        maneuver.push(back(side_cm));
        maneuver
    }
}

/// A turn by `radians`, counterclockwise positive, rounded to a degree; `None` under half a degree.
pub(super) fn turn(radians: f64) -> Option<Command> {
    let degrees = radians.to_degrees().round();
    if !degrees.is_finite() {
        return None;
    }
    let size = Turn::from_degrees(degrees.abs() as i64).ok()?;
    Some(if degrees > 0.0 {
        Command::CounterClockwise(size)
    } else {
        Command::Clockwise(size)
    })
}

pub(super) fn up(cm: i64) -> Option<Command> {
    Distance::from_cm(cm).ok().map(Command::Up)
}

pub(super) fn down(cm: i64) -> Option<Command> {
    Distance::from_cm(cm).ok().map(Command::Down)
}

pub(super) fn left(cm: i64) -> Option<Command> {
    Distance::from_cm(cm).ok().map(Command::Left)
}

pub(super) fn right(cm: i64) -> Option<Command> {
    Distance::from_cm(cm).ok().map(Command::Right)
}

pub(super) fn forward(cm: i64) -> Option<Command> {
    Distance::from_cm(cm).ok().map(Command::Forward)
}

pub(super) fn back(cm: i64) -> Option<Command> {
    Distance::from_cm(cm).ok().map(Command::Back)
}

/// Up for a positive climb, down for a negative one; `None` under 20 cm, which the drone cannot fly.
pub(super) fn climb(cm: i64) -> Option<Command> {
    if cm > 0 { up(cm) } else { down(-cm) }
}
