//! Min-as-Oracle: max-min by maximising g(Y) = min over X of f(X ∪ Y).
//!
//! g is submodular if f is jointly submodular, so the maximiser's factor carries over where g is
//! monotone. Each gain costs one minimisation over X.

use super::solution::{MinimaxError, MinimaxSolution, minimize};
use super::{Certificate, StopReason};
use crate::joint_function::{GivenY, JointFunction};
use crate::maximize::Maximizer;
use crate::minimize::Minimizer;
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// Approximates max over Y of min over X of a jointly submodular f.
///
/// The certificate brackets the max-min value: `lower_bound` is what the returned Y guarantees, the
/// upper bound follows from g's submodularity.
///
/// ```
/// use submodular_minimax::functions::{Dense, Representation};
/// use submodular_minimax::maximize::LazyGreedy;
/// use submodular_minimax::minimax::min_as_oracle;
/// use submodular_minimax::minimize::MinNormPoint;
/// // Which demand costs most, once whoever loses more than 0.5 to it has moved for 0.5?
/// let loss = Dense::new(2, 3, vec![0.9, 0.9, 0.0, 0.4, 0.4, 0.4])?;
/// let function = Representation::new(loss, vec![0.5; 3], 0.0)?;
/// let found = min_as_oracle(&function, &mut LazyGreedy::cardinality(1), &MinNormPoint::default())?;
/// assert_eq!(found.y.iter().collect::<Vec<_>>(), [1]);
/// assert!((found.value - 1.2).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Whatever the maximiser or the minimiser reports; a minimiser that fails on some Y makes the gain
/// NaN, which the maximiser reports.
pub fn min_as_oracle<F: JointFunction + ?Sized>(
    function: &F,
    oracle: &mut dyn Maximizer,
    minimizer: &dyn Minimizer,
) -> Result<MinimaxSolution, MinimaxError> {
    let inner = InnerMinimum {
        function,
        minimizer,
    };
    let best = oracle.maximize(&inner)?;
    let reply = minimize(
        &GivenY {
            function,
            y: best.set.clone(),
        },
        minimizer,
    )?;
    let upper_bound = oracle.constraint().upper_bound(&inner).max(reply.value);
    Ok(MinimaxSolution {
        x: reply.set,
        y: best.set,
        value: reply.value,
        iterations: best.picks.len(),
        stop: StopReason::Converged,
        certificate: Certificate {
            lower_bound: reply.lower_bound,
            upper_bound,
        },
    })
}

struct InnerMinimum<'a, F: ?Sized> {
    function: &'a F,
    minimizer: &'a dyn Minimizer,
}

impl<F: JointFunction + ?Sized> SetFunction for InnerMinimum<'_, F> {
    fn ground_size(&self) -> usize {
        self.function.y_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        let given = GivenY {
            function: self.function,
            y: set.clone(),
        };
        minimize(&given, self.minimizer).map_or(f64::NAN, |minimum| minimum.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::{Dense, Representation};
    use crate::laws::submodularity;
    use crate::minimize::BruteForce;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_inner_minimum_is_submodular(values in prop::collection::vec(0.0..1.0_f64, 25), lambda in 0.0..1.0_f64) {
            let similarity = Dense::new(5, 5, values).unwrap();
            let function = Representation::new(similarity, vec![lambda; 5], 0.2).unwrap();
            let inner = InnerMinimum { function: &function, minimizer: &BruteForce };
            prop_assert_eq!(submodularity(&inner, 1e-9), None);
        }
    }
}
