//! The minimax problem of a cloud: which u may represent v how well, and what v must reach.

use crate::functions::{Representation, Sparse};
use crate::neighbours::NeighbourGraph;
use std::borrow::Borrow;

/// s(u, v) on a neighbour graph and the bar θ(v) = (1 + β) λ(v) that v's best score must exceed.
///
/// Scores not above θ(v) are cut to zero: then the first representative with a positive gain always
/// lets some point join, and Algorithm 1 ends exactly at { v : max over u of s(u, v) > θ(v) }.
pub(super) struct Problem<G = NeighbourGraph> {
    pub(super) graph: G,
    pub(super) score: Score,
    pub(super) threshold: Vec<f64>,
    pub(super) beta: f64,
}

/// How a squared distance and a representative make a score in [0, 1].
pub(super) enum Score {
    /// w(u) (1 − d/h)₊.
    Kernel {
        /// h, in scaled units.
        reach: f64,
        /// w, one a representative.
        weight: Vec<f64>,
    },
    /// 1 / (1 + (density(u) + d) / unit).
    Density {
        /// The mean normalised distance from u to its neighbours.
        density: Vec<f64>,
        /// What counts as one.
        unit: f64,
    },
}

impl Score {
    pub(super) fn of(&self, u: usize, squared: f64) -> f64 {
        match self {
            Self::Kernel { reach, weight } => weight[u] * (1.0 - squared.sqrt() / reach).max(0.0),
            Self::Density { density, unit } => 1.0 / (1.0 + (density[u] + squared.sqrt()) / unit),
        }
    }

    /// How far `best` falls short of `threshold`: at or above 0 for an outlier.
    fn shortfall(&self, threshold: f64, best: f64) -> f64 {
        match self {
            Self::Kernel { .. } => threshold - best,
            Self::Density { .. } => {
                let odds = |s: f64| (1.0 / s - 1.0).ln();
                let gap = odds(best) - odds(threshold);
                // The sign must be the one that the comparison of the scores themselves gives.
                if best > threshold {
                    gap.min(-f64::MIN_POSITIVE)
                } else {
                    gap.max(0.0)
                }
            }
        }
    }
}

impl<G: Borrow<NeighbourGraph>> Problem<G> {
    /// max over u of s(u, v).
    pub(super) fn best(&self, v: usize) -> f64 {
        let scores = self
            .graph
            .borrow()
            .row(v)
            .iter()
            .map(|&(d, u)| self.score.of(u as usize, d));
        scores.fold(0.0, f64::max)
    }

    /// The shortfall of every point; of those that no point represents the larger, the farther the nearest points are.
    pub(super) fn shortfalls(&self) -> Vec<f64> {
        let graph = self.graph.borrow();
        let shortfall = |v| {
            let best = self.best(v);
            let beyond = match self.score {
                Score::Kernel { reach, .. } if best <= 0.0 => {
                    (graph.isolation(v) / reach).min(f64::MAX)
                }
                _ => 0.0,
            };
            self.score.shortfall(self.threshold[v], best) + beyond
        };
        (0..graph.len()).map(shortfall).collect()
    }

    /// Eq. (1) with the truncated scores, λ = θ / (1 + β) and γ = 1/n.
    pub(super) fn function(&self) -> Representation<Sparse> {
        let n = self.graph.borrow().len();
        let kept = |v: usize| {
            self.graph
                .borrow()
                .row(v)
                .iter()
                .filter_map(move |&(d, u)| {
                    let s = self.score.of(u as usize, d);
                    (s > self.threshold[v]).then_some((u as usize, s))
                })
        };
        let lambda = self
            .threshold
            .iter()
            .map(|t| t / (1.0 + self.beta))
            .collect();
        Representation::trusted(Sparse::transposed(n, kept), lambda, 1.0 / n.max(1) as f64)
    }

    /// k, lowered so that the function is not negative: k / n ≤ λ_min / s_max, with s ≤ 1.
    pub(super) fn representatives(&self, wanted: usize) -> usize {
        let least = self.threshold.iter().copied().fold(f64::INFINITY, f64::min);
        let lambda = (least / (1.0 + self.beta)).min(1.0);
        wanted
            .min((lambda * self.graph.borrow().len() as f64) as usize)
            .max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::neighbours::RangeTree;

    /// Ten points one apart; a neighbour's score is 0.5, the bar as given.
    fn line(threshold: f64) -> Problem {
        let points: Vec<[f64; 3]> = (0..10).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let graph = NeighbourGraph::new(&RangeTree::new(&points, &[]), 4, f64::INFINITY);
        let (reach, weight) = (2.0, vec![1.0; 10]);
        Problem {
            graph,
            score: Score::Kernel { reach, weight },
            threshold: vec![threshold; 10],
            beta: 1.0,
        }
    }

    #[test]
    fn representatives_are_few_enough_for_a_function_that_is_not_negative() {
        // λ n = 0.25 · 10.
        assert_eq!(line(0.5).representatives(64), 2);
        assert_eq!(line(0.5).representatives(1), 1);
        assert_eq!(line(0.02).representatives(64), 1);
        assert_eq!(line(9.0).representatives(64), 10);
    }

    #[test]
    fn a_score_that_only_reaches_its_bar_does_not_join() {
        let at = line(0.5);
        assert!(at.shortfalls().iter().all(|&shortfall| shortfall == 0.0));
        let function = at.function();
        let entries = (0..10).map(|v| at.best(v)).fold(0.0, f64::max);
        assert_eq!(entries, 0.5);
        assert!((function.lambda()[3] - 0.25).abs() < 1e-15);
        assert!(
            line(0.499)
                .shortfalls()
                .iter()
                .all(|&shortfall| shortfall < 0.0)
        );
    }
}
