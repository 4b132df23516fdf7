//! Time that this thread spent on a processor: on a shared machine, what a computation costs.

use std::time::Instant;

/// Seconds since the clock was made.
pub(crate) struct CpuClock {
    begun: Instant,
    spent: Option<f64>,
}

impl CpuClock {
    #[expect(clippy::disallowed_methods, reason = "it measures time")]
    pub(crate) fn start() -> Self {
        Self {
            begun: Instant::now(),
            spent: spent(),
        }
    }

    /// By the scheduler's account where there is one (Linux, to about a millisecond), else by the wall clock.
    pub(crate) fn seconds(&self) -> f64 {
        match (self.spent, spent()) {
            (Some(before), Some(now)) => now - before,
            _ => self.wall_seconds(),
        }
    }

    /// By the wall clock, for what takes less than the scheduler counts.
    pub(crate) fn wall_seconds(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }
}

fn spent() -> Option<f64> {
    let account = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = account.split(' ').next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}
