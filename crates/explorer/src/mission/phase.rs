//! The phases of a mission and what a phase can ask for.

use tello_sdk::Command;

use super::context::Context;
use super::fly::Fly;
use super::initialize::Initialize;
use super::landing::Landing;
use super::maneuver::Maneuver;
use super::recover::Recover;
use super::scan::Scan;
use super::take_off::TakeOff;
use super::think::Think;

/// What a phase wants next. Asked only while no command is in flight.
#[derive(Debug)]
pub(super) enum Step {
    /// Send this command and ask again when it has ended.
    Send(Command),
    /// Ask again after the next frame.
    Wait,
    /// Hand in the whole map, then ask again.
    NeedMap,
    /// Go on with another phase.
    Become(Phase),
    /// The mission is over.
    Finish,
}

/// Where in the mission we are (paper, section IV-C).
#[derive(Debug)]
pub(super) enum Phase {
    TakeOff(TakeOff),
    Initialize(Initialize),
    Scan(Scan),
    Triangle(Maneuver),
    Think(Think),
    Fly(Fly),
    Recover(Recover),
    Land(Landing),
}

impl Phase {
    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        match self {
            Self::TakeOff(phase) => phase.next(context),
            Self::Initialize(phase) => phase.next(context),
            Self::Scan(phase) => phase.next(context),
            Self::Triangle(maneuver) => match maneuver.next() {
                Some(command) => Step::Send(command),
                None => Step::Become(Self::Think(Think::after_scan())),
            },
            Self::Think(phase) => phase.next(context),
            Self::Fly(phase) => phase.next(context),
            Self::Recover(phase) => phase.next(context),
            Self::Land(phase) => phase.next(context),
        }
    }

    /// Whether a lost pose interrupts this phase. Scans turn on: the map comes back into view by itself.
    pub(super) fn needs_pose(&self) -> bool {
        matches!(self, Self::Triangle(_) | Self::Fly(_))
    }

    /// Whether the drone flies under the mission's will: the watch for battery and time applies.
    pub(super) fn is_airborne(&self) -> bool {
        !matches!(self, Self::TakeOff(_) | Self::Land(_))
    }
}
