//! Facility location: how well do the chosen facilities serve every client?

use super::error::{FunctionError, non_negative};
use super::similarity::Similarity;
use crate::set_function::{Growth, SetFunction};
use crate::subset::Subset;

/// f(S) = Σ_v weight(v) min(cap(v), max_{u ∈ S} s(u, v)). Monotone submodular, f(∅) = 0.
///
/// Plain without caps and weights; truncated with caps, which is the max-min side of Eq. (1): its
/// best response to Y costs Σ min(m_v(Y), λ_v). A gain costs one row of s; over points there is
/// [`FacilityLocation::greedy`], which computes few of them.
///
/// ```
/// use submodular_minimax::functions::{Dense, FacilityLocation};
/// use submodular_minimax::maximize::{LazyGreedy, Maximizer};
/// let similarity = Dense::new(3, 2, vec![0.9, 0.1, 0.0, 0.8, 0.5, 0.5])?;
/// let best = LazyGreedy::cardinality(2).maximize(&FacilityLocation::new(similarity))?;
/// assert_eq!(best.picks, [0, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct FacilityLocation<S> {
    similarity: S,
    caps: Option<Vec<f64>>,
    weights: Option<Vec<f64>>,
}

impl<S: Similarity> FacilityLocation<S> {
    /// The plain function.
    pub fn new(similarity: S) -> Self {
        Self {
            similarity,
            caps: None,
            weights: None,
        }
    }

    /// Serves client v at most up to `caps[v]`.
    ///
    /// # Errors
    /// A list of the wrong length, an entry that is negative or not finite.
    pub fn truncated(mut self, caps: Vec<f64>) -> Result<Self, FunctionError> {
        non_negative("caps", &caps, self.similarity.column_count())?;
        self.caps = Some(caps);
        Ok(self)
    }

    /// Counts client v `weights[v]` times.
    ///
    /// # Errors
    /// A list of the wrong length, an entry that is negative or not finite.
    pub fn weighted(mut self, weights: Vec<f64>) -> Result<Self, FunctionError> {
        non_negative("weights", &weights, self.similarity.column_count())?;
        self.weights = Some(weights);
        Ok(self)
    }

    /// The similarities.
    pub fn similarity(&self) -> &S {
        &self.similarity
    }

    /// How often client v counts.
    pub(super) fn weight(&self, v: usize) -> f64 {
        self.weights.as_ref().map_or(1.0, |weights| weights[v])
    }

    pub(super) fn is_truncated(&self) -> bool {
        self.caps.is_some()
    }

    pub(super) fn serving<'a>(&'a self, base: &Subset) -> Serving<'a, S> {
        let mut serving = Serving {
            function: self,
            served: vec![0.0; self.similarity.column_count()],
            members: Subset::empty(self.similarity.row_count()),
            value: 0.0,
        };
        for element in base.iter() {
            serving.insert(element);
        }
        serving
    }
}

impl<S: Similarity> SetFunction for FacilityLocation<S> {
    fn ground_size(&self) -> usize {
        self.similarity.row_count()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.serving(set).value
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        Box::new(self.serving(base))
    }
}

/// How well every client is served so far.
pub(super) struct Serving<'a, S> {
    function: &'a FacilityLocation<S>,
    pub(super) served: Vec<f64>,
    members: Subset,
    value: f64,
}

impl<S: Similarity> Growth for Serving<'_, S> {
    fn value(&self) -> f64 {
        self.value
    }

    fn gain(&self, element: usize) -> f64 {
        let (caps, weights) = (
            self.function.caps.as_deref(),
            self.function.weights.as_deref(),
        );
        self.function
            .similarity
            .gain(element, &self.served, caps, weights)
    }

    fn insert(&mut self, element: usize) {
        self.value += self.gain(element);
        self.members.insert(element);
        let served = &mut self.served;
        let caps = self.function.caps.as_deref();
        self.function.similarity.for_each(element, &mut |v, s| {
            let capped = caps.map_or(s, |caps| s.min(caps[v]));
            served[v] = capped.max(served[v]);
        });
    }

    fn members(&self) -> &Subset {
        &self.members
    }
}
