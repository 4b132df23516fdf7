//! Attribution: to whom a datagram belongs, or that it belongs to nobody.

use super::Session;
use super::event::{Event, Origin, Outcome};
use super::exchange::Probe;
use super::priority::MOTOR_LAG;
use crate::command::{Class, Command, ReplyShape};
use crate::reply::{Refusal, Reply, ReplyKind};
use crate::state::StateLine;
use alloc::string::ToString;

impl Session {
    pub(super) fn on_reply(&mut self, origin: Origin, bytes: &[u8]) {
        if !self.is_ours(origin) {
            return;
        }
        let reply = Reply::parse(bytes);
        match reply.kind {
            ReplyKind::BinaryPacket | ReplyKind::BinaryAck => {
                self.counters.binary += 1;
                return self.heard();
            }
            ReplyKind::Empty => return self.heard(),
            ReplyKind::ForcedStop => {
                self.heard();
                return self.emit(Event::ForcedStop);
            }
            _ => self.heard(),
        }
        if self.reply_to_fence(&reply)
            || self.reply_to_urgent(&reply)
            || self.reply_to_exchange(&reply)
        {
            return;
        }
        self.counters.stale += 1;
        self.emit(Event::Stale(reply));
    }

    pub(super) fn on_state(&mut self, origin: Origin, bytes: &[u8]) {
        if !self.is_ours(origin) {
            return;
        }
        let Ok(line) = StateLine::parse(bytes) else {
            self.counters.bad_states += 1;
            return;
        };
        self.counters.states += 1;
        self.heard();
        self.first_state = self.first_state.or(Some(self.now));
        let sample = line.telemetry(self.now, &self.config.convention);
        self.evidence.observe(self.now, &sample);
        self.telemetry.merge(&sample);
        self.emit(Event::Telemetry);
    }

    fn is_ours(&mut self, origin: Origin) -> bool {
        let ours = match origin {
            Origin::Drone => true,
            Origin::OtherPort => self.config.accept_other_port,
            Origin::Stranger => false,
        };
        self.counters.foreign += u64::from(!ours);
        ours
    }

    fn heard(&mut self) {
        self.last_heard = self.now;
        if core::mem::take(&mut self.link_lost) {
            self.emit(Event::LinkRestored);
        }
    }

    /// A number, or an error that names no cause of a motion's failure, answers a fence that is out.
    fn reply_to_fence(&mut self, reply: &Reply) -> bool {
        let in_motion = self
            .exchange
            .as_mut()
            .and_then(|exchange| exchange.probe.as_mut());
        let Some(probe) = in_motion
            .or(self.resync.as_mut())
            .filter(|probe| probe.waits())
        else {
            return false;
        };
        let vague = matches!(
            reply.refusal(),
            Some(
                Refusal::Plain | Refusal::Unlisted | Refusal::NotJoystick | Refusal::UnknownCommand
            )
        );
        let is_value = reply.refusal().is_none() && reply.fits(ReplyShape::Number);
        if !vague && !is_value {
            return false;
        }
        probe.answered = Some(self.now);
        let repeated = probe.sent > 1;
        self.counters.attributed += 1;
        let (copy, late) = (
            self.now + self.config.duplicate_window,
            self.now + self.config.max_delay,
        );
        self.ledger.expect_copy(ReplyShape::Number, vague, copy);
        if repeated || vague {
            self.ledger.owe(ReplyShape::Number, late);
        }
        if self.resync.is_some_and(|probe| probe.answered.is_some()) {
            self.resync = None;
        }
        true
    }

    fn reply_to_exchange(&mut self, reply: &Reply) -> bool {
        let Some(mut exchange) = self.exchange.take_if(|e| reply.fits(e.shape)) else {
            return false;
        };
        if self.is_ambiguous(reply, &exchange.command) {
            self.exchange = Some(exchange);
            return false;
        }
        if exchange.command.class() == Class::Motion
            && reply.refusal() == Some(Refusal::NotJoystick)
        {
            // Said to the second of two copies as well, while the first is carried out: ask, then look.
            if let Some(probe) = &mut exchange.probe {
                probe.next = probe.next.min(self.now + self.config.duplicate_window);
            }
            self.exchange = Some(exchange);
            return false;
        }
        self.counters.attributed += 1;
        let (copy, late) = (
            self.now + self.config.duplicate_window,
            self.now + self.config.max_delay,
        );
        self.ledger
            .expect_copy(exchange.shape, reply.refusal().is_some(), copy);
        if exchange.attempts > 1 {
            self.ledger.owe(exchange.shape, late);
        }
        self.owe_probe(exchange.probe);
        if exchange.shape == ReplyShape::Number {
            self.resync = None;
        }
        let outcome = self.outcome(&exchange.command, reply);
        self.finish(exchange.id, exchange.command, outcome);
        true
    }

    /// Whether the reply could be the late one of an earlier command.
    fn is_ambiguous(&self, reply: &Reply, command: &Command) -> bool {
        match reply.refusal() {
            Some(Refusal::UnknownCommand) => {
                // The drone repeats the text it did not know.
                let text = command.to_string();
                match reply.raw.split_once(':').map(|(_, named)| named.trim()) {
                    Some(named) if !named.is_empty() => named != text,
                    _ => self.ledger.error_is_ambiguous(),
                }
            }
            Some(_) => self.ledger.error_is_ambiguous(),
            None => false,
        }
    }

    fn outcome(&mut self, command: &Command, reply: &Reply) -> Outcome {
        let lifts = matches!(command, Command::TakeOff | Command::ThrowFly);
        match reply.refusal() {
            Some(refusal) => {
                // A doubled take-off may be refused and carried out: with telemetry, only the motors tell.
                if lifts && !self.evidence.is_fresh(self.now) {
                    self.lift_off_until = None;
                    self.guard.motors(self.now, Some(false));
                }
                Outcome::Refused {
                    refusal,
                    reply: reply.clone(),
                }
            }
            None => {
                if lifts {
                    self.lift_off_until = Some(self.now + MOTOR_LAG);
                }
                Outcome::Answered(reply.clone())
            }
        }
    }

    /// Starts asking at once; used when the link comes back or is lost in the middle of something.
    pub(super) fn ask(&mut self) {
        self.resync = self.resync.or(Some(Probe::at(self.now)));
    }
}
