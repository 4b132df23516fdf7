//! Algorithm 1 on an outlier problem: in closed form, or iteration by iteration.

use super::config::{OutlierConfig, Solver};
use super::error::OutlierError;
use super::problem::Problem;
use super::removal::OutlierRemoval;
use crate::joint_function::JointFunction;
use crate::maximize::{Constraint, LazyGreedy, Maximizer};
use crate::minimax::{Beta, Certificate, MinimaxConfig, StopReason, iterative_x_growing};
use crate::minimize::ModularMinimizer;
use crate::subset::Subset;

/// Solves the problem and splits the points.
pub(super) fn solve(
    problem: &Problem,
    config: &OutlierConfig,
) -> Result<OutlierRemoval, OutlierError> {
    let function = problem.function();
    let k = problem.representatives(config.max_representatives);
    let mut oracle = LazyGreedy {
        constraint: Constraint::Cardinality(k),
    };
    let scores = problem.shortfalls();
    let n = scores.len();
    if config.solver == Solver::IterativeXGrowing {
        let settings = MinimaxConfig {
            beta: Beta::Fixed(problem.beta),
            ..Default::default()
        };
        let grown = iterative_x_growing(&function, &mut oracle, &ModularMinimizer, &settings)?;
        let (kept, removed) = (0..n).partition(|&v| grown.x.contains(v));
        let (iterations, certificate, stop) = (grown.iterations, grown.certificate, grown.stop);
        return Ok(OutlierRemoval {
            kept,
            removed,
            scores,
            iterations,
            certificate,
            stop,
        });
    }
    let (removed, kept): (Vec<usize>, Vec<usize>) = (0..n).partition(|&v| scores[v] >= 0.0);
    // Truncated scores leave nothing to gain against the closed form: its value is the cost of X.
    let upper_bound = kept.iter().map(|&v| function.lambda()[v]).sum();
    let answer = oracle.maximize(function.given_x(&Subset::empty(n)).as_ref())?;
    let reply = function.modular_given_y(&answer.set);
    let lower_bound = reply.map_or(0.0, |m| {
        m.constant + m.weights.iter().map(|w| w.min(0.0)).sum::<f64>()
    });
    Ok(OutlierRemoval {
        kept,
        removed,
        scores,
        iterations: 1,
        certificate: Certificate {
            lower_bound: lower_bound.max(0.0),
            upper_bound,
        },
        stop: StopReason::ClosedForm,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::neighbours::{NeighbourGraph, RangeTree};
    use crate::outlier::problem::Score;

    #[test]
    fn points_that_only_reach_their_bar_are_removed_by_both_solvers() {
        let points: Vec<[f64; 3]> = (0..10).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        for solver in [Solver::ClosedForm, Solver::IterativeXGrowing] {
            let (reach, weight) = (2.0, vec![1.0; 10]);
            let problem = Problem {
                graph: NeighbourGraph::new(&RangeTree::new(&points, &[]), 4, f64::INFINITY),
                score: Score::Kernel { reach, weight },
                threshold: vec![0.5; 10],
                beta: 1.0,
            };
            let config = OutlierConfig {
                solver,
                ..OutlierConfig::nearest()
            };
            let found = solve(&problem, &config).unwrap();
            assert_eq!(found.removed, (0..10).collect::<Vec<_>>(), "{solver:?}");
        }
    }
}
