//! What a minimax algorithm returns, and the bounds computed from it.

use super::{Certificate, StopReason};
use crate::joint_function::{GivenY, JointFunction};
use crate::maximize::{Constraint, MaximizeError, Maximizer};
use crate::minimize::{MinimizeError, Minimizer, ModularMinimizer};
use crate::set_function::SetFunction;
use crate::subset::Subset;
use thiserror::Error;

/// What a minimax algorithm found.
#[derive(Debug, Clone, PartialEq)]
pub struct MinimaxSolution {
    /// The minimiser's set.
    pub x: Subset,
    /// The strongest response found to it.
    pub y: Subset,
    /// f(x ∪ y).
    pub value: f64,
    /// Rounds of the algorithm.
    pub iterations: usize,
    /// Why it stopped.
    pub stop: StopReason,
    /// Bounds on how far the solution is from the best one.
    pub certificate: Certificate,
}

/// Why a minimax algorithm cannot run.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MinimaxError {
    /// The maximiser failed.
    #[error(transparent)]
    Maximize(#[from] MaximizeError),
    /// The minimiser failed.
    #[error(transparent)]
    Minimize(#[from] MinimizeError),
    /// A setting is outside its range.
    #[error("{field} = {value} is out of range: it must be {range}")]
    Setting {
        /// The field.
        field: &'static str,
        /// What it was.
        value: f64,
        /// What it must be.
        range: &'static str,
    },
}

/// The closed form if the function is modular, else the given minimiser.
pub(super) fn minimize(
    function: &dyn SetFunction,
    minimizer: &dyn Minimizer,
) -> Result<crate::minimize::Minimum, MinimaxError> {
    match ModularMinimizer.minimize(function) {
        Err(MinimizeError::NotModular) => Ok(minimizer.minimize(function)?),
        other => Ok(other?),
    }
}

/// min over X of f(X ∪ Y), bounded from below: a lower bound on τ.
pub(super) fn response_bound<F: JointFunction + ?Sized>(
    function: &F,
    y: &Subset,
    minimizer: &dyn Minimizer,
) -> Result<f64, MinimaxError> {
    let given = GivenY {
        function,
        y: y.clone(),
    };
    Ok(minimize(&given, minimizer)?.lower_bound)
}

/// max over the allowed Y of f(X ∪ Y), bounded from above.
pub(super) fn worst_response_bound<F: JointFunction + ?Sized>(
    function: &F,
    x: &Subset,
    constraint: &Constraint,
) -> f64 {
    constraint.upper_bound(function.given_x(x).as_ref())
}

/// Answers X once more with the oracle and closes the books.
pub(super) fn finish<F: JointFunction + ?Sized>(
    function: &F,
    x: Subset,
    lower_bound: f64,
    (iterations, stop): (usize, StopReason),
    oracle: &mut dyn Maximizer,
    minimizer: &dyn Minimizer,
) -> Result<MinimaxSolution, MinimaxError> {
    let answer = oracle.maximize(function.given_x(&x).as_ref())?;
    let lower_bound = lower_bound.max(response_bound(function, &answer.set, minimizer)?);
    let upper_bound = worst_response_bound(function, &x, oracle.constraint());
    let certificate = Certificate {
        lower_bound,
        upper_bound: upper_bound.max(answer.value),
    };
    Ok(MinimaxSolution {
        x,
        y: answer.set,
        value: answer.value,
        iterations,
        stop,
        certificate,
    })
}
