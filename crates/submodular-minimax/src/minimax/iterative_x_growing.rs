//! Iterative-X-Growing: X grows by what the current worst response makes worth having.
//!
//! ```text
//! 1  X₀ = argmin_X f(X), i = 0
//! 3  i += 1
//! 4  Yᵢ ≈ argmax_Y f(Xᵢ₋₁ ∪ Y)                        (oracle of factor α)
//! 5  X′ᵢ = argmin_X β f(X ∪ Xᵢ₋₁) + f(X ∪ Yᵢ)          (exact)
//! 6  Xᵢ = Xᵢ₋₁ ∪ X′ᵢ
//! 7  until X′ᵢ ⊆ Xᵢ₋₁, then return Xᵢ₋₁
//! ```
//!
//! Let τ = min over X of max over Y of f(X ∪ Y), X* a set that reaches it, f ≥ 0 jointly submodular and ∅ an
//! allowed response.
//! - f(X* ∪ Xᵢ) ≤ (1 + i/β) τ. For i = 0: X₀ minimises f, hence f(X₀ ∪ X*) ≤ f(X*) ≤ τ. Then: X′ᵢ minimises the
//!   submodular gᵢ of line 5, hence gᵢ(X′ᵢ ∪ X*) ≤ gᵢ(X*); drop the second term on the left and use f(X* ∪ Yᵢ) ≤ τ.
//! - f(Xᵢ) ≤ f(X* ∪ Xᵢ₋₁) + τ/β, from gᵢ(X′ᵢ) ≤ gᵢ(X*) in the same way.
//! - At the end, X′ ⊆ X: f(X ∪ Y) ≤ f(X) + f(X′ ∪ Y) − f(X′) ≤ f(X) + (β + 1) τ by submodularity and line 5.
//!
//! Together, with Y no worse than α times the worst response, in T rounds: max over Y of f(X ∪ Y) ≤ (2 + T/β + β) τ / α.
//!
//! Cost: at most |N₁| + 1 rounds of one oracle call and one minimisation each, whatever oracle and minimiser answer.

use super::solution::{MinimaxError, MinimaxSolution, finish, minimize, response_bound};
use super::{MinimaxConfig, StopReason};
use crate::functions::Modular;
use crate::joint_function::{GivenY, JointFunction};
use crate::maximize::Maximizer;
use crate::minimize::Minimizer;
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// Approximates min over X of max over Y of a jointly submodular f ≥ 0.
///
/// `oracle` answers line 4, `minimizer` lines 1 and 5; where the function is modular in X the closed
/// form is taken instead. Guarantee: max over Y of f(X ∪ Y) ≤ (2 + T/β + β) τ / α after T rounds; what holds for
/// the solution itself, its [`Certificate`](super::Certificate) says.
///
/// ```
/// use submodular_minimax::functions::{Dense, Representation};
/// use submodular_minimax::maximize::LazyGreedy;
/// use submodular_minimax::minimax::iterative_x_growing;
/// use submodular_minimax::minimize::MinNormPoint;
/// use submodular_minimax::{MinimaxConfig, StopReason};
/// // Four places in a row; whoever stands there himself pays 0.2, the others what the worst demand takes.
/// let loss = Dense::from_fn(4, 4, |u, v| 1.0 / (1.0 + u.abs_diff(v) as f64))?;
/// let function = Representation::new(loss, vec![0.2; 4], 0.0)?;
/// let mut worst = LazyGreedy::cardinality(1);
/// let found =
///     iterative_x_growing(&function, &mut worst, &MinNormPoint::default(), &MinimaxConfig::paper())?;
/// assert_eq!((found.x.len(), found.stop), (4, StopReason::Exhausted));
/// assert!(found.value <= found.certificate.upper_bound);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Settings out of range, whatever the oracle or the minimiser reports.
pub fn iterative_x_growing<F: JointFunction + ?Sized>(
    function: &F,
    oracle: &mut dyn Maximizer,
    minimizer: &dyn Minimizer,
    config: &MinimaxConfig,
) -> Result<MinimaxSolution, MinimaxError> {
    config.validate()?;
    let n = function.x_size();
    let beta = config.beta.value(n);
    let nothing = Subset::empty(function.y_size());
    let first = minimize(
        &GivenY {
            function,
            y: nothing,
        },
        minimizer,
    )?;
    let (mut x, mut lower_bound) = (Subset::empty(n).union(&first.set), first.lower_bound);
    let (mut iterations, mut stop) = (0, StopReason::IterationLimit);
    // X grows in every round but the last, whatever the minimiser answers, hence |N₁| + 1 rounds at most.
    while iterations < config.max_iterations.min(n + 1) {
        iterations += 1;
        let answer = oracle.maximize(function.given_x(&x).as_ref())?;
        lower_bound = lower_bound.max(response_bound(function, &answer.set, minimizer)?);
        let growth = GrowthObjective {
            function,
            beta,
            before: &x,
            y: answer.set,
        };
        let grown = x.union(&minimize(&growth, minimizer)?.set);
        if grown.len() == x.len() {
            stop = StopReason::Converged;
            break;
        }
        x = grown;
        if x.len() == n {
            stop = StopReason::Exhausted;
            break;
        }
    }
    finish(
        function,
        x,
        lower_bound,
        (iterations, stop),
        oracle,
        minimizer,
    )
}

/// Line 5: X ↦ β f(X ∪ before) + f(X ∪ Y).
struct GrowthObjective<'a, F: ?Sized> {
    function: &'a F,
    beta: f64,
    before: &'a Subset,
    y: Subset,
}

impl<F: JointFunction + ?Sized> SetFunction for GrowthObjective<'_, F> {
    fn ground_size(&self) -> usize {
        self.function.x_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        let nothing = Subset::empty(self.function.y_size());
        self.beta * self.function.value(&set.union(self.before), &nothing)
            + self.function.value(set, &self.y)
    }

    fn as_modular(&self) -> Option<Modular> {
        let alone = self
            .function
            .modular_given_y(&Subset::empty(self.function.y_size()))?;
        let mut sum = self.function.modular_given_y(&self.y)?;
        sum.constant += self.beta * alone.value(self.before);
        for (v, weight) in sum.weights.iter_mut().enumerate() {
            if !self.before.contains(v) {
                *weight += self.beta * alone.weights[v];
            }
        }
        Some(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::{Dense, Representation};
    use crate::maximize::Greedy;
    use crate::minimize::{BruteForce, MinimizeError, MinimizeStop, Minimum};

    /// A minimiser that always wants an element that X does not have.
    struct Stubborn;

    impl Minimizer for Stubborn {
        fn minimize(&self, function: &dyn SetFunction) -> Result<Minimum, MinimizeError> {
            Ok(Minimum {
                set: Subset::from_indices(9, [8]),
                value: function.value(&Subset::empty(function.ground_size())),
                lower_bound: 0.0,
                iterations: 1,
                stop: MinimizeStop::Optimal,
            })
        }
    }

    /// f(X ∪ Y) = |Y| without a closed form.
    struct Count;

    impl JointFunction for Count {
        fn x_size(&self) -> usize {
            4
        }
        fn y_size(&self) -> usize {
            4
        }
        fn value(&self, _x: &Subset, y: &Subset) -> f64 {
            y.len() as f64
        }
    }

    #[test]
    fn an_answer_outside_the_ground_set_does_not_keep_it_going() {
        let run = |minimizer: &dyn Minimizer, max_iterations| {
            let config = MinimaxConfig {
                max_iterations,
                ..MinimaxConfig::default()
            };
            let mut oracle = Greedy::cardinality(1);
            iterative_x_growing(&Count, &mut oracle, minimizer, &config).unwrap()
        };
        for max_iterations in [1, 2, usize::MAX] {
            for minimizer in [&Stubborn as &dyn Minimizer, &BruteForce] {
                let found = run(minimizer, max_iterations);
                assert_eq!((found.iterations, found.stop), (1, StopReason::Converged));
                assert_eq!(found.x, Subset::empty(4));
            }
        }
    }

    #[test]
    fn line_5_in_closed_form_is_line_5() {
        let similarity = Dense::from_fn(5, 5, |u, v| ((3 * u + 5 * v) % 7) as f64 / 7.0).unwrap();
        let function = Representation::new(similarity, vec![0.3; 5], 0.2).unwrap();
        for before in 0..32 {
            let before = Subset::from_mask(5, before);
            let growth = GrowthObjective {
                function: &function,
                beta: 0.7,
                before: &before,
                y: Subset::from_indices(5, [1, 4]),
            };
            let closed = growth.as_modular().unwrap();
            for set in 0..32 {
                let set = Subset::from_mask(5, set);
                let before = set.union(growth.before);
                let nothing = Subset::empty(5);
                let wanted =
                    0.7 * function.value(&before, &nothing) + function.value(&set, &growth.y);
                assert!((growth.value(&set) - wanted).abs() < 1e-12);
                assert!((closed.value(&set) - wanted).abs() < 1e-12);
            }
        }
    }
}
