//! The priority lane: land, stop, motoroff and emergency overtake everything and are repeated until confirmed.

use super::Session;
use super::event::{Event, Outcome, RequestId, Verdict};
use super::evidence::Motors;
use super::exchange::Probe;
use crate::command::{Command, ReplyShape};
use crate::reply::{Reply, ReplyKind};
use crate::safety::Alarm;
use core::time::Duration;

/// A command that is repeated until confirmed.
#[derive(Debug, Clone)]
pub(super) struct Urgent {
    id: Option<RequestId>,
    command: Command,
    started: Duration,
    pub(super) next: Duration,
    sent: u32,
    last_sent: Duration,
    /// Replies, without copies.
    answers: u32,
    last_answer: Option<Duration>,
    /// From when on no older `ok` can come, so that one that comes is the answer.
    clean_at: Duration,
}

/// Standing still for this long confirms a `stop`.
const STOPPED: Duration = Duration::from_millis(500);
/// The motor time's resolution and a little: a standstill older than a lift-off by less proves nothing.
pub(super) const MOTOR_LAG: Duration = Duration::from_millis(3000);

impl Session {
    /// Gives up what is in flight, drops what waits, centres the sticks and begins to repeat.
    pub(super) fn start_urgent(&mut self, id: Option<RequestId>, command: Command) {
        if let Some(running) = self.urgent.take() {
            if rank(&command) < rank(&running.command) {
                // A landing is not turned into a hover, an emergency not into a landing.
                self.urgent = Some(running);
                return self.finish(id, command, Outcome::NotSent);
            }
            self.end_urgent(
                running,
                Outcome::Unknown {
                    verdict: Verdict::Unknown,
                    attempts: 0,
                },
            );
        }
        let blocked = self.ledger.blocks(ReplyShape::Ok);
        let mut clean_at = self.now
            + if blocked {
                self.config.max_delay
            } else {
                Duration::ZERO
            };
        if let Some(exchange) = self.exchange.take() {
            if exchange.shape == ReplyShape::Ok {
                clean_at = clean_at.max(exchange.deadline + self.config.max_delay);
            }
            self.give_up(exchange);
        }
        while let Some(queued) = self.queue.pop_front() {
            self.finish(Some(queued.id), queued.command, Outcome::NotSent);
        }
        self.sticks.release(self.now);
        let (started, next) = (self.now, self.now);
        self.urgent = Some(Urgent {
            id,
            command,
            started,
            next,
            sent: 0,
            last_sent: started,
            answers: 0,
            last_answer: None,
            clean_at,
        });
    }

    /// Raises an alarm and lands, once.
    pub(super) fn raise(&mut self, alarm: Alarm) {
        if self.guard.raise(alarm) {
            self.land_on(alarm);
        }
    }

    pub(super) fn land_on(&mut self, alarm: Alarm) {
        self.emit(Event::Alarm(alarm));
        if self
            .urgent
            .as_ref()
            .is_none_or(|u| rank(&u.command) < rank(&Command::Land))
        {
            self.start_urgent(None, Command::Land);
        }
    }

    /// Sends, repeats, confirms by telemetry, or gives up.
    pub(super) fn step_urgent(&mut self) {
        let Some(mut urgent) = self.urgent.take() else {
            return;
        };
        if urgent.sent > 0 && self.is_confirmed(&urgent) {
            return self.end_urgent(urgent, Outcome::Confirmed);
        }
        if urgent.next <= self.now {
            let give_up = self.give_up_after(&urgent);
            if give_up.is_some_and(|limit| self.now.saturating_sub(urgent.started) >= limit) {
                let attempts = urgent.sent;
                let outcome = Outcome::Unknown {
                    verdict: Verdict::Unknown,
                    attempts,
                };
                return self.end_urgent(urgent, outcome);
            }
            self.send(&urgent.command);
            urgent.sent += 1;
            urgent.last_sent = self.now;
            let repeat = match urgent.command {
                Command::Emergency => self.config.emergency_repeat,
                _ => self.config.safety_repeat,
            };
            urgent.next = self.now + repeat;
        }
        self.urgent = Some(urgent);
    }

    /// A landing on an alarm is repeated until the motors stand, whatever the time.
    fn give_up_after(&self, urgent: &Urgent) -> Option<Duration> {
        match urgent.command {
            Command::Land if self.guard.latched().is_some() => None,
            Command::Land => Some(self.config.safety_give_up),
            _ => Some(self.config.stop_give_up),
        }
    }

    fn is_confirmed(&self, urgent: &Urgent) -> bool {
        if matches!(urgent.command, Command::Stop) {
            let still = self.evidence.still_for(self.now).unwrap_or_default();
            return self.now.saturating_sub(urgent.started) >= STOPPED && still >= STOPPED;
        }
        // A take-off that is still on its way, or that has not moved the motor time yet, looks like a standstill.
        !self.may_be_lifting_off() && self.evidence.motors(self.now) == Motors::Stopped
    }

    /// Whether a take-off may be on its way or begun without a sign in the motor time.
    pub(super) fn may_be_lifting_off(&self) -> bool {
        self.lift_off_until.is_some_and(|until| self.now < until)
    }

    fn end_urgent(&mut self, urgent: Urgent, outcome: Outcome) {
        let grounds = !matches!(urgent.command, Command::Stop);
        if grounds && matches!(outcome, Outcome::Confirmed | Outcome::Answered(_)) {
            self.guard.motors(self.now, Some(false));
            self.lift_off_until = None;
        }
        if urgent.sent > urgent.answers {
            let longest = self.config.motion_timeout + self.config.max_delay;
            self.ledger.owe(ReplyShape::Ok, urgent.last_sent + longest);
            self.resync = Some(Probe::at(self.now));
        }
        self.finish(urgent.id, urgent.command, outcome);
    }

    /// A reply while something urgent is repeated; true if it is taken.
    pub(super) fn reply_to_urgent(&mut self, reply: &Reply) -> bool {
        let Some(mut urgent) = self.urgent.take() else {
            return false;
        };
        if urgent.sent == 0 || !reply.fits(ReplyShape::Ok) {
            self.urgent = Some(urgent);
            return false;
        }
        let window = self.config.duplicate_window;
        if urgent
            .last_answer
            .is_none_or(|last| self.now.saturating_sub(last) > window)
        {
            urgent.answers += u32::from(urgent.clean_at <= self.now);
            urgent.last_answer = Some(self.now);
        }
        let telemetry_tells =
            self.evidence.is_fresh(self.now) && self.evidence.motors(self.now) != Motors::Unknown;
        let enough = match urgent.command {
            Command::Land | Command::MotorOff => !telemetry_tells,
            _ => true,
        };
        if urgent.clean_at <= self.now && enough && reply.kind == ReplyKind::Ok {
            self.counters.attributed += 1;
            let until = self.now + self.config.duplicate_window;
            self.ledger.expect_copy(ReplyShape::Ok, false, until);
            self.end_urgent(urgent, Outcome::Answered(reply.clone()));
        } else {
            self.urgent = Some(urgent);
        }
        true
    }
}

fn rank(command: &Command) -> u8 {
    match command {
        Command::Emergency => 3,
        Command::Land => 2,
        Command::MotorOff => 1,
        _ => 0,
    }
}
