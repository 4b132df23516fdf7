//! The only clock of the command: how long a computation took.

use std::time::Instant;

/// Runs `work` and says how many seconds it took.
#[expect(
    clippy::disallowed_methods,
    reason = "the command reports how long its work takes"
)]
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = Instant::now();
    let result = work();
    (result, begin.elapsed().as_secs_f64())
}

/// The middle of some numbers (the mean of the middle two), 0 for none.
pub(crate) fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let half = numbers.len() / 2;
    match numbers.as_slice() {
        [] => 0.0,
        sorted if sorted.len() % 2 == 1 => sorted[half],
        sorted => f64::midpoint(sorted[half - 1], sorted[half]),
    }
}
