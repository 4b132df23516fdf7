//! The only clock of the command: how long computations take.

use std::collections::BTreeMap;
use std::time::Instant;

use explorer::{Stage, StageObserver};

/// Runs `work` and says how many seconds it took.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = now();
    let result = work();
    (result, begin.elapsed().as_secs_f64())
}

/// Runs `work` so many times, at least once; the last result, and the median of the seconds.
pub(crate) fn timed_median<T>(times: u32, mut work: impl FnMut() -> T) -> (T, f64) {
    let (mut result, first) = timed(&mut work);
    let mut seconds = vec![first];
    for _ in 1..times {
        let (again, took) = timed(&mut work);
        result = again;
        seconds.push(took);
    }
    (result, median(seconds))
}

#[expect(
    clippy::disallowed_methods,
    reason = "the command reports how long its work takes"
)]
fn now() -> Instant {
    Instant::now()
}

/// How long each stage of a mission took, time after time.
#[derive(Debug, Default)]
pub(crate) struct StageTimes {
    begun: Option<Instant>,
    milliseconds: BTreeMap<Stage, Vec<f64>>,
}

impl StageTimes {
    /// Milliseconds of each time that this stage ran.
    pub(crate) fn of(&self, stage: Stage) -> Vec<f64> {
        self.milliseconds.get(&stage).cloned().unwrap_or_default()
    }
}

impl StageObserver for StageTimes {
    fn begin(&mut self, _: Stage) {
        self.begun = Some(now());
    }

    fn end(&mut self, stage: Stage) {
        if let Some(begun) = self.begun.take() {
            let milliseconds = begun.elapsed().as_secs_f64() * 1e3;
            self.milliseconds
                .entry(stage)
                .or_default()
                .push(milliseconds);
        }
    }
}

/// The number below which this share of the numbers lies (nearest rank); none of none.
pub(crate) fn percentile(mut numbers: Vec<f64>, share: f64) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    let last = numbers.len().checked_sub(1)?;
    numbers.get((last as f64 * share).round() as usize).copied()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_percentiles() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(vec![]), 0.0);
        assert_eq!(
            percentile((0..=100).map(f64::from).collect(), 0.95),
            Some(95.0)
        );
        assert_eq!(percentile(vec![], 0.5), None);
    }
}
