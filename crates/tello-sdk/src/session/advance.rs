//! One step of everything that depends on time, and when the next one is due.

use super::Session;
use super::event::Event;
use super::evidence::Motors;
use crate::safety::Alarm;
use core::time::Duration;

impl Session {
    /// Does what is due at `self.now`.
    pub(super) fn advance(&mut self) {
        self.ledger.expire(self.now);
        self.step_guard();
        self.step_link();
        self.step_urgent();
        self.step_exchange();
        self.step_sticks();
        self.start_next();
        self.step_resync();
        self.step_keep_alive();
    }

    /// The next time at which something is due without input; later than now.
    pub(super) fn deadline(&self) -> Duration {
        let config = &self.config;
        let exchange = self.exchange.as_ref().map(|exchange| {
            let probe = exchange.probe.map(|probe| match probe.answered {
                Some(answered) => answered + config.settle,
                None => probe.next,
            });
            // What has passed waits for a state line.
            probe
                .filter(|&at| at > self.now)
                .map_or(exchange.deadline, |at| at.min(exchange.deadline))
        });
        let idle = self.exchange.is_none() && self.urgent.is_none();
        let candidates = [
            exchange,
            self.urgent.as_ref().map(|urgent| urgent.next),
            self.ledger.deadline(),
            self.sticks.deadline(config.stick_watchdog),
            self.resync.filter(|_| idle).map(|probe| probe.next),
            self.queue
                .front()
                .map(|queued| queued.since + config.queue_timeout),
            self.keep_alive_due(),
            self.guard
                .deadline(&config.safety, self.last_heard)
                .filter(|_| self.counters.states > 0),
            self.heartbeat_due(),
            self.link_due(),
        ];
        let next = candidates
            .into_iter()
            .flatten()
            .filter(|&at| at > self.now)
            .min();
        next.unwrap_or(Duration::MAX)
    }

    fn step_guard(&mut self) {
        let turning = match self.evidence.motors(self.now) {
            Motors::Turning => Some(true),
            // A take-off just sent has not moved the motor time yet.
            Motors::Stopped if !self.may_be_lifting_off() => Some(false),
            _ => None,
        };
        self.guard.motors(self.now, turning);
        if self.heartbeat_due().is_some_and(|due| due <= self.now) && self.guard.is_flying() {
            let milliseconds = self.now.saturating_sub(self.last_beat).as_millis() as u64;
            self.raise(Alarm::Heartbeat { milliseconds });
        }
        // Without a state stream silence is normal.
        let heard = if self.counters.states > 0 {
            self.last_heard
        } else {
            self.now
        };
        if let Some(alarm) = self
            .guard
            .check(self.now, &self.config.safety, &self.telemetry, heard)
        {
            self.land_on(alarm);
        }
    }

    fn heartbeat_due(&self) -> Option<Duration> {
        Some(self.last_beat + self.config.heartbeat?)
    }

    fn step_link(&mut self) {
        if self.link_due().is_some_and(|due| due <= self.now) {
            self.link_lost = true;
            self.emit(Event::LinkLost);
            self.ask();
        }
    }

    fn link_due(&self) -> Option<Duration> {
        (!self.link_lost && self.counters.states > 0)
            .then(|| self.last_heard + self.config.link_timeout)
    }

    fn step_sticks(&mut self) {
        let (period, watchdog) = (self.config.stick_period, self.config.stick_watchdog);
        let step = self.sticks.step(self.now, period, watchdog);
        if step.timed_out {
            self.emit(Event::SticksCentered);
        }
        if let Some(sticks) = step.send {
            self.send(&sticks.command());
        }
    }
}
