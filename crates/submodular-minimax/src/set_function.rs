//! What a set function must tell: its value, and cheaper if it can, the gain of one more element.

use crate::functions::Modular;
use crate::subset::Subset;

/// A real-valued function of the subsets of 0..n.
///
/// Only [`ground_size`](Self::ground_size) and [`value`](Self::value) are required. A function that
/// can update incrementally overrides [`grow`](Self::grow); all greedy maximisers run through it.
///
/// ```
/// use submodular_minimax::{SetFunction, Subset, maximize::{Greedy, Maximizer}};
/// struct Distinct(Vec<u32>);
/// impl SetFunction for Distinct {
///     fn ground_size(&self) -> usize { self.0.len() }
///     fn value(&self, set: &Subset) -> f64 {
///         let seen: std::collections::BTreeSet<_> = set.iter().map(|e| self.0[e]).collect();
///         seen.len() as f64
///     }
/// }
/// let best = Greedy::cardinality(2).maximize(&Distinct(vec![7, 7, 8]))?;
/// assert_eq!(best.picks, [0, 2]);
/// # Ok::<(), submodular_minimax::maximize::MaximizeError>(())
/// ```
pub trait SetFunction {
    /// n, the number of elements.
    fn ground_size(&self) -> usize;

    /// f(S).
    fn value(&self, set: &Subset) -> f64;

    /// Starts from `base` to add one element at a time.
    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        Box::new(ByValue {
            function: self,
            value: self.value(base),
            members: base.clone(),
        })
    }

    /// The function as constant + weights, if it is modular; minimisers then need no search.
    fn as_modular(&self) -> Option<Modular> {
        None
    }
}

/// A set that grows by one element at a time.
pub trait Growth {
    /// f of the current set.
    fn value(&self) -> f64;

    /// f(S ∪ {element}) − f(S); 0 for a member.
    fn gain(&self, element: usize) -> f64;

    /// Adds the element.
    fn insert(&mut self, element: usize);

    /// The current set.
    fn members(&self) -> &Subset;
}

/// The fallback: every gain is a difference of two values.
struct ByValue<'a, F: ?Sized> {
    function: &'a F,
    value: f64,
    members: Subset,
}

impl<F: SetFunction + ?Sized> Growth for ByValue<'_, F> {
    fn value(&self) -> f64 {
        self.value
    }

    fn gain(&self, element: usize) -> f64 {
        if self.members.contains(element) {
            return 0.0;
        }
        let mut with = self.members.clone();
        with.insert(element);
        self.function.value(&with) - self.value
    }

    fn insert(&mut self, element: usize) {
        if self.members.insert(element) {
            self.value = self.function.value(&self.members);
        }
    }

    fn members(&self) -> &Subset {
        &self.members
    }
}

impl<F: SetFunction + ?Sized> SetFunction for &F {
    fn ground_size(&self) -> usize {
        (**self).ground_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        (**self).value(set)
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        (**self).grow(base)
    }

    fn as_modular(&self) -> Option<Modular> {
        (**self).as_modular()
    }
}

impl<F: SetFunction + ?Sized> SetFunction for Box<F> {
    fn ground_size(&self) -> usize {
        (**self).ground_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        (**self).value(set)
    }

    fn grow<'a>(&'a self, base: &Subset) -> Box<dyn Growth + 'a> {
        (**self).grow(base)
    }

    fn as_modular(&self) -> Option<Modular> {
        (**self).as_modular()
    }
}
