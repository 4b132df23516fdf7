//! f(X ∪ Y) on two ground sets, one of which minimises while the other maximises.

use crate::functions::Modular;
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// A function of X ⊆ N₁ and Y ⊆ N₂.
///
/// *Jointly* submodular: submodular on the disjoint union N₁ ⊎ N₂. *Disjointly* submodular, which is
/// weaker: submodular in X for each fixed Y and in Y for each fixed X.
pub trait JointFunction {
    /// |N₁|, the elements the minimiser chooses from.
    fn x_size(&self) -> usize;

    /// |N₂|, the elements the maximiser chooses from.
    fn y_size(&self) -> usize;

    /// f(X ∪ Y).
    fn value(&self, x: &Subset, y: &Subset) -> f64;

    /// Y ↦ f(X ∪ Y) for a fixed X; override it where gains can be kept up incrementally.
    fn given_x<'a>(&'a self, x: &Subset) -> Box<dyn SetFunction + 'a> {
        Box::new(GivenX {
            function: self,
            x: x.clone(),
        })
    }

    /// X ↦ f(X ∪ Y) as constant + weights, where it is modular: then line 5 has a closed form.
    fn modular_given_y(&self, _y: &Subset) -> Option<Modular> {
        None
    }
}

/// X ↦ f(X ∪ Y) for a fixed Y.
pub(crate) struct GivenY<'a, F: ?Sized> {
    pub(crate) function: &'a F,
    pub(crate) y: Subset,
}

impl<F: JointFunction + ?Sized> SetFunction for GivenY<'_, F> {
    fn ground_size(&self) -> usize {
        self.function.x_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.function.value(set, &self.y)
    }

    fn as_modular(&self) -> Option<Modular> {
        self.function.modular_given_y(&self.y)
    }
}

struct GivenX<'a, F: ?Sized> {
    function: &'a F,
    x: Subset,
}

impl<F: JointFunction + ?Sized> SetFunction for GivenX<'_, F> {
    fn ground_size(&self) -> usize {
        self.function.y_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        self.function.value(&self.x, set)
    }
}

/// A set function on N₁ ⊎ N₂ read as a joint one: elements below `x_size` are X, the others Y.
#[derive(Debug, Clone)]
pub struct Split<F> {
    function: F,
    x_size: usize,
}

impl<F: SetFunction> Split<F> {
    /// Splits the ground set after the first `x_size` elements (at most all of them).
    pub fn new(function: F, x_size: usize) -> Self {
        let x_size = x_size.min(function.ground_size());
        Self { function, x_size }
    }
}

impl<F: SetFunction> JointFunction for Split<F> {
    fn x_size(&self) -> usize {
        self.x_size
    }

    fn y_size(&self) -> usize {
        self.function.ground_size() - self.x_size
    }

    fn value(&self, x: &Subset, y: &Subset) -> f64 {
        let joined = x.iter().chain(y.iter().map(|e| e + self.x_size));
        self.function
            .value(&Subset::from_indices(self.function.ground_size(), joined))
    }
}

/// A joint function read as one set function on N₁ ⊎ N₂: what the law of joint submodularity needs.
pub struct Joined<'a, F: ?Sized>(pub &'a F);

impl<F: JointFunction + ?Sized> SetFunction for Joined<'_, F> {
    fn ground_size(&self) -> usize {
        self.0.x_size() + self.0.y_size()
    }

    fn value(&self, set: &Subset) -> f64 {
        let n1 = self.0.x_size();
        let x = Subset::from_indices(n1, set.iter().filter(|&e| e < n1));
        let y = set.iter().filter_map(|e| e.checked_sub(n1));
        self.0.value(&x, &Subset::from_indices(self.0.y_size(), y))
    }
}
