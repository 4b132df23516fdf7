//! Time that this thread has spent on a processor: unlike the clock's, it does not count what others do.

use std::time::Instant;

/// Seconds on the processor since the thread began (Linux), or since `start` elsewhere.
pub(crate) fn cpu_seconds(start: Instant) -> f64 {
    let nanoseconds = std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}
