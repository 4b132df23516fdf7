//! What one would try first: alternate best responses, or answer the maximiser once.

use super::solution::{
    MinimaxError, MinimaxSolution, finish, minimize, response_bound, worst_response_bound,
};
use super::{MinimaxConfig, StopReason};
use crate::joint_function::{GivenY, JointFunction};
use crate::maximize::Maximizer;
use crate::minimize::Minimizer;
use crate::subset::Subset;

/// Alternates Y = argmax f(X ∪ ·) and X = argmin f(· ∪ Y) and keeps the X with the best upper bound.
///
/// Stops when X repeats, or after `config.max_iterations` or 100 rounds: it may cycle. No guarantee.
///
/// # Errors
/// Settings out of range, whatever the oracle or the minimiser reports.
pub fn best_response<F: JointFunction + ?Sized>(
    function: &F,
    oracle: &mut dyn Maximizer,
    minimizer: &dyn Minimizer,
    config: &MinimaxConfig,
) -> Result<MinimaxSolution, MinimaxError> {
    config.validate()?;
    let nothing = Subset::empty(function.y_size());
    let mut x = minimize(
        &GivenY {
            function,
            y: nothing,
        },
        minimizer,
    )?
    .set;
    let mut best = (
        worst_response_bound(function, &x, oracle.constraint()),
        x.clone(),
    );
    let mut lower_bound = f64::NEG_INFINITY;
    let mut seen = vec![x.clone()];
    let mut stop = StopReason::IterationLimit;
    for _ in 0..config.max_iterations.min(100) {
        let y = oracle.maximize(function.given_x(&x).as_ref())?.set;
        lower_bound = lower_bound.max(response_bound(function, &y, minimizer)?);
        x = minimize(&GivenY { function, y }, minimizer)?.set;
        if seen.contains(&x) {
            stop = StopReason::Converged;
            break;
        }
        let upper = worst_response_bound(function, &x, oracle.constraint());
        if upper < best.0 {
            best = (upper, x.clone());
        }
        seen.push(x.clone());
    }
    finish(
        function,
        best.1,
        lower_bound,
        (seen.len(), stop),
        oracle,
        minimizer,
    )
}

/// Y = argmax f(Y), then X = argmin f(X ∪ Y). No guarantee.
///
/// # Errors
/// Whatever the oracle or the minimiser reports.
pub fn max_then_min<F: JointFunction + ?Sized>(
    function: &F,
    oracle: &mut dyn Maximizer,
    minimizer: &dyn Minimizer,
) -> Result<MinimaxSolution, MinimaxError> {
    let nothing = Subset::empty(function.x_size());
    let y = oracle.maximize(function.given_x(&nothing).as_ref())?.set;
    let reply = minimize(&GivenY { function, y }, minimizer)?;
    let rounds = (1, StopReason::Converged);
    finish(
        function,
        reply.set,
        reply.lower_bound,
        rounds,
        oracle,
        minimizer,
    )
}
