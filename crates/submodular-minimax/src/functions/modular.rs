//! Modular functions: a constant and a weight an element.

use crate::set_function::SetFunction;
use crate::subset::Subset;

/// f(S) = constant + Σ_{e ∈ S} weight(e). Weights may be negative.
#[derive(Debug, Clone, PartialEq)]
pub struct Modular {
    /// f(∅).
    pub constant: f64,
    /// One weight an element.
    pub weights: Vec<f64>,
}

impl Modular {
    /// The zero function of `ground` elements.
    #[must_use]
    pub fn zero(ground: usize) -> Self {
        Self {
            constant: 0.0,
            weights: vec![0.0; ground],
        }
    }

    /// Adds `factor` times another modular function of the same elements.
    pub fn add_scaled(&mut self, factor: f64, other: &Self) {
        self.constant += factor * other.constant;
        for (weight, more) in self.weights.iter_mut().zip(&other.weights) {
            *weight += factor * more;
        }
    }

    /// The smallest minimiser: exactly the elements of negative weight.
    #[must_use]
    pub fn minimizer(&self) -> Subset {
        let negative = (0..self.weights.len()).filter(|&e| self.weights[e] < 0.0);
        Subset::from_indices(self.weights.len(), negative)
    }
}

impl SetFunction for Modular {
    fn ground_size(&self) -> usize {
        self.weights.len()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.constant + set.iter().map(|e| self.weights[e]).sum::<f64>()
    }

    fn as_modular(&self) -> Option<Modular> {
        Some(self.clone())
    }
}
