//! The one command in flight: sending, timeouts, the probe of a silent motion, and the fence afterwards.

use super::Session;
use super::event::{Outcome, RequestId, Verdict};
use super::evidence::Snapshot;
use super::priority::MOTOR_LAG;
use crate::command::{Class, Command, Query, ReplyShape};
use core::time::Duration;

/// The query whose reply looks unlike that of any command that moves the drone.
pub(super) const FENCE: Command = Command::Query(Query::Battery);

#[derive(Debug, Clone)]
pub(super) struct Queued {
    pub(super) id: RequestId,
    pub(super) command: Command,
    pub(super) since: Duration,
}

/// A fence: the query is sent until answered.
#[derive(Debug, Clone, Copy)]
pub(super) struct Probe {
    pub(super) next: Duration,
    pub(super) sent: u32,
    pub(super) answered: Option<Duration>,
}

impl Probe {
    pub(super) fn at(next: Duration) -> Self {
        Self {
            next,
            sent: 0,
            answered: None,
        }
    }

    pub(super) fn waits(&self) -> bool {
        self.sent > 0 && self.answered.is_none()
    }
}

#[derive(Debug, Clone)]
pub(super) struct Exchange {
    /// `None` for the session's own keep-alive.
    pub(super) id: Option<RequestId>,
    pub(super) command: Command,
    pub(super) shape: ReplyShape,
    pub(super) attempts: u32,
    pub(super) deadline: Duration,
    pub(super) probe: Option<Probe>,
    pub(super) before: Snapshot,
}

impl Session {
    /// Sends a command for the first time.
    pub(super) fn start(&mut self, id: Option<RequestId>, command: Command) {
        let shape = command.reply_shape();
        let before = self.evidence.snapshot(self.now);
        self.send(&command);
        if matches!(command, Command::TakeOff | Command::ThrowFly) {
            self.lift_off_until = Some(self.now + self.config.max_delay + MOTOR_LAG);
            self.guard.motors(self.now, Some(true));
        }
        if shape == ReplyShape::Silent {
            let outcome = Outcome::Unknown {
                verdict: Verdict::Unknown,
                attempts: 1,
            };
            return self.finish(id, command, outcome);
        }
        let deadline = self.now + self.config.timeout(&command);
        let probe = (command.class() == Class::Motion)
            .then(|| Probe::at(self.now + self.config.probe_after));
        self.exchange = Some(Exchange {
            id,
            command,
            shape,
            attempts: 1,
            deadline,
            probe,
            before,
        });
    }

    /// Timeouts of the command in flight.
    pub(super) fn step_exchange(&mut self) {
        let Some(mut exchange) = self.exchange.take() else {
            return;
        };
        if exchange.probe.is_some() && self.step_motion(&mut exchange) {
            return;
        }
        if exchange.deadline > self.now {
            self.exchange = Some(exchange);
            return;
        }
        if exchange.attempts < self.config.allowed_attempts(&exchange.command) {
            self.send(&exchange.command);
            exchange.attempts += 1;
            exchange.deadline = self.now + self.config.timeout(&exchange.command);
            self.exchange = Some(exchange);
            return;
        }
        self.give_up(exchange);
    }

    /// Probes a silent motion; true if it was judged.
    fn step_motion(&mut self, exchange: &mut Exchange) -> bool {
        let Some(mut probe) = exchange.probe else {
            return false;
        };
        if let Some(answered) = probe.answered {
            let settle = self.config.settle;
            let waited = self.now.saturating_sub(answered) >= settle;
            let still = self
                .evidence
                .still_for(self.now)
                .is_some_and(|still| still >= settle);
            if waited && still {
                self.give_up(exchange.clone());
                return true;
            }
        } else if probe.next <= self.now {
            self.send_probe(&mut probe);
        }
        exchange.probe = Some(probe);
        false
    }

    /// Ends a command without a reply.
    pub(super) fn give_up(&mut self, exchange: Exchange) {
        let verdict = if exchange.command.class() == Class::Motion {
            self.evidence
                .verdict(&exchange.command, &exchange.before, self.now)
        } else {
            Verdict::Unknown
        };
        // A motion that is judged early may still be answered: the drone itself gives up after about 15 s only.
        let until = self.now.max(exchange.deadline) + self.config.max_delay;
        self.ledger.owe(exchange.shape, until);
        self.owe_probe(exchange.probe);
        if exchange.shape == ReplyShape::Ok {
            self.resync = Some(Probe::at(self.now));
        }
        let outcome = Outcome::Unknown {
            verdict,
            attempts: exchange.attempts,
        };
        self.finish(exchange.id, exchange.command, outcome);
    }

    /// The replies to unanswered probes may still come.
    pub(super) fn owe_probe(&mut self, probe: Option<Probe>) {
        if probe.is_some_and(|probe| probe.waits()) {
            self.ledger
                .owe(ReplyShape::Number, self.now + self.config.max_delay);
        }
    }

    /// Sends a fence, unless an old number could be taken for its answer.
    fn send_probe(&mut self, probe: &mut Probe) {
        if !probe.waits() && self.ledger.blocks(ReplyShape::Number) {
            return;
        }
        self.send(&FENCE);
        probe.sent += 1;
        probe.next = self.now + self.config.probe_interval;
    }

    /// After a command without a reply: asks until the drone answers.
    pub(super) fn step_resync(&mut self) {
        if self.exchange.is_some() || self.urgent.is_some() {
            return;
        }
        let Some(mut probe) = self.resync else { return };
        if probe.next <= self.now {
            self.send_probe(&mut probe);
        }
        self.resync = Some(probe);
    }

    /// Sends the next waiting command if its reply could not be mistaken.
    pub(super) fn start_next(&mut self) {
        self.drop_overdue();
        while self.exchange.is_none() && self.urgent.is_none() {
            let Some(front) = self.queue.front() else {
                break;
            };
            let shape = front.command.reply_shape();
            let is_motion = front.command.class() == Class::Motion;
            if self.ledger.blocks(shape)
                || (shape == ReplyShape::Ok && self.resync.is_some())
                || (shape == ReplyShape::Number && self.resync.is_some_and(|probe| probe.waits()))
                || (is_motion && self.sticks.in_use())
            {
                break;
            }
            if let Some(queued) = self.queue.pop_front() {
                self.start(Some(queued.id), queued.command);
            }
        }
    }

    fn drop_overdue(&mut self) {
        while self
            .queue
            .front()
            .is_some_and(|q| q.since + self.config.queue_timeout <= self.now)
        {
            if let Some(queued) = self.queue.pop_front() {
                self.finish(Some(queued.id), queued.command, Outcome::NotSent);
            }
        }
    }

    /// Something to say in a long silence.
    pub(super) fn step_keep_alive(&mut self) {
        let Some(due) = self.keep_alive_due() else {
            return;
        };
        if due <= self.now && !self.ledger.blocks(ReplyShape::Number) {
            self.start(None, FENCE);
        }
    }

    pub(super) fn keep_alive_due(&self) -> Option<Duration> {
        let due = self.last_sent? + self.config.keep_alive?;
        let busy = self.exchange.is_some() || self.urgent.is_some() || self.resync.is_some();
        let beats = self
            .config
            .heartbeat
            .is_none_or(|limit| self.last_beat + limit > self.now);
        (!busy && beats).then_some(due)
    }
}
