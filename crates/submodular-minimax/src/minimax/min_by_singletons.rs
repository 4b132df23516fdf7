//! Min-by-Singletons: minimise h(X) = f(X) + Σᵤ f(X ∪ {u}), which bounds every response from above.
//!
//! f(X ∪ Y) ≤ f(X) + Σ over u ∈ Y of [f(X ∪ {u}) − f(X)] ≤ h(X), by submodularity in Y and f ≥ 0; and each of the
//! |N₂| + 1 terms of h(X) is at most max over Y of f(X ∪ Y), as long as ∅ and single elements are allowed responses.
//! Cost: one minimisation of a sum of |N₂| + 1 functions.

use super::solution::{MinimaxError, MinimaxSolution, finish, minimize};
use crate::StopReason;
use crate::functions::Modular;
use crate::joint_function::JointFunction;
use crate::maximize::Maximizer;
use crate::minimize::Minimizer;
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// An (|N₂| + 1)-approximation of min-max for disjointly submodular f ≥ 0.
///
/// `oracle` only answers the final X, for the value and the certificate.
///
/// ```
/// use submodular_minimax::functions::{Dense, Representation};
/// use submodular_minimax::maximize::LazyGreedy;
/// use submodular_minimax::minimax::min_by_singletons;
/// use submodular_minimax::minimize::MinNormPoint;
/// let loss = Dense::new(2, 3, vec![0.9, 0.9, 0.0, 0.4, 0.4, 0.4])?;
/// let function = Representation::new(loss, vec![0.3; 3], 0.0)?;
/// let found = min_by_singletons(&function, &mut LazyGreedy::cardinality(1), &MinNormPoint::default())?;
/// assert_eq!(found.x.iter().collect::<Vec<_>>(), [0, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Whatever the oracle or the minimiser reports.
pub fn min_by_singletons<F: JointFunction + ?Sized>(
    function: &F,
    oracle: &mut dyn Maximizer,
    minimizer: &dyn Minimizer,
) -> Result<MinimaxSolution, MinimaxError> {
    let least = minimize(&Singletons { function }, minimizer)?;
    let rounds = (1, StopReason::Converged);
    finish(
        function,
        least.set,
        f64::NEG_INFINITY,
        rounds,
        oracle,
        minimizer,
    )
}

/// h(X) = f(X) + Σ_{u ∈ N₂} f(X ∪ {u}).
struct Singletons<'a, F: ?Sized> {
    function: &'a F,
}

impl<F: JointFunction + ?Sized> Singletons<'_, F> {
    fn responses(&self) -> impl Iterator<Item = Subset> + '_ {
        let n2 = self.function.y_size();
        let alone = (0..n2).map(move |u| Subset::from_indices(n2, [u]));
        std::iter::once(Subset::empty(n2)).chain(alone)
    }
}

impl<F: JointFunction + ?Sized> SetFunction for Singletons<'_, F> {
    fn ground_size(&self) -> usize {
        self.function.x_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.responses().map(|y| self.function.value(set, &y)).sum()
    }

    fn as_modular(&self) -> Option<Modular> {
        let mut sum = Modular::zero(self.function.x_size());
        for y in self.responses() {
            sum.add_scaled(1.0, &self.function.modular_given_y(&y)?);
        }
        Some(sum)
    }
}
