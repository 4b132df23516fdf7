//! Time that this thread has spent on a processor: unlike the clock's, it does not count what others do.

use std::time::Instant;

/// Seconds on the processor since the thread began (Linux), or since `start` elsewhere.
pub(crate) fn cpu_seconds(start: Instant) -> f64 {
    // The kernel brings the count up to date at its ticks, milliseconds apart, and when a thread gives way.
    std::thread::yield_now();
    let nanoseconds = std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// The last of `runs` results after a first one that is not counted, and the mean seconds on the processor.
pub(crate) fn mean_cpu_seconds<R>(
    start: Instant,
    runs: u32,
    mut work: impl FnMut() -> R,
) -> (R, f64) {
    let mut result = work();
    let before = cpu_seconds(start);
    for _ in 0..runs {
        result = work();
    }
    (result, (cpu_seconds(start) - before) / f64::from(runs))
}
