//! Take off and climb to the flying height.

use super::context::Context;
use super::event::Event;
use super::initialize::Initialize;
use super::maneuver::climb;
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::pilot::CommandOutcome;
use tello_sdk::{Command, Speed};

/// Height errors below this are left alone: the drone cannot move by less than 20 cm.
const HEIGHT_TOLERANCE_M: f64 = 0.2;

#[derive(Debug, Default)]
pub(super) struct TakeOff {
    state: State,
}

#[derive(Debug, Default)]
enum State {
    #[default]
    OnGround,
    EnteringSdk,
    SettingSpeed,
    TakingOff,
    Climbing,
}

impl TakeOff {
    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        match self.state {
            State::OnGround => {
                self.state = State::EnteringSdk;
                Step::Send(Command::EnterSdk)
            }
            State::EnteringSdk => {
                self.state = State::SettingSpeed;
                match Speed::from_cm_per_s(i64::from(context.config.speed_cm_per_s)) {
                    Ok(speed) => Step::Send(Command::SetSpeed(speed)),
                    Err(_) => Step::Wait,
                }
            }
            State::SettingSpeed => {
                self.state = State::TakingOff;
                Step::Send(Command::TakeOff)
            }
            State::TakingOff => self.taken_off(context),
            State::Climbing => Step::Become(Phase::Initialize(Initialize::default())),
        }
    }

    fn taken_off(&mut self, context: &mut Context<'_>) -> Step {
        // Unknown is not failed: the drone may well be in the air, so it is treated as flying.
        if let Some(CommandOutcome::Refused(answer)) = context.last_outcome().cloned() {
            context.set_outcome(Outcome::TakeOffRefused { answer });
            return Step::Finish;
        }
        context.log(Event::TookOff);
        self.state = State::Climbing;
        let height = context
            .knowledge
            .height_m()
            .unwrap_or(context.config.flight_height_m);
        let error = context.config.flight_height_m - height;
        if error.abs() < HEIGHT_TOLERANCE_M {
            return Step::Wait;
        }
        climb((error * 100.0).round() as i64).map_or(Step::Wait, Step::Send)
    }
}
