//! New functions from old ones: weighted sums and restrictions keep submodularity.

use super::error::{FunctionError, non_negative};
use super::modular::Modular;
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// f(S) = Σ weight(i) fᵢ(S), weights at least 0.
pub struct WeightedSum<'a> {
    terms: Vec<(f64, Box<dyn SetFunction + 'a>)>,
    ground: usize,
}

impl<'a> WeightedSum<'a> {
    /// Sums functions of one ground set; no term is the zero function of no elements.
    ///
    /// # Errors
    /// A weight that is negative or not finite, ground sets of different sizes.
    pub fn new(terms: Vec<(f64, Box<dyn SetFunction + 'a>)>) -> Result<Self, FunctionError> {
        let weights: Vec<f64> = terms.iter().map(|term| term.0).collect();
        non_negative("weights", &weights, terms.len())?;
        let expected = terms.first().map_or(0, |term| term.1.ground_size());
        for (_, function) in &terms {
            let found = function.ground_size();
            if found != expected {
                return Err(FunctionError::Length {
                    what: "ground set",
                    found,
                    expected,
                });
            }
        }
        Ok(Self {
            terms,
            ground: expected,
        })
    }
}

impl SetFunction for WeightedSum<'_> {
    fn ground_size(&self) -> usize {
        self.ground
    }

    fn value(&self, set: &Subset) -> f64 {
        self.terms
            .iter()
            .map(|(weight, function)| weight * function.value(set))
            .sum()
    }

    fn as_modular(&self) -> Option<Modular> {
        let mut sum = Modular {
            constant: 0.0,
            weights: vec![0.0; self.ground],
        };
        for (weight, function) in &self.terms {
            let term = function.as_modular()?;
            sum.constant += weight * term.constant;
            for (total, part) in sum.weights.iter_mut().zip(&term.weights) {
                *total += weight * part;
            }
        }
        Some(sum)
    }
}

/// f(base ∪ {kept(i) : i ∈ S}): some elements may be chosen, some are fixed in, the rest fixed out.
pub struct Restriction<F> {
    function: F,
    base: Subset,
    kept: Vec<usize>,
}

impl<F: SetFunction> Restriction<F> {
    /// Element i of the new ground set is element `kept[i]` of the old one.
    ///
    /// # Errors
    /// An element of `kept` or `base` outside the old ground set.
    pub fn new(function: F, base: &[usize], kept: Vec<usize>) -> Result<Self, FunctionError> {
        let size = function.ground_size();
        for (what, list) in [("base", base), ("kept", &kept[..])] {
            if let Some(index) = list.iter().position(|&e| e >= size) {
                let element = list[index];
                return Err(FunctionError::OutOfRange {
                    what,
                    index,
                    element,
                    size,
                });
            }
        }
        let base = Subset::from_indices(size, base.iter().copied());
        Ok(Self {
            function,
            base,
            kept,
        })
    }
}

impl<F: SetFunction> SetFunction for Restriction<F> {
    fn ground_size(&self) -> usize {
        self.kept.len()
    }

    fn value(&self, set: &Subset) -> f64 {
        let mut whole = self.base.clone();
        for element in set.iter() {
            whole.insert(self.kept[element]);
        }
        self.function.value(&whole)
    }
}
