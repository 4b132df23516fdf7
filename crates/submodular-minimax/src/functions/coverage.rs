//! Weighted coverage: how much do the chosen sets cover together?

use super::error::{FunctionError, non_negative};
use crate::set_function::{Growth, SetFunction};
use crate::subset::Subset;

/// f(S) = Σ of the weights of the items that some chosen set contains. Monotone submodular.
///
/// A gain costs the length of the element's list and one bit an item.
///
/// ```
/// use submodular_minimax::{SetFunction, Subset, functions::Coverage};
/// let rooms_seen_from = vec![vec![0, 1], vec![1, 2]];
/// let area = Coverage::new(rooms_seen_from, vec![12.0, 9.0, 20.0])?;
/// assert_eq!(area.value(&Subset::from_indices(2, [1])), 29.0);
/// assert_eq!(area.value(&Subset::full(2)), 41.0);
/// # Ok::<(), submodular_minimax::functions::FunctionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Coverage {
    sets: Vec<Vec<usize>>,
    weights: Vec<f64>,
}

impl Coverage {
    /// `sets[e]` = the items element e covers; `weights` = what each item is worth, at least 0.
    ///
    /// # Errors
    /// A weight that is negative or not finite, an item out of range.
    pub fn new(sets: Vec<Vec<usize>>, weights: Vec<f64>) -> Result<Self, FunctionError> {
        non_negative("weights", &weights, weights.len())?;
        let size = weights.len();
        for (index, set) in sets.iter().enumerate() {
            if let Some(&element) = set.iter().find(|&&item| item >= size) {
                return Err(FunctionError::OutOfRange {
                    what: "sets",
                    index,
                    element,
                    size,
                });
            }
        }
        Ok(Self { sets, weights })
    }
}

impl SetFunction for Coverage {
    fn ground_size(&self) -> usize {
        self.sets.len()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.grow(set).value()
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        let mut covered = Covered {
            function: self,
            items: Subset::empty(self.weights.len()),
            members: Subset::empty(self.sets.len()),
            value: 0.0,
        };
        for element in base.iter() {
            covered.insert(element);
        }
        Box::new(covered)
    }
}

struct Covered<'a> {
    function: &'a Coverage,
    items: Subset,
    members: Subset,
    value: f64,
}

impl Growth for Covered<'_> {
    fn value(&self) -> f64 {
        self.value
    }

    fn gain(&self, element: usize) -> f64 {
        let mut new = Subset::empty(self.function.weights.len());
        let items = self.function.sets[element].iter();
        items
            .filter(|&&i| !self.items.contains(i) && new.insert(i))
            .map(|&i| self.function.weights[i])
            .sum()
    }

    fn insert(&mut self, element: usize) {
        self.value += self.gain(element);
        self.members.insert(element);
        for &item in &self.function.sets[element] {
            self.items.insert(item);
        }
    }

    fn members(&self) -> &Subset {
        &self.members
    }
}
