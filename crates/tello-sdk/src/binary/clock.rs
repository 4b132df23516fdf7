//! From the drone's tick counter to this side's time.
//!
//! The counter runs at 2.344 MHz and wraps every 30.5 minutes (measured by others on one drone). A record arrives some
//! time after it was made, never before: the smallest difference seen is the best estimate of the offset. The first
//! three records after connecting are old and are not used.

use core::time::Duration;

/// Nanoseconds per tick at 2.344 MHz.
const NANOS_PER_TICK: f64 = 1e9 / 2.344e6;
/// Records at the beginning that are old.
const STALE: u32 = 3;
/// How fast the estimate may rise again, so that a drifting counter is followed: 50 microseconds per second.
const LEAK: f64 = 50e-6;

/// Converts ticks; feed it each record of one kind in the order of arrival.
#[derive(Debug, Clone, Copy, Default)]
pub struct TickClock {
    seen: u32,
    last: Option<u32>,
    unwrapped: u64,
    offset: Option<f64>,
    last_arrival: Duration,
}

impl TickClock {
    /// A clock that has seen nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// When the record with this tick was made, given when it arrived; `None` for the stale ones at the beginning.
    /// Never later than the arrival. A tick that goes back by less than half a turn is taken as an overtaken record.
    pub fn observe(&mut self, tick: u32, arrival: Duration) -> Option<Duration> {
        self.seen = self.seen.saturating_add(1);
        if self.seen <= STALE {
            return None;
        }
        let forward = self.last.map_or(0, |last| tick.wrapping_sub(last));
        let is_new = forward < u32::MAX / 2;
        let ticks = if is_new {
            self.last = Some(tick);
            self.unwrapped += u64::from(forward);
            self.unwrapped
        } else {
            self.unwrapped
                .saturating_sub(u64::from(forward.wrapping_neg()))
        };
        let made = seconds(ticks);
        let difference = arrival.as_secs_f64() - made;
        let elapsed = arrival.saturating_sub(self.last_arrival).as_secs_f64();
        self.last_arrival = self.last_arrival.max(arrival);
        let offset = self
            .offset
            .map_or(difference, |old| difference.min(old + LEAK * elapsed));
        self.offset = Some(offset);
        at(made + offset, arrival)
    }

    /// When a record of another kind was made, by the offset known so far; the clock learns nothing from it.
    #[must_use]
    pub fn convert(&self, tick: u32, arrival: Duration) -> Option<Duration> {
        let since = tick.wrapping_sub(self.last?) as i32;
        let ticks = self.unwrapped.saturating_add_signed(i64::from(since));
        at(seconds(ticks) + self.offset?, arrival)
    }
}

fn seconds(ticks: u64) -> f64 {
    ticks as f64 * NANOS_PER_TICK * 1e-9
}

/// Never later than the arrival.
fn at(seconds: f64, arrival: Duration) -> Option<Duration> {
    let time = Duration::try_from_secs_f64(seconds).ok()?;
    Some(time.min(arrival))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tick_at(seconds: f64) -> u32 {
        ((seconds * 2.344e6) as u64 + 4_000_000_000) as u32
    }

    #[test]
    fn jitter_is_removed_also_over_the_wrap() {
        let mut clock = TickClock::new();
        let mut worst = 0.0_f64;
        // Forty minutes at 10 Hz: more than one turn of the counter. Delay 30 to 90 ms.
        for i in 0..24_000_u32 {
            let made = f64::from(i) * 0.1;
            let delay = 0.03 + 0.06 * f64::from((i * 7919) % 100) / 100.0;
            let arrival = Duration::from_secs_f64(made + delay);
            if let Some(time) = clock.observe(tick_at(made), arrival) {
                assert!(time <= arrival);
                if i > 200 {
                    worst = worst.max((time.as_secs_f64() - made - 0.03).abs());
                }
            }
        }
        assert!(worst < 0.002, "{worst}");
    }

    #[test]
    fn a_late_record_of_another_kind_keeps_its_time() {
        let mut clock = TickClock::new();
        assert_eq!(clock.convert(0, Duration::ZERO), None);
        for i in 0..50_u32 {
            let made = f64::from(i) * 0.1;
            let _ = clock.observe(tick_at(made), Duration::from_secs_f64(made + 0.03));
        }
        let late = clock
            .convert(tick_at(4.5), Duration::from_secs_f64(5.4))
            .unwrap();
        assert!((late.as_secs_f64() - 4.53).abs() < 1e-3, "{late:?}");
    }

    #[test]
    fn the_first_three_are_not_used() {
        let mut clock = TickClock::new();
        for _ in 0..3 {
            assert_eq!(clock.observe(5, Duration::from_secs(1)), None);
        }
        assert!(clock.observe(5, Duration::from_secs(1)).is_some());
    }
}
