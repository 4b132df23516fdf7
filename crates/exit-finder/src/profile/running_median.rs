//! The lower median of a multiset that changes: O(log n) a change.

use std::collections::BTreeMap;

/// Positive numbers as bit patterns, split at their lower median.
#[derive(Debug, Clone, Default)]
pub(crate) struct RunningMedian {
    /// The lower half, which has as many numbers as the upper or one more.
    low: Multiset,
    high: Multiset,
}

#[derive(Debug, Clone, Default)]
struct Multiset {
    counts: BTreeMap<u64, usize>,
    len: usize,
}

impl RunningMedian {
    pub(crate) fn insert(&mut self, value: f64) {
        let bits = value.to_bits();
        match self.low.last() {
            Some(median) if bits > median => self.high.insert(bits),
            _ => self.low.insert(bits),
        }
        self.balance();
    }

    /// Takes out a number that was inserted; nothing happens when it was not.
    pub(crate) fn remove(&mut self, value: f64) {
        let bits = value.to_bits();
        if !self.low.remove(bits) {
            self.high.remove(bits);
        }
        self.balance();
    }

    pub(crate) fn median(&self) -> Option<f64> {
        self.low.last().map(f64::from_bits)
    }

    fn balance(&mut self) {
        if self.low.len > self.high.len + 1 {
            if let Some(last) = self.low.last() {
                self.low.remove(last);
                self.high.insert(last);
            }
        } else if self.high.len > self.low.len
            && let Some(first) = self.high.first()
        {
            self.high.remove(first);
            self.low.insert(first);
        }
    }
}

impl Multiset {
    fn first(&self) -> Option<u64> {
        self.counts.first_key_value().map(|(&bits, _)| bits)
    }

    fn last(&self) -> Option<u64> {
        self.counts.last_key_value().map(|(&bits, _)| bits)
    }

    fn insert(&mut self, bits: u64) {
        *self.counts.entry(bits).or_default() += 1;
        self.len += 1;
    }

    fn remove(&mut self, bits: u64) -> bool {
        let Some(count) = self.counts.get_mut(&bits) else {
            return false;
        };
        *count -= 1;
        if *count == 0 {
            self.counts.remove(&bits);
        }
        self.len -= 1;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_follows_every_change() {
        let (mut running, mut all) = (RunningMedian::default(), Vec::new());
        assert_eq!(running.median(), None);
        for i in 0..400u32 {
            let value = f64::from(i * 7919 % 101) + 0.5;
            if i % 3 == 2 {
                let gone = all.remove((i as usize * 31) % all.len());
                running.remove(gone);
            } else {
                all.push(value);
                running.insert(value);
            }
            let mut sorted = all.clone();
            sorted.sort_by(f64::total_cmp);
            assert_eq!(running.median(), Some(sorted[(sorted.len() - 1) / 2]));
        }
        running.remove(-1.0);
        assert!(running.median().is_some());
    }
}
