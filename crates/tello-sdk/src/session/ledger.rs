//! Replies that may still arrive although nobody waits for them any more.
//!
//! The text protocol has no request ids: a late or doubled reply looks like the answer to the next command. The
//! ledger remembers, for each command that timed out or was sent more than once, and for each reply received, until
//! when something of the same look may still come. While it does, no command with replies of that shape is sent, and
//! an error, which fits every shape, is attributed to nobody.

use crate::command::ReplyShape;
use alloc::vec::Vec;
use core::time::Duration;

#[derive(Debug, Clone, Copy)]
struct Owed {
    /// A value or ok of this shape may come.
    value: Option<ReplyShape>,
    /// An error may come.
    error: bool,
    /// An error is likely (the copy of one just received): no command may go out at all.
    only_error: bool,
    until: Duration,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Ledger {
    owed: Vec<Owed>,
}

impl Ledger {
    /// A command of this shape was given up, or sent more often than answered.
    pub(super) fn owe(&mut self, shape: ReplyShape, until: Duration) {
        if shape != ReplyShape::Silent {
            self.push(Owed {
                value: Some(shape),
                error: true,
                only_error: false,
                until,
            });
        }
    }

    /// A reply was received, so its copy may follow.
    pub(super) fn expect_copy(&mut self, shape: ReplyShape, is_error: bool, until: Duration) {
        let value = (!is_error).then_some(shape);
        self.push(Owed {
            value,
            error: is_error,
            only_error: is_error,
            until,
        });
    }

    fn push(&mut self, new: Owed) {
        // Bounded: one entry per distinct look, the latest time wins.
        let same = |o: &&mut Owed| {
            (o.value, o.error, o.only_error) == (new.value, new.error, new.only_error)
        };
        match self.owed.iter_mut().find(same) {
            Some(old) => old.until = old.until.max(new.until),
            None => self.owed.push(new),
        }
    }

    pub(super) fn expire(&mut self, now: Duration) {
        self.owed.retain(|owed| owed.until > now);
    }

    /// Whether a reply to a command of this shape could be mistaken.
    pub(super) fn blocks(&self, shape: ReplyShape) -> bool {
        self.owed
            .iter()
            .any(|owed| owed.only_error || owed.value == Some(shape))
    }

    /// Whether an error could belong to an earlier command.
    pub(super) fn error_is_ambiguous(&self) -> bool {
        self.owed.iter().any(|owed| owed.error)
    }

    /// When the next entry ends.
    pub(super) fn deadline(&self) -> Option<Duration> {
        self.owed.iter().map(|owed| owed.until).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn a_given_up_command_blocks_its_shape_only() {
        let mut ledger = Ledger::default();
        ledger.owe(ReplyShape::Ok, SECOND);
        assert!(ledger.blocks(ReplyShape::Ok) && !ledger.blocks(ReplyShape::Number));
        assert!(ledger.error_is_ambiguous());
        ledger.expire(SECOND);
        assert!(!ledger.blocks(ReplyShape::Ok) && ledger.deadline().is_none());
    }

    #[test]
    fn the_copy_of_an_error_blocks_everything_the_copy_of_an_ok_its_shape() {
        let mut ledger = Ledger::default();
        ledger.expect_copy(ReplyShape::Ok, false, SECOND);
        assert!(ledger.blocks(ReplyShape::Ok) && !ledger.error_is_ambiguous());
        ledger.expect_copy(ReplyShape::Ok, true, SECOND);
        assert!(ledger.blocks(ReplyShape::Number));
    }

    #[test]
    fn it_stays_small() {
        let mut ledger = Ledger::default();
        for i in 0..1000 {
            ledger.owe(ReplyShape::Ok, SECOND * i);
            ledger.expect_copy(ReplyShape::Number, i % 2 == 0, SECOND * i);
        }
        assert!(ledger.owed.len() <= 3);
    }
}
