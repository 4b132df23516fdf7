//! New functions from old ones: weighted sums and restrictions keep submodularity.

use super::error::{FunctionError, non_negative};
use super::modular::Modular;
use crate::set_function::{Growth, SetFunction};
use crate::subset::Subset;

/// f(S) = Σ weight(i) fᵢ(S), weights at least 0. A gain costs one gain of every term.
///
/// ```
/// use submodular_minimax::functions::{Coverage, Modular, WeightedSum};
/// use submodular_minimax::maximize::{Greedy, Maximizer};
/// let reached = Coverage::new(vec![vec![0, 1], vec![1, 2], vec![2]], vec![1.0; 3])?;
/// let price = Modular { constant: 0.0, weights: vec![-0.5, -1.5, -0.5] };
/// let profit = WeightedSum::new(vec![(1.0, Box::new(&reached)), (1.0, Box::new(&price))])?;
/// assert_eq!(Greedy::cardinality(3).maximize(&profit)?.picks, [0, 2]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct WeightedSum<'a> {
    terms: Vec<(f64, Box<dyn SetFunction + 'a>)>,
    ground: usize,
}

impl<'a> WeightedSum<'a> {
    /// Sums functions of one ground set. Without terms it is the zero function of no elements.
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

    fn grow<'b>(&'b self, base: &Subset) -> Box<dyn Growth + 'b> {
        let terms = self.terms.iter();
        let terms = terms.map(|(weight, function)| (*weight, function.grow(base)));
        Box::new(GrowingSum {
            terms: terms.collect(),
            members: base.clone(),
        })
    }

    fn as_modular(&self) -> Option<Modular> {
        let mut sum = Modular::zero(self.ground);
        for (weight, function) in &self.terms {
            sum.add_scaled(*weight, &function.as_modular()?);
        }
        Some(sum)
    }
}

/// Every term grows by itself.
struct GrowingSum<'a> {
    terms: Vec<(f64, Box<dyn Growth + 'a>)>,
    members: Subset,
}

impl Growth for GrowingSum<'_> {
    fn value(&self) -> f64 {
        self.terms
            .iter()
            .map(|(weight, f)| weight * f.value())
            .sum()
    }

    fn gain(&self, element: usize) -> f64 {
        let gains = self
            .terms
            .iter()
            .map(|(weight, f)| weight * f.gain(element));
        gains.sum()
    }

    fn insert(&mut self, element: usize) {
        self.members.insert(element);
        self.terms.iter_mut().for_each(|(_, f)| f.insert(element));
    }

    fn members(&self) -> &Subset {
        &self.members
    }
}

/// f(base ∪ {kept(i) : i ∈ S}): some elements may be chosen, some are fixed in, the rest fixed out.
/// A gain costs what one of f does.
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

    /// The elements of the old ground set that `set` stands for.
    fn whole(&self, set: &Subset) -> Subset {
        let mut whole = self.base.clone();
        for element in set.iter() {
            whole.insert(self.kept[element]);
        }
        whole
    }
}

impl<F: SetFunction> SetFunction for Restriction<F> {
    fn ground_size(&self) -> usize {
        self.kept.len()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.function.value(&self.whole(set))
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        Box::new(GrowingRestriction {
            kept: &self.kept,
            whole: self.function.grow(&self.whole(base)),
            members: base.clone(),
        })
    }
}

/// The old function grows by the old elements.
struct GrowingRestriction<'a> {
    kept: &'a [usize],
    whole: Box<dyn Growth + 'a>,
    members: Subset,
}

impl Growth for GrowingRestriction<'_> {
    fn value(&self) -> f64 {
        self.whole.value()
    }

    fn gain(&self, element: usize) -> f64 {
        self.whole.gain(self.kept[element])
    }

    fn insert(&mut self, element: usize) {
        self.members.insert(element);
        self.whole.insert(self.kept[element]);
    }

    fn members(&self) -> &Subset {
        &self.members
    }
}
