//! The simulated drone as the body of an emulated one: `tello_sdk`'s emulator speaks the protocol, this flies.
//!
//! With it, anything that speaks to a Tello over UDP flies in a simulated world, in real time. Curves, flips and idling
//! motors are refused, as the simulation does not know them. Silence is watched by the emulator, not here.

use core::time::Duration;

use nalgebra::Vector3;
use tello_sdk::emulator::{Action, Physics, Progress, Truth};
use tello_sdk::{Command, Query, Refusal, ReplyKind, Speed, Sticks, Turn, Waypoint};

use crate::Simulator;

impl Physics for Simulator {
    fn begin(&mut self, now: Duration, action: Action) -> Result<(), Refusal> {
        Physics::advance(self, now);
        let command = command(action).ok_or(Refusal::Plain)?;
        // What is interrupted has nothing more to say.
        while self.poll_reply().is_some() {}
        self.send(&command).map_err(|refused| refused.refusal)
    }

    fn set_sticks(&mut self, now: Duration, sticks: Sticks) {
        Physics::advance(self, now);
        // On the ground they do nothing.
        let _ = self.send(&sticks.command());
    }

    fn advance(&mut self, now: Duration) {
        let ahead = now.saturating_sub(self.time());
        Self::advance(self, ahead);
        if self.silence() >= Duration::from_secs(5) {
            // The simulation must not land for a silence that the emulator knows better about.
            let _ = self.send(&Command::Query(Query::Battery));
        }
    }

    fn progress(&mut self) -> Progress {
        while let Some(reply) = self.poll_reply() {
            if let Some(refusal) = reply.refusal() {
                return Progress::Ended(Err(refusal));
            } else if reply.kind == ReplyKind::Ok {
                return Progress::Ended(Ok(()));
            }
        }
        match self.is_busy() {
            true => Progress::Running,
            false => Progress::Idle,
        }
    }

    fn truth(&self) -> Truth {
        let telemetry = self.telemetry();
        let start = self.start_pose();
        let position = start.inverse_transform_point(&self.pose().translation.vector.into());
        let attitude = telemetry.attitude.map_or(Vector3::zeros(), |reading| {
            let angles = reading.value;
            Vector3::new(angles.pitch_deg, angles.roll_deg, angles.yaw_deg)
        });
        Truth {
            attitude_deg: attitude.into(),
            velocity: telemetry
                .velocity
                .map_or([0.0; 3], |reading| reading.value.meters_per_s),
            position: position.into(),
            height: position.z.max(0.0),
            ground_distance: telemetry.tof_m.map_or(0.1, |reading| reading.value),
            acceleration: telemetry
                .acceleration
                .map_or([0.0; 3], |reading| reading.value),
            motors: self.is_flying(),
        }
    }
}

/// The command that does what an action asks for; `None` if there is none here.
fn command(action: Action) -> Option<Command> {
    let cm = |meters: f64| (meters * 100.0).round() as i64;
    Some(match action {
        Action::TakeOff => Command::TakeOff,
        Action::Land => Command::Land,
        Action::Hover => Command::Stop,
        Action::CutMotors => Command::Emergency,
        Action::Move { offset, speed } => {
            let [x, y, z] = offset.map(cm);
            Command::Go {
                to: Waypoint::from_cm(x, y, z).ok()?,
                speed: Speed::from_cm_per_s(cm(speed)).ok()?,
            }
        }
        Action::Turn { degrees } => {
            let turn = Turn::from_degrees(degrees.abs().round() as i64).ok()?;
            match degrees > 0.0 {
                true => Command::Clockwise(turn),
                false => Command::CounterClockwise(turn),
            }
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use core::net::SocketAddr;

    use tello_sdk::emulator::{Channel, Emulator, EmulatorConfig};

    use super::*;
    use crate::{SimConfig, World};

    /// Says something and waits for the answer, in virtual time.
    fn ask(drone: &mut Emulator<Simulator>, now: &mut Duration, text: &str) -> String {
        let client = SocketAddr::from(([127, 0, 0, 1], 9000));
        drone.receive(*now, client, text.as_bytes());
        for _ in 0..100_000 {
            while let Some(transmit) = drone.poll(*now) {
                if transmit.channel == Channel::Reply {
                    return String::from_utf8(transmit.bytes).unwrap().trim().to_owned();
                }
            }
            *now = drone.next_deadline();
        }
        panic!("`{text}` was not answered");
    }

    #[test]
    fn the_protocol_flies_the_simulated_drone() {
        let world = World::named("one-door-room", 1).unwrap();
        let simulator = Simulator::new(world, SimConfig::exact(), 1).unwrap();
        let mut drone = Emulator::new(EmulatorConfig::default(), simulator);
        let mut now = Duration::ZERO;
        let mut say = |drone: &mut Emulator<Simulator>, text: &str| ask(drone, &mut now, text);
        assert_eq!(say(&mut drone, "command"), "ok");
        assert_eq!(say(&mut drone, "forward 30"), "error Motor stop");
        assert_eq!(say(&mut drone, "takeoff"), "ok");
        let before = Physics::truth(drone.physics());
        assert!(before.motors && before.height > 0.5, "{before:?}");
        assert_eq!(say(&mut drone, "forward 50"), "ok");
        let after = Physics::truth(drone.physics());
        assert!(
            (after.position[0] - before.position[0] - 0.5).abs() < 0.03,
            "{after:?}"
        );
        assert_eq!(say(&mut drone, "cw 90"), "ok");
        assert!((Physics::truth(drone.physics()).attitude_deg[2] - 90.0).abs() < 2.0);
        assert_eq!(say(&mut drone, "flip l"), "error");
        assert_eq!(say(&mut drone, "land"), "ok");
        assert!(!drone.is_flying());
        assert!(drone.physics().truth().collisions.is_empty());
    }
}
