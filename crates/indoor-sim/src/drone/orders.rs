//! From a command to a manoeuvre, or to the drone's refusal.

use nalgebra::Vector3;
use tello_sdk::{Command, Refusal};

use super::maneuver::{Goal, Maneuver};
use super::profile::Profile;
use super::{Drone, Phase};
use crate::random::{normal, uniform};

/// What becomes of a command at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Order {
    /// A reply comes when the manoeuvre is over.
    Begun,
    /// Done, reply `ok` now.
    Done,
    /// Done, the drone never answers this one.
    Silent,
}

impl Drone {
    /// Begins what the command asks for.
    pub(crate) fn order(&mut self, command: &Command) -> Result<Order, Refusal> {
        match command {
            Command::EnterSdk | Command::StreamOn | Command::StreamOff => Ok(Order::Done),
            Command::SetSpeed(speed) => {
                self.speed = speed.meters_per_s();
                Ok(Order::Done)
            }
            Command::TakeOff => self.take_off(),
            Command::Land => self.airborne().map(|()| self.begin_landing()),
            Command::Emergency => {
                self.fall();
                Ok(Order::Silent)
            }
            Command::Stop => self.airborne().map(|()| self.brake()),
            Command::Rc {
                roll,
                pitch,
                throttle,
                yaw,
            } => {
                let part = |stick: tello_sdk::Stick| f64::from(stick.percent()) / 100.0;
                let velocity = Vector3::new(part(*pitch), -part(*roll), part(*throttle));
                self.set_sticks(velocity * self.config.stick_speed, -part(*yaw));
                Ok(Order::Silent)
            }
            Command::Clockwise(turn) => self.turn(-turn.radians()),
            Command::CounterClockwise(turn) => self.turn(turn.radians()),
            _ => {
                let (way, speed) = straight(command, self.speed).ok_or(Refusal::UnknownCommand)?;
                self.fly(way, speed)
            }
        }
    }

    fn airborne(&self) -> Result<(), Refusal> {
        if self.phase == Phase::Flying {
            Ok(())
        } else {
            Err(Refusal::MotorStop)
        }
    }

    /// In the air with the sticks at rest.
    fn ready(&self) -> Result<(), Refusal> {
        self.airborne()?;
        let held = |(velocity, turn): (Vector3<f64>, f64)| velocity.norm() > 0.0 || turn != 0.0;
        if self.sticks.is_some_and(held) {
            Err(Refusal::NotJoystick)
        } else {
            Ok(())
        }
    }

    fn take_off(&mut self) -> Result<Order, Refusal> {
        match self.phase {
            Phase::Crashed => return Err(Refusal::MotorStop),
            Phase::Flying => return Err(Refusal::Plain),
            Phase::Landed if self.charge.percent() < self.config.takeoff_percent => {
                return Err(Refusal::MotorStop);
            }
            Phase::Landed => {}
        }
        let (low, high) = self.config.takeoff_height;
        let height = uniform(&mut self.rng, low, high);
        self.height_offset = uniform(&mut self.rng, 0.10, 0.35);
        let way = Vector3::new(0.0, 0.0, (height - self.goal.position.z).max(0.05));
        let seconds = (self.config.takeoff_time
            - self.config.settle_time.min(self.config.takeoff_time))
        .as_secs_f64()
        .max(0.3);
        // Two ramps of half the time each: acceleration 4 l / t².
        let profile = Profile::new(way.z, 10.0, 4.0 * way.z / (seconds * seconds));
        self.phase = Phase::Flying;
        self.begin(Maneuver::Move {
            from: self.goal,
            way,
            turn: 0.0,
            profile,
            dead_time: 0.0,
        });
        Ok(Order::Begun)
    }

    /// A straight move, `way` in the body's frame (x forward, y left, z up), metres.
    fn fly(&mut self, way: Vector3<f64>, speed: f64) -> Result<Order, Refusal> {
        self.ready()?;
        let stretch = 1.0 + self.config.distance_error * normal(&mut self.rng);
        let aside = self.config.heading_error * normal(&mut self.rng);
        let heading = self.goal.yaw + aside;
        let turned = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), heading) * way;
        let mut way = turned * stretch.max(0.0);
        let lowest = self.config.lowest_hover.min(self.goal.position.z);
        way.z = way.z.max(lowest - self.goal.position.z);
        let profile = Profile::new(way.norm(), speed, self.config.acceleration);
        let dead_time = self.config.dead_time.as_secs_f64();
        self.begin(Maneuver::Move {
            from: self.goal,
            way,
            turn: 0.0,
            profile,
            dead_time,
        });
        Ok(Order::Begun)
    }

    /// A turn on the spot, counter-clockwise positive, rad.
    fn turn(&mut self, angle: f64) -> Result<Order, Refusal> {
        self.ready()?;
        let turn = angle + self.config.heading_error * normal(&mut self.rng);
        let profile = Profile::new(turn.abs(), self.config.yaw_rate, TURN_ACCELERATION);
        let dead_time = self.config.dead_time.as_secs_f64();
        let way = Vector3::zeros();
        self.begin(Maneuver::Move {
            from: self.goal,
            way,
            turn,
            profile,
            dead_time,
        });
        Ok(Order::Begun)
    }

    pub(crate) fn begin_landing(&mut self) -> Order {
        let floor = self.resting_height();
        let drop = (self.goal.position.z - floor).max(0.0);
        let usual = 0.5 * (self.config.takeoff_height.0 + self.config.takeoff_height.1);
        let seconds = self.config.landing_time.as_secs_f64() * (drop / usual).max(0.3);
        self.begin(Maneuver::Land {
            from: self.goal,
            floor,
            seconds,
        });
        Order::Begun
    }

    pub(crate) fn brake(&mut self) -> Order {
        let speed = self.velocity.norm().max(self.yaw_rate.abs() * 0.3);
        let seconds = (speed / BRAKING).min(0.5);
        let (velocity, yaw_rate) = (self.goal_velocity, self.yaw_rate);
        self.begin(Maneuver::Brake {
            from: self.goal,
            velocity,
            yaw_rate,
            seconds,
        });
        Order::Begun
    }

    /// Stops the motors: on the ground nothing, in the air a fall.
    pub(crate) fn fall(&mut self) {
        if self.phase == Phase::Flying {
            let floor = self.resting_height();
            self.phase = Phase::Crashed;
            let from = Goal {
                position: self.position(),
                yaw: self.goal.yaw,
            };
            self.begin(Maneuver::Fall { from, floor });
        }
    }

    fn set_sticks(&mut self, velocity: Vector3<f64>, turn: f64) {
        if self.phase == Phase::Flying {
            self.sticks = Some((velocity, turn * self.config.yaw_rate));
        }
    }
}

/// Angular acceleration of turns, rad/s². Stick response of the yaw: half within 0.1 s.
const TURN_ACCELERATION: f64 = 6.0;

/// Deceleration of `stop`, m/s².
const BRAKING: f64 = 2.5;

/// The way of a straight move in the body's frame, metres, and its speed, m/s; `None` for other commands.
fn straight(command: &Command, speed: f64) -> Option<(Vector3<f64>, f64)> {
    let way = match command {
        Command::Up(distance) => Vector3::z() * distance.meters(),
        Command::Down(distance) => -Vector3::z() * distance.meters(),
        Command::Left(distance) => Vector3::y() * distance.meters(),
        Command::Right(distance) => -Vector3::y() * distance.meters(),
        Command::Forward(distance) => Vector3::x() * distance.meters(),
        Command::Back(distance) => -Vector3::x() * distance.meters(),
        Command::Go { to, speed } => return Some((to.meters().into(), speed.meters_per_s())),
        _ => return None,
    };
    Some((way, speed))
}
