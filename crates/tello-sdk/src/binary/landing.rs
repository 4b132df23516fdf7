//! Landing until the flight data say that the drone stands: asked for, or on an alarm.

use super::command::{BinaryCommand, BinaryEvent, BinaryOutput, CommandId, Ending};
use super::session::BinarySession;
use crate::safety::{Alarm, outside};
use crate::session::Sticks;
use core::time::Duration;

/// `land` is being repeated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Landing {
    /// `None` for the session's own landing.
    pub(super) id: Option<CommandId>,
    pub(super) since: Duration,
    pub(super) next: Duration,
}

/// Later times are taken as this one (a hundred years), so that sums of times cannot overflow.
pub(super) const LATEST: Duration = Duration::from_secs(100 * 365 * 86_400);

impl BinarySession {
    pub(super) fn begin_landing(&mut self, id: Option<CommandId>) {
        if let Some(old) = self.landing.take() {
            self.end_landing(old.id, Ending::Unknown);
        }
        self.sticks = Sticks::CENTER;
        self.sticks_set = None;
        self.landing = Some(Landing {
            id,
            since: self.now,
            next: self.now,
        });
    }

    fn end_landing(&mut self, id: Option<CommandId>, ending: Ending) {
        if let Some(id) = id {
            self.finish(id, BinaryCommand::Land, ending);
        }
    }

    /// Reports a position from outside for the fence, metres.
    pub fn report_position(&mut self, now: Duration, position: [f64; 3]) {
        self.now = self.now.max(now.min(LATEST));
        if let Some(fence) = &self.config.safety.fence {
            let distance_cm = outside(fence, position);
            if distance_cm > 0 && self.guard.is_flying() {
                self.raise(Alarm::Fence { distance_cm });
            }
        }
        self.advance();
    }

    pub(super) fn raise(&mut self, alarm: Alarm) {
        if self.guard.raise(alarm) {
            self.land_on(alarm);
        }
    }

    pub(super) fn land_on(&mut self, alarm: Alarm) {
        self.outputs
            .push_back(BinaryOutput::Event(BinaryEvent::Alarm(alarm)));
        if self.landing.is_none() {
            self.begin_landing(None);
        }
    }

    pub(super) fn step_landing(&mut self) {
        let Some(mut landing) = self.landing else {
            return;
        };
        let landed = self
            .telemetry
            .flying
            .is_some_and(|f| !f.value && f.at > landing.since);
        let lifting = self.lift_off_until.is_some_and(|until| self.now < until);
        // A landing on an alarm is repeated until the drone stands, whatever the time.
        let alarmed = self.guard.latched().is_some();
        let late = self.now.saturating_sub(landing.since) >= self.config.land_give_up;
        if landed && !lifting {
            self.landing = None;
            return self.end_landing(landing.id, Ending::Confirmed);
        } else if late && !alarmed {
            self.landing = None;
            return self.end_landing(landing.id, Ending::Unknown);
        }
        if landing.next <= self.now {
            let (message, kind, payload) = BinaryCommand::Land.frame();
            self.send(message, kind, &payload);
            landing.next = self.now + self.config.repeat;
            self.landing = Some(landing);
        }
    }
}
