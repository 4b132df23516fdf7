//! The `rc` lane: the latest set-point at a fixed rate, centred when no new one comes.

use crate::command::Command;
use crate::units::Stick;
use core::time::Duration;

/// Positions of the four sticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sticks {
    /// Right positive.
    pub roll: Stick,
    /// Forward positive.
    pub pitch: Stick,
    /// Up positive.
    pub throttle: Stick,
    /// Clockwise positive.
    pub yaw: Stick,
}

impl Sticks {
    /// All at rest.
    pub const CENTER: Self = Self {
        roll: Stick::CENTER,
        pitch: Stick::CENTER,
        throttle: Stick::CENTER,
        yaw: Stick::CENTER,
    };

    /// The command that carries them.
    #[must_use]
    pub fn command(self) -> Command {
        let Self {
            roll,
            pitch,
            throttle,
            yaw,
        } = self;
        Command::Rc {
            roll,
            pitch,
            throttle,
            yaw,
        }
    }
}

/// A lost zero would leave the drone flying, so zero is said several times before the lane goes quiet.
const ZEROS: u8 = 5;

#[derive(Debug, Clone, Copy)]
enum Lane {
    Idle,
    Active {
        sticks: Sticks,
        set_at: Duration,
        next: Duration,
    },
    Centering {
        left: u8,
        next: Duration,
    },
}

#[derive(Debug, Clone, Copy)]
pub(super) struct StickLane {
    lane: Lane,
}

/// What the lane wants done now.
pub(super) struct StickStep {
    pub(super) send: Option<Sticks>,
    pub(super) timed_out: bool,
}

impl StickLane {
    pub(super) const fn new() -> Self {
        Self { lane: Lane::Idle }
    }

    pub(super) fn set(&mut self, now: Duration, sticks: Sticks) {
        let next = match self.lane {
            Lane::Active { next, .. } | Lane::Centering { next, .. } => next,
            Lane::Idle => now,
        };
        self.lane = Lane::Active {
            sticks,
            set_at: now,
            next,
        };
    }

    /// Centres the sticks, if they were in use.
    pub(super) fn release(&mut self, now: Duration) {
        if matches!(self.lane, Lane::Active { .. }) {
            self.lane = Lane::Centering {
                left: ZEROS,
                next: now,
            };
        }
    }

    pub(super) fn is_active(&self) -> bool {
        matches!(self.lane, Lane::Active { .. })
    }

    pub(super) fn in_use(&self) -> bool {
        !matches!(self.lane, Lane::Idle)
    }

    pub(super) fn step(
        &mut self,
        now: Duration,
        period: Duration,
        watchdog: Duration,
    ) -> StickStep {
        let mut step = StickStep {
            send: None,
            timed_out: false,
        };
        if let Lane::Active { set_at, .. } = self.lane
            && now.saturating_sub(set_at) >= watchdog
        {
            step.timed_out = true;
            self.release(now);
        }
        match &mut self.lane {
            Lane::Active { sticks, next, .. } if *next <= now => {
                *next = now + period;
                step.send = Some(*sticks);
            }
            Lane::Centering { left, next } if *next <= now => {
                *next = now + period;
                *left -= 1;
                step.send = Some(Sticks::CENTER);
            }
            _ => {}
        }
        if matches!(self.lane, Lane::Centering { left: 0, .. }) {
            self.lane = Lane::Idle;
        }
        step
    }

    pub(super) fn deadline(&self, watchdog: Duration) -> Option<Duration> {
        match self.lane {
            Lane::Idle => None,
            Lane::Active { set_at, next, .. } => Some(next.min(set_at + watchdog)),
            Lane::Centering { next, .. } => Some(next),
        }
    }
}
