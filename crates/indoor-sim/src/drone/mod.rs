//! The drone's body: where it is, what it is doing, and what it hits.

mod battery;
mod config;
mod maneuver;
mod orders;
mod profile;
mod wander;

pub use config::DroneConfig;

pub(crate) use maneuver::GRAVITY;
pub(crate) use orders::Order;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand_pcg::Pcg64;

use crate::random::{Purpose, stream};
use crate::world::{SolidKind, World};
use battery::Charge;
use maneuver::{Goal, Maneuver};
use wander::Wander;

/// Whether the drone flies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phase {
    /// On the ground, motors off, ready.
    Landed,
    /// In the air, taking off or landing.
    Flying,
    /// It hit something, or its motors were stopped in the air; it does not fly again.
    Crashed,
}

/// What a step brought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StepEvent {
    Nothing,
    /// The manoeuvre is over and the drone hovers or stands.
    Finished,
    /// The manoeuvre took longer than the drone allows.
    TimedOut,
    /// The body touched a solid.
    Collided {
        solid: usize,
    },
}

/// The drone's body and its controller.
#[derive(Debug, Clone)]
pub(crate) struct Drone {
    pub(crate) config: DroneConfig,
    pub(crate) phase: Phase,
    pub(crate) charge: Charge,
    /// Height that the `h` telemetry misses, metres.
    pub(crate) height_offset: f64,
    rng: Pcg64,
    speed: f64,
    goal: Goal,
    goal_velocity: Vector3<f64>,
    wander: Wander,
    velocity: Vector3<f64>,
    acceleration: Vector3<f64>,
    yaw_rate: f64,
    maneuver: Maneuver,
    elapsed: f64,
    sticks: Option<(Vector3<f64>, f64)>,
    ground: f64,
}

impl Drone {
    pub(crate) fn new(config: DroneConfig, world: &World, seed: u64) -> Self {
        let start = world.start();
        let position = Vector3::new(start.position[0], start.position[1], config.radius);
        Self {
            phase: Phase::Landed,
            charge: Charge::new(config.battery_percent),
            height_offset: 0.0,
            rng: stream(seed, Purpose::Motion),
            speed: config.speed,
            goal: Goal {
                position,
                yaw: start.yaw_degrees.to_radians(),
            },
            goal_velocity: Vector3::zeros(),
            wander: Wander::default(),
            velocity: Vector3::zeros(),
            acceleration: Vector3::zeros(),
            yaw_rate: 0.0,
            maneuver: Maneuver::None,
            elapsed: 0.0,
            sticks: None,
            ground: 0.0,
            config,
        }
    }

    pub(crate) fn position(&self) -> Vector3<f64> {
        self.goal.position + self.wander.offset()
    }

    pub(crate) fn yaw(&self) -> f64 {
        self.goal.yaw
    }

    pub(crate) fn velocity(&self) -> Vector3<f64> {
        self.velocity
    }

    pub(crate) fn acceleration(&self) -> Vector3<f64> {
        self.acceleration
    }

    pub(crate) fn yaw_rate(&self) -> f64 {
        self.yaw_rate
    }

    /// Commanded speed of straight moves, m/s.
    pub(crate) fn speed(&self) -> f64 {
        self.speed
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.maneuver != Maneuver::None
    }

    pub(crate) fn is_landing(&self) -> bool {
        matches!(self.maneuver, Maneuver::Land { .. })
    }

    /// Body to world: x forward, y left, z up. The body leans into its acceleration.
    pub(crate) fn world_from_body(&self) -> Isometry3<f64> {
        let heading = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.goal.yaw);
        let felt = heading.inverse() * self.acceleration;
        let lean = |value: f64| (value / GRAVITY).atan().clamp(-0.35, 0.35);
        let (pitch, roll) = if self.phase == Phase::Flying {
            (lean(felt.x), -lean(felt.y))
        } else {
            (0.0, 0.0)
        };
        let attitude = heading * UnitQuaternion::from_euler_angles(roll, pitch, 0.0);
        Isometry3::from_parts(Translation3::from(self.position()), attitude)
    }

    /// Height of the body's centre when it rests on what is underneath.
    fn resting_height(&self) -> f64 {
        self.ground + self.config.radius
    }

    fn begin(&mut self, maneuver: Maneuver) {
        self.maneuver = maneuver;
        self.elapsed = 0.0;
        self.sticks = None;
    }

    /// Goes on by `dt` seconds (small: the body moves straight within it).
    pub(crate) fn step(&mut self, dt: f64, world: &World) -> StepEvent {
        let before = self.position();
        let (old_goal, old_velocity) = (self.goal, self.velocity);
        self.ground = ground_below(world, before);
        self.elapsed += dt;
        self.follow(dt);
        if self.phase == Phase::Flying {
            let (deviation, time) = (self.config.hover_wander, self.config.wander_time);
            self.wander.step(dt, deviation, time, &mut self.rng);
        }
        let after = self.position();
        self.goal_velocity = (self.goal.position - old_goal.position) / dt;
        self.velocity = (after - before) / dt;
        let felt = (self.velocity - old_velocity) / dt;
        self.acceleration += (felt - self.acceleration) * (dt / 0.15).min(1.0);
        self.yaw_rate = (self.goal.yaw - old_goal.yaw) / dt;
        self.charge.drain(
            &self.config,
            dt,
            self.phase == Phase::Flying,
            self.velocity.norm(),
        );
        if self.phase == Phase::Flying
            && let Some(solid) = self.touched(world, before, after)
        {
            self.fall();
            return StepEvent::Collided { solid };
        }
        self.finish()
    }

    /// Moves the held point along the manoeuvre or after the sticks.
    fn follow(&mut self, dt: f64) {
        if let Some(goal) = self.maneuver.goal(self.elapsed) {
            self.goal = goal;
        } else if let Some((velocity, turn)) = self.sticks {
            let heading = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.goal.yaw);
            let gain = (dt / STICK_LAG).min(1.0);
            let mut wanted = heading * velocity;
            if self.goal.position.z <= self.config.lowest_hover {
                wanted.z = wanted.z.max(0.0);
            }
            self.goal_velocity += (wanted - self.goal_velocity) * gain;
            self.goal.position += self.goal_velocity * dt;
            self.goal.yaw += (self.yaw_rate + (turn - self.yaw_rate) * gain) * dt;
        }
    }

    /// The solid that the body touches on its way. Near the ground beneath it, standing on it is no collision.
    fn touched(&self, world: &World, before: Vector3<f64>, after: Vector3<f64>) -> Option<usize> {
        let landing = self.is_landing() || self.goal.position.z < self.config.lowest_hover;
        world.solids().iter().position(|solid| {
            let underneath = landing && solid.max[2] <= self.ground + 1e-6;
            !underneath && solid.segment_distance(before.into(), after.into()) < self.config.radius
        })
    }

    /// Ends a manoeuvre that is over.
    fn finish(&mut self) -> StepEvent {
        let settle = match self.maneuver {
            Maneuver::None => return StepEvent::Nothing,
            Maneuver::Move { .. } | Maneuver::Brake { .. } => self.config.settle_time.as_secs_f64(),
            Maneuver::Land { .. } | Maneuver::Fall { .. } => 0.0,
        };
        if self.elapsed + 1e-9 >= self.maneuver.duration() + settle {
            if self.is_landing() {
                self.phase = Phase::Landed;
                self.rest();
            } else if self.phase == Phase::Crashed {
                self.rest();
            }
            self.maneuver = Maneuver::None;
            return StepEvent::Finished;
        }
        let limit = self.config.move_limit.map(|limit| limit.as_secs_f64());
        if matches!(self.maneuver, Maneuver::Move { .. }) && limit.is_some_and(|s| self.elapsed > s)
        {
            self.brake();
            return StepEvent::TimedOut;
        }
        StepEvent::Nothing
    }

    fn rest(&mut self) {
        self.goal.position = self.position();
        self.goal.position.z = self.goal.position.z.max(self.resting_height());
        self.wander.rest();
        self.velocity = Vector3::zeros();
        self.goal_velocity = Vector3::zeros();
        self.acceleration = Vector3::zeros();
    }
}

/// Time constant of the velocity after a stick moves, seconds: half after 0.25 s.
const STICK_LAG: f64 = 0.35;

/// Height of the highest surface under a point, metres.
pub(crate) fn ground_below(world: &World, point: Vector3<f64>) -> f64 {
    world
        .solids()
        .iter()
        .filter(|solid| solid.kind != SolidKind::Ceiling && solid.max[2] <= point.z)
        .filter(|solid| (0..2).all(|a| solid.min[a] <= point[a] && point[a] <= solid.max[a]))
        .map(|solid| solid.max[2])
        .fold(0.0, f64::max)
}
