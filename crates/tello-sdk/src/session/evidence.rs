//! What the telemetry tells about a motion: motors turning, still or moving, how far since a given moment.

use super::event::Verdict;
use crate::command::Command;
use crate::telemetry::Telemetry;
use core::time::Duration;

/// Whether the motors turn, judged by the motor time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Motors {
    /// The motor time advances.
    Turning,
    /// The motor time has stood still for more than its resolution.
    Stopped,
    /// Not enough state lines yet, or none lately.
    Unknown,
}

/// The motor time has whole seconds, and the line with the new second may be lost (but not all lines for longer than
/// [`FRESH`]): standing still for longer than this means stopped.
const MOTOR_RESOLUTION: Duration = Duration::from_millis(2000);
/// How far an overtaken line's motor time may lie behind.
const OVERTAKEN: Duration = Duration::from_secs(5);
/// State lines come every 100 ms: older than this they say nothing about now.
const FRESH: Duration = Duration::from_millis(600);
/// One unit of the wire's velocity is 0.1 m/s: anything above half of it is movement.
const STILL_SPEED: f64 = 0.05;
/// Yaw has whole degrees and jitters by one.
const STILL_TURN_DEG: f64 = 2.0;

/// Sums over the state lines since the session's start.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Evidence {
    last: Option<Duration>,
    first: Option<Duration>,
    motor_time: Option<Duration>,
    motor_since: Duration,
    motor_advanced: Option<Duration>,
    still_since: Duration,
    yaw: Option<f64>,
    turned_deg: f64,
    path_m: f64,
    height_m: Option<f64>,
}

/// The sums at one moment.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Snapshot {
    at: Duration,
    turned_deg: f64,
    path_m: f64,
    height_m: Option<f64>,
}

impl Evidence {
    pub(super) fn observe(&mut self, at: Duration, sample: &Telemetry) {
        let elapsed = at
            .saturating_sub(self.last.unwrap_or(at))
            .min(FRESH)
            .as_secs_f64();
        if self.last.is_none_or(|last| at.saturating_sub(last) > FRESH) {
            // After a gap nothing is known about stillness or the motors.
            self.first = Some(at);
            self.still_since = at;
            self.motor_since = at;
        }
        self.last = Some(at);
        if let Some(time) = sample.motor_time {
            self.observe_motor_time(at, time.value);
        }
        if self.moved(elapsed, sample) {
            self.still_since = at;
        }
    }

    fn observe_motor_time(&mut self, at: Duration, time: Duration) {
        match self.motor_time {
            Some(old) if time == old => {}
            // A line that was overtaken by later ones; a larger step back is a drone that was switched off and on.
            Some(old) if time < old && old - time <= OVERTAKEN => {}
            old => {
                if old.is_some_and(|old| time > old) {
                    self.motor_advanced = Some(at);
                }
                self.motor_time = Some(time);
                self.motor_since = at;
            }
        }
    }

    fn moved(&mut self, elapsed: f64, sample: &Telemetry) -> bool {
        let mut moved = false;
        if let Some(velocity) = sample.velocity {
            let [x, y, z] = velocity.value.meters_per_s;
            let largest = x.abs().max(y.abs()).max(z.abs());
            moved |= largest > STILL_SPEED;
            // The largest component never overstates the path, and needs no square root.
            self.path_m += largest * elapsed;
        }
        if let Some(attitude) = sample.attitude {
            let yaw = attitude.value.yaw_deg;
            let turn = wrapped(yaw - self.yaw.unwrap_or(yaw));
            moved |= turn.abs() >= STILL_TURN_DEG;
            self.turned_deg += turn;
            self.yaw = Some(yaw);
        }
        if let Some(height) = sample.height_m {
            moved |= self
                .height_m
                .is_some_and(|old| (old - height.value).abs() > 0.05);
            self.height_m = Some(height.value);
        }
        moved
    }

    pub(super) fn snapshot(&self, now: Duration) -> Snapshot {
        Snapshot {
            at: now,
            turned_deg: self.turned_deg,
            path_m: self.path_m,
            height_m: self.height_m,
        }
    }

    pub(super) fn is_fresh(&self, now: Duration) -> bool {
        self.last
            .is_some_and(|last| now.saturating_sub(last) <= FRESH)
    }

    /// How long the drone has been still; `None` without fresh state lines.
    pub(super) fn still_for(&self, now: Duration) -> Option<Duration> {
        self.is_fresh(now)
            .then(|| now.saturating_sub(self.still_since))
    }

    pub(super) fn motors(&self, now: Duration) -> Motors {
        if !self.is_fresh(now) || self.motor_time.is_none() {
            return Motors::Unknown;
        }
        // Judged at the last line, not now: the time since then shows nothing.
        if self
            .last
            .is_some_and(|last| last.saturating_sub(self.motor_since) >= MOTOR_RESOLUTION)
        {
            return Motors::Stopped;
        }
        match (self.motor_advanced, self.first) {
            (Some(advanced), Some(first)) if advanced >= first => Motors::Turning,
            _ => Motors::Unknown,
        }
    }

    /// What became of a motion sent at `before`.
    pub(super) fn verdict(&self, command: &Command, before: &Snapshot, now: Duration) -> Verdict {
        let Some(still) = self.still_for(now) else {
            return Verdict::Unknown;
        };
        let motors = self.motors(now);
        if still < Duration::from_millis(500) {
            return Verdict::InProgress;
        }
        let climbed = match (self.height_m, before.height_m) {
            (Some(after), Some(start)) => Some(after - start),
            _ => None,
        };
        let turned = self.turned_deg - before.turned_deg;
        match command {
            Command::TakeOff | Command::ThrowFly => match motors {
                Motors::Turning if self.height_m.is_some_and(|h| h >= 0.2) => Verdict::Done,
                Motors::Turning => Verdict::InProgress,
                Motors::Stopped => Verdict::NotStarted,
                Motors::Unknown => Verdict::Unknown,
            },
            _ if motors == Motors::Stopped && self.motor_advanced < Some(before.at) => {
                Verdict::NotStarted
            }
            _ if motors == Motors::Stopped => Verdict::Unknown,
            Command::Up(distance) => part(climbed, distance.meters()),
            Command::Down(distance) => part(climbed.map(|c| -c), distance.meters()),
            Command::Clockwise(turn) => part(Some(turned), f64::from(turn.degrees())),
            Command::CounterClockwise(turn) => part(Some(-turned), f64::from(turn.degrees())),
            Command::Left(d) | Command::Right(d) | Command::Forward(d) | Command::Back(d) => {
                part(Some(self.path_m - before.path_m), d.meters())
            }
            Command::Go { to, .. } => {
                let longest = to.meters().iter().fold(0.0, |a: f64, c| a.max(c.abs()));
                part(Some(self.path_m - before.path_m), longest)
            }
            _ => Verdict::Unknown,
        }
    }
}

/// Most of the way is done, next to nothing is not started; between the two the telemetry is too coarse to tell.
fn part(done: Option<f64>, whole: f64) -> Verdict {
    match done {
        Some(done) if done >= 0.6 * whole => Verdict::Done,
        Some(done) if done.abs() <= 0.1 * whole => Verdict::NotStarted,
        _ => Verdict::Unknown,
    }
}

/// An angle difference in -180..=180 degrees.
fn wrapped(degrees: f64) -> f64 {
    let turned = degrees % 360.0;
    if turned > 180.0 {
        turned - 360.0
    } else if turned < -180.0 {
        turned + 360.0
    } else {
        turned
    }
}
