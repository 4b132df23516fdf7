//! Runs of bins on the circle.

use std::f64::consts::TAU;

use crate::angle::wrap;

/// A part of the circle: from `start`, counter-clockwise, over `width`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sector {
    /// Bearing where it starts, radians in `[0, 2π)`.
    pub start_rad: f64,
    /// Its angular width, radians in `(0, 2π]`.
    pub width_rad: f64,
}

impl Sector {
    /// The bearing in the middle, radians in `[0, 2π)`.
    pub fn middle_rad(&self) -> f64 {
        wrap(self.start_rad + 0.5 * self.width_rad)
    }

    /// Whether a bearing lies in the sector (start included, end excluded).
    pub fn contains(&self, bearing_rad: f64) -> bool {
        wrap(bearing_rad - self.start_rad) < self.width_rad
    }
}

/// Consecutive bins on the circle: `start`, `start + 1`, … (mod n), `len` of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) start: usize,
    pub(crate) len: usize,
}

impl Run {
    /// The bins in order; `start` below `n`, `len` at most `n`. Two ranges are faster than a remainder a bin.
    pub(crate) fn bins(self, n: usize) -> impl DoubleEndedIterator<Item = usize> {
        let end = self.start + self.len;
        (self.start..end.min(n)).chain(0..end.saturating_sub(n))
    }

    /// Whether all its bins belong to another run of a circle of `n`.
    pub(crate) fn is_within(self, other: Self, n: usize) -> bool {
        (self.start + n - other.start) % n + self.len <= other.len
    }

    pub(crate) fn sector(self, n: usize) -> Sector {
        let bin = TAU / n as f64;
        Sector {
            start_rad: self.start as f64 * bin,
            width_rad: self.len as f64 * bin,
        }
    }
}

/// Maximal circular runs of set flags, ascending by start. All flags set: one run from 0.
pub(crate) fn circular_runs(flags: &[bool]) -> Vec<Run> {
    let n = flags.len();
    let Some(first_unset) = flags.iter().position(|&set| !set) else {
        return if n == 0 {
            Vec::new()
        } else {
            vec![Run { start: 0, len: n }]
        };
    };
    let mut runs = Vec::new();
    let mut open: Option<Run> = None;
    for step in 1..=n {
        let bin = (first_unset + step) % n;
        if flags[bin] {
            let run = open.get_or_insert(Run { start: bin, len: 0 });
            run.len += 1;
        } else {
            runs.extend(open.take());
        }
    }
    runs.sort_by_key(|run| run.start);
    runs
}

/// Maximal runs of set flags on a line, ascending: a run across the end is cut in two.
pub(crate) fn linear_runs(flags: &[bool]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (bin, _) in flags.iter().enumerate().filter(|(_, set)| **set) {
        match runs.last_mut() {
            Some(run) if run.start + run.len == bin => run.len += 1,
            _ => runs.push(Run { start: bin, len: 1 }),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flags(pattern: &str) -> Vec<bool> {
        pattern.bytes().map(|b| b == b'x').collect()
    }

    #[test]
    fn a_run_across_zero_is_one_on_the_circle_and_two_on_the_line() {
        let pattern = flags("xx..x..x");
        let expected = vec![Run { start: 4, len: 1 }, Run { start: 7, len: 3 }];
        assert_eq!(circular_runs(&pattern), expected);
        assert_eq!(linear_runs(&pattern).len(), 3);
    }

    #[test]
    fn the_full_circle_is_one_run() {
        assert_eq!(
            circular_runs(&flags("xxxx")),
            vec![Run { start: 0, len: 4 }]
        );
        assert!(circular_runs(&flags("....")).is_empty());
        assert!(circular_runs(&[]).is_empty());
    }

    #[test]
    fn a_sector_across_zero_contains_zero() {
        let sector = Run { start: 6, len: 4 }.sector(8);
        assert!(sector.contains(0.0) && !sector.contains(TAU / 4.0));
        assert!(sector.middle_rad() < 1e-9);
    }
}
