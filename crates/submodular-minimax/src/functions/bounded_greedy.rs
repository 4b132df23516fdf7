//! Greedy facility location over points without a kernel matrix: bounds from boxes skip most gains.
//!
//! A heap holds candidates with bounds from [`Clients`] in three grades of sharpness, then exact
//! gains; the top is sharpened until it is exact and of this round. Bounds stay bounds while the set
//! grows, so the selection is exactly that of greedy, ties to the lowest index included.
//! Cost: some tens to hundreds of nodes a bound, n kernel values an exact gain; memory O(n).

use super::facility_location::{FacilityLocation, Serving};
use super::far_field::Clients;
use super::similarity::{Points, Similarity};
use crate::maximize::{LazyGreedy, MaximizeError, MaximizeStop, Maximizer, Maximum};
use crate::set_function::Growth;
use crate::subset::Subset;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

impl FacilityLocation<Points> {
    /// What [`Greedy`](crate::maximize::Greedy) selects under a cardinality constraint, much faster.
    ///
    /// [`Maximum::evaluations`] counts the exact gains. With caps it is lazy greedy.
    ///
    /// ```
    /// use submodular_minimax::functions::{FacilityLocation, Kernel, Points};
    /// let line: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    /// let function = FacilityLocation::new(Points::new(&line, Kernel::Linear { reach: 5.0 })?);
    /// assert_eq!(function.greedy(1)?.picks, [4]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// k = 0.
    pub fn greedy(&self, k: usize) -> Result<Maximum, MaximizeError> {
        if self.is_truncated() || k == 0 {
            return LazyGreedy::cardinality(k).maximize(self);
        }
        let n = self.similarity().row_count();
        let mut search = Search::new(self);
        let mut found = Maximum::start(n, 0.0);
        found.stop = MaximizeStop::Full;
        while found.picks.len() < k.min(n) {
            let (gain, element) = search.best(&mut found.evaluations);
            if gain <= 0.0 {
                found.stop = MaximizeStop::NoGain;
                break;
            }
            found.pick(element, gain);
            search.insert(element);
        }
        Ok(found)
    }
}

struct Search<'a> {
    points: &'a Points,
    serving: Serving<'a, Points>,
    clients: Clients,
    heap: BinaryHeap<Entry>,
    round: usize,
    /// A gain that some candidate has in this round.
    reached: f64,
}

#[derive(Clone, Copy, PartialEq)]
struct Entry {
    bound: f64,
    /// How sharp: a position in [`SLACKS`], its length for the exact gain.
    grade: usize,
    element: usize,
    round: usize,
}

impl<'a> Search<'a> {
    fn new(function: &'a FacilityLocation<Points>) -> Self {
        let points = function.similarity();
        let n = points.row_count();
        let places: Vec<[f64; 3]> = (0..n).map(|v| points.point(v)).collect();
        let start = |element| Entry {
            bound: f64::INFINITY,
            grade: 0,
            element,
            round: usize::MAX,
        };
        let mut search = Self {
            points,
            serving: function.serving(&Subset::empty(n)),
            clients: Clients::new(&places, |v| function.weight(v)),
            heap: (0..n).map(start).collect(),
            round: 0,
            reached: 0.0,
        };
        search.probe();
        search
    }

    /// The largest gain and the lowest index that has it.
    fn best(&mut self, evaluations: &mut usize) -> (f64, usize) {
        while let Some(top) = self.heap.pop() {
            let fresh = top.round == self.round;
            if fresh && top.grade == SLACKS.len() {
                return (top.bound, top.element);
            }
            let grade = if fresh { top.grade + 1 } else { 0 };
            let bound = if let Some(slack) = SLACKS.get(grade) {
                let allowed = slack * self.reached / self.clients.weight().max(f64::MIN_POSITIVE);
                let center = self.points.point(top.element);
                let bound = self.clients.gain_bound(self.points, center, allowed);
                bound.min(top.bound)
            } else {
                *evaluations += 1;
                let gain = self.serving.gain(top.element);
                self.reached = self.reached.max(gain);
                gain
            };
            self.heap.push(Entry {
                bound,
                grade,
                round: self.round,
                ..top
            });
        }
        (0.0, 0)
    }

    fn insert(&mut self, element: usize) {
        self.serving.insert(element);
        self.clients.serve(&self.serving.served);
        self.round += 1;
        self.probe();
    }

    /// Tries a few candidates, since how sharp a bound must be depends on the gain sought.
    fn probe(&mut self) {
        let n = self.points.row_count();
        let probes = (0..n).step_by(n.div_ceil(PROBES).max(1));
        self.reached = probes.map(|u| self.serving.gain(u)).fold(0.0, f64::max);
    }
}

impl Eq for Entry {}

impl Ord for Entry {
    /// By bound; among equals bounds before exact gains, since they may hide a lower index.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_bound = self.bound.total_cmp(&other.bound);
        by_bound
            .then(other.grade.cmp(&self.grade))
            .then(other.element.cmp(&self.element))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// How much of the gain sought a bound may be too high, grade by grade.
const SLACKS: [f64; 3] = [0.1, 0.01, 0.001];
/// Candidates tried at the start of a round.
const PROBES: usize = 24;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::Kernel;
    use crate::maximize::{Greedy, Maximizer};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn selects_what_naive_greedy_selects(
            cells in prop::collection::vec((0..9i8, 0..9i8, 0..4i8), 1..150),
            k in 1..12usize,
            kernel in prop::sample::select(vec![
                Kernel::Linear { reach: 3.0 }, Kernel::Linear { reach: 30.0 },
                Kernel::Reciprocal { scale: 1.0 }, Kernel::Rational { scale: 1.5 },
            ]),
            weighted in any::<bool>(),
        ) {
            let points: Vec<[f64; 3]> =
                cells.iter().map(|c| [f64::from(c.0), f64::from(c.1), 0.5 * f64::from(c.2)]).collect();
            let mut function = FacilityLocation::new(Points::new(&points, kernel).unwrap());
            if weighted {
                let n = points.len();
                function = function.weighted((0..n).map(|v| (v % 3) as f64).collect()).unwrap();
                function = function.truncated((0..n).map(|v| 0.3 + (v % 4) as f64).collect()).unwrap();
            }
            let naive = Greedy::cardinality(k).maximize(&function).unwrap();
            let fast = function.greedy(k).unwrap();
            prop_assert_eq!(&fast.picks, &naive.picks);
            prop_assert_eq!(&fast.gains, &naive.gains);
            prop_assert_eq!(fast.stop == MaximizeStop::NoGain, naive.stop == MaximizeStop::NoGain);
        }
    }
}
