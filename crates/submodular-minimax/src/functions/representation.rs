//! Eq. (1) of the exploration paper, for any score s ≥ 0 and any cost λ ≥ 0.

use super::error::{FunctionError, non_negative};
use super::modular::Modular;
use super::similarity::Similarity;
use crate::joint_function::JointFunction;
use crate::set_function::{Growth, SetFunction};
use crate::subset::Subset;

/// What X leaves out is worth what the best representative in Y gives it:
///
/// ```text
/// f(X ∪ Y) = Σ_{v ∈ N₁ \ X} max_{u ∈ Y} s(u, v) − γ Σ_{u ∈ Y} Σ_{w ∈ Y} s(u, w) + Σ_{v ∈ X} λ(v)
/// ```
///
/// with max over the empty Y := 0, so that f(∅) = 0. Jointly submodular for every matrix s ≥ 0,
/// symmetric or not, and every γ ≥ 0; modular in X. Not negative for |Y| ≤ k if
/// min(1, λ_min / s_max) ≥ γ k. The paper's γ is 1/n. Where N₁ and N₂ differ, the columns of s are N₁,
/// its rows N₂, and the γ term takes only the pairs (u, w) with w < |N₁|; use γ = 0 there.
#[derive(Debug, Clone)]
pub struct Representation<S> {
    similarity: S,
    lambda: Vec<f64>,
    gamma: f64,
}

impl<S: Similarity> Representation<S> {
    /// `lambda[v]` = what it costs to take v into X; `gamma` = the weight of the spread term.
    ///
    /// # Errors
    /// A list of the wrong length, an entry that is negative or not finite.
    pub fn new(similarity: S, lambda: Vec<f64>, gamma: f64) -> Result<Self, FunctionError> {
        non_negative("lambda", &lambda, similarity.column_count())?;
        non_negative("gamma", &[gamma], 1)?;
        Ok(Self {
            similarity,
            lambda,
            gamma,
        })
    }

    /// Without checks, for entries that are right by construction.
    pub(crate) fn trusted(similarity: S, lambda: Vec<f64>, gamma: f64) -> Self {
        Self {
            similarity,
            lambda,
            gamma,
        }
    }

    /// λ, one entry an element of N₁.
    #[must_use]
    pub fn lambda(&self) -> &[f64] {
        &self.lambda
    }

    /// max over u ∈ Y of s(u, v) for every v.
    fn best(&self, y: &Subset) -> Vec<f64> {
        let mut best = vec![0.0; self.lambda.len()];
        for u in y.iter() {
            self.similarity
                .for_each(u, &mut |v, s| best[v] = s.max(best[v]));
        }
        best
    }

    /// Σ over ordered pairs of Y of s(u, w).
    fn spread(&self, y: &Subset) -> f64 {
        let mut sum = 0.0;
        for u in y.iter() {
            self.similarity.for_each(u, &mut |w, s| {
                if y.contains(w) {
                    sum += s;
                }
            });
        }
        sum
    }
}

impl<S: Similarity> JointFunction for Representation<S> {
    fn x_size(&self) -> usize {
        self.similarity.column_count()
    }

    fn y_size(&self) -> usize {
        self.similarity.row_count()
    }

    fn value(&self, x: &Subset, y: &Subset) -> f64 {
        let best = self.best(y);
        let served = |v: usize| {
            if x.contains(v) {
                self.lambda[v]
            } else {
                best[v]
            }
        };
        (0..best.len()).map(served).sum::<f64>() - self.gamma * self.spread(y)
    }

    fn given_x<'a>(&'a self, x: &Subset) -> Box<dyn SetFunction + 'a> {
        Box::new(Responses {
            function: self,
            x: x.clone(),
        })
    }

    fn modular_given_y(&self, y: &Subset) -> Option<Modular> {
        let best = self.best(y);
        let constant = best.iter().sum::<f64>() - self.gamma * self.spread(y);
        let weights = self
            .lambda
            .iter()
            .zip(&best)
            .map(|(lambda, best)| lambda - best)
            .collect();
        Some(Modular { constant, weights })
    }
}

/// Y ↦ f(X ∪ Y).
struct Responses<'a, S> {
    function: &'a Representation<S>,
    x: Subset,
}

impl<S: Similarity> SetFunction for Responses<'_, S> {
    fn ground_size(&self) -> usize {
        self.function.y_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.function.value(&self.x, set)
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        let n = self.function.lambda.len();
        let mut response = Response {
            function: self.function,
            x: &self.x,
            best: vec![0.0; n],
            toward: vec![0.0; n],
            members: Subset::empty(self.function.y_size()),
            value: self.x.iter().map(|v| self.function.lambda[v]).sum(),
        };
        for element in base.iter() {
            response.insert(element);
        }
        Box::new(response)
    }
}

struct Response<'a, S> {
    function: &'a Representation<S>,
    x: &'a Subset,
    /// max over u ∈ Y of s(u, v).
    best: Vec<f64>,
    /// Σ over u ∈ Y of s(u, w).
    toward: Vec<f64>,
    members: Subset,
    value: f64,
}

impl<S: Similarity> Growth for Response<'_, S> {
    fn value(&self) -> f64 {
        self.value
    }

    fn gain(&self, element: usize) -> f64 {
        if self.members.contains(element) {
            return 0.0;
        }
        let (mut gain, mut spread) = (0.0, self.toward.get(element).copied().unwrap_or(0.0));
        self.function.similarity.for_each(element, &mut |v, s| {
            if s > self.best[v] && !self.x.contains(v) {
                gain += s - self.best[v];
            }
            if v == element || self.members.contains(v) {
                spread += s;
            }
        });
        gain - self.function.gamma * spread
    }

    fn insert(&mut self, element: usize) {
        self.value += self.gain(element);
        if self.members.insert(element) {
            let (best, toward) = (&mut self.best, &mut self.toward);
            self.function.similarity.for_each(element, &mut |v, s| {
                best[v] = s.max(best[v]);
                toward[v] += s;
            });
        }
    }

    fn members(&self) -> &Subset {
        &self.members
    }
}
