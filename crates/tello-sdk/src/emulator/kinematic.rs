//! A simple model of movement: straight lines at constant speed after a dead time, no inertia, no obstacles.
//!
//! Enough for protocol tests; a simulator replaces it through [`Physics`].

use super::config::Timing;
use super::physics::{Action, Physics, Progress, Truth};
use crate::reply::Refusal;
use crate::session::Sticks;
use core::time::Duration;

/// Hover height after a take-off, m.
const HOVER: f64 = 0.8;
/// Full stick: m/s and degrees per second.
const STICK_SPEED: f64 = 1.0;
const STICK_YAW_RATE: f64 = 90.0;

/// Moves a point and a heading.
#[derive(Debug, Clone)]
pub struct Kinematic {
    timing: Timing,
    now: Duration,
    truth: Truth,
    running: Option<Running>,
    ended: Option<Result<(), Refusal>>,
    sticks: Sticks,
}

#[derive(Debug, Clone, Copy)]
struct Running {
    action: Action,
    start: Duration,
    end: Duration,
    from: [f64; 3],
    from_yaw: f64,
    to: [f64; 3],
    to_yaw: f64,
}

impl Kinematic {
    /// A drone on the ground at the origin.
    #[must_use]
    pub fn new(timing: Timing) -> Self {
        let truth = Truth {
            acceleration: [0.0, 0.0, -9.8],
            ground_distance: 0.1,
            ..Truth::default()
        };
        Self {
            timing,
            now: Duration::ZERO,
            truth,
            running: None,
            ended: None,
            sticks: Sticks::CENTER,
        }
    }

    /// A body-frame vector in the frame at power-on.
    fn rotated(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        // Clockwise yaw turns the nose towards negative y.
        let (sin, cos) = (-self.truth.attitude_deg[2]).to_radians().sin_cos();
        [x * cos - y * sin, x * sin + y * cos, z]
    }

    fn plan(&self, action: Action) -> Running {
        let from = self.truth.position;
        let from_yaw = self.truth.attitude_deg[2];
        let (mut to, mut to_yaw) = (from, from_yaw);
        let timing = &self.timing;
        let (start, length) = match action {
            Action::TakeOff => {
                to[2] += HOVER;
                (self.now, timing.take_off)
            }
            Action::Land | Action::CutMotors => {
                to[2] = 0.0;
                (
                    self.now,
                    if action == Action::Land {
                        timing.land
                    } else {
                        Duration::ZERO
                    },
                )
            }
            Action::Move { offset, speed }
            | Action::Arc {
                to: offset, speed, ..
            } => {
                let moved = self.rotated(offset);
                to = [0, 1, 2].map(|i| from[i] + moved[i]);
                let length = moved.iter().map(|c| c * c).sum::<f64>().sqrt();
                (self.now + timing.dead_time, seconds(length / speed))
            }
            Action::Turn { degrees } => {
                to_yaw += degrees;
                (
                    self.now + timing.dead_time,
                    seconds(degrees.abs() / timing.yaw_rate),
                )
            }
            Action::Flip => (self.now + timing.dead_time, Duration::from_millis(800)),
            Action::Hover | Action::Idle(_) => (self.now, Duration::ZERO),
        };
        Running {
            action,
            start,
            end: start + length,
            from,
            from_yaw,
            to,
            to_yaw,
        }
    }

    fn follow(&mut self, running: Running, now: Duration) {
        let whole = running.end.saturating_sub(running.start).as_secs_f64();
        let part = if now >= running.end {
            1.0
        } else {
            now.saturating_sub(running.start).as_secs_f64() / whole.max(1e-9)
        };
        let mix = |from: f64, to: f64| from + (to - from) * part;
        let moving = now >= running.start && now < running.end;
        let rate = if moving && whole > 0.0 {
            1.0 / whole
        } else {
            0.0
        };
        let way = [0, 1, 2].map(|i| running.to[i] - running.from[i]);
        self.truth.position = [0, 1, 2].map(|i| mix(running.from[i], running.to[i]));
        self.truth.velocity = way.map(|c| c * rate);
        self.truth.attitude_deg[2] = wrapped(mix(running.from_yaw, running.to_yaw));
        if now >= running.end {
            if matches!(running.action, Action::Land | Action::CutMotors) {
                self.truth.motors = false;
            }
            self.truth.attitude_deg[2] = wrapped(running.to_yaw);
            self.running = None;
            self.ended = Some(Ok(()));
        }
    }

    fn drift(&mut self, elapsed: f64) {
        if !self.truth.motors || self.truth.height <= 0.0 {
            self.truth.velocity = [0.0; 3];
            return;
        }
        let stick = |s: crate::units::Stick, full: f64| f64::from(s.percent()) / 100.0 * full;
        let body = [
            stick(self.sticks.pitch, STICK_SPEED),
            -stick(self.sticks.roll, STICK_SPEED),
            stick(self.sticks.throttle, STICK_SPEED),
        ];
        self.truth.velocity = body;
        let moved = self.rotated(body);
        for (position, speed) in self.truth.position.iter_mut().zip(moved) {
            *position += speed * elapsed;
        }
        self.truth.position[2] = self.truth.position[2].max(0.3);
        let yaw = self.truth.attitude_deg[2] + stick(self.sticks.yaw, STICK_YAW_RATE) * elapsed;
        self.truth.attitude_deg[2] = wrapped(yaw);
    }
}

impl Physics for Kinematic {
    fn begin(&mut self, now: Duration, action: Action) -> Result<(), Refusal> {
        self.advance(now);
        self.ended = None;
        let flying = self.truth.motors && self.truth.height > 0.0;
        match action {
            Action::TakeOff if flying => return Err(Refusal::Plain),
            Action::TakeOff => self.truth.motors = true,
            Action::Idle(on) if !flying => self.truth.motors = on,
            Action::CutMotors => {}
            Action::Land if self.truth.motors => {}
            Action::Land => return Err(Refusal::Plain),
            _ if !flying => return Err(Refusal::MotorStop),
            _ => {}
        }
        self.sticks = Sticks::CENTER;
        self.running = Some(self.plan(action));
        self.advance(now);
        Ok(())
    }

    fn set_sticks(&mut self, now: Duration, sticks: Sticks) {
        self.advance(now);
        self.sticks = sticks;
    }

    fn advance(&mut self, now: Duration) {
        let elapsed = now.saturating_sub(self.now).as_secs_f64();
        self.now = self.now.max(now);
        match self.running {
            Some(running) => self.follow(running, self.now),
            None => self.drift(elapsed),
        }
        self.truth.height = self.truth.position[2];
        self.truth.ground_distance = self.truth.height.max(0.1);
    }

    fn progress(&mut self) -> Progress {
        match (self.ended.take(), self.running) {
            (Some(end), _) => Progress::Ended(end),
            (None, Some(_)) => Progress::Running,
            (None, None) => Progress::Idle,
        }
    }

    fn truth(&self) -> Truth {
        self.truth
    }
}

fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::from_secs(3600))
}

fn wrapped(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}
