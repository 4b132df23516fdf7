//! The laws a function must keep, checked exhaustively on small ground sets, and test macros.
//!
//! The functions return the first violation; the macros turn them into assertions, so that your own
//! function gets the tests the ready-made ones pass. Cost: O(4ⁿ) values or less; n ≤ 12 is sensible.

use crate::joint_function::{Joined, JointFunction};
use crate::set_function::SetFunction;
use crate::subset::Subset;

/// A broken law, with the numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// The law.
    pub law: &'static str,
    /// The smaller set.
    pub set: Subset,
    /// The elements involved.
    pub elements: Vec<usize>,
    /// The side that must not be smaller.
    pub left: f64,
    /// The side that must not be larger.
    pub right: f64,
}

/// f(S ∪ a) + f(S ∪ b) ≥ f(S ∪ a, b) + f(S) for all S, a, b, up to `tolerance`.
#[must_use]
pub fn submodularity(function: &dyn SetFunction, tolerance: f64) -> Option<Violation> {
    let n = function.ground_size();
    for set in subsets(n) {
        let outside: Vec<usize> = (0..n).filter(|&e| !set.contains(e)).collect();
        for (at, &a) in outside.iter().enumerate() {
            for &b in &outside[at + 1..] {
                let with = |extra: &[usize]| {
                    function.value(&set.union(&Subset::from_indices(n, extra.iter().copied())))
                };
                let (left, right) = (with(&[a]) + with(&[b]), with(&[a, b]) + with(&[]));
                if falls_short(left, right, tolerance) {
                    let elements = vec![a, b];
                    return Some(Violation {
                        law: "submodularity",
                        set,
                        elements,
                        left,
                        right,
                    });
                }
            }
        }
    }
    None
}

/// Submodularity on the disjoint union N₁ ⊎ N₂.
#[must_use]
pub fn joint_submodularity<F: JointFunction>(function: &F, tolerance: f64) -> Option<Violation> {
    submodularity(&Joined(function), tolerance)
}

/// f(S ∪ a) ≥ f(S) for all S, a, up to `tolerance`.
#[must_use]
pub fn monotonicity(function: &dyn SetFunction, tolerance: f64) -> Option<Violation> {
    let n = function.ground_size();
    for set in subsets(n) {
        for a in (0..n).filter(|&e| !set.contains(e)) {
            let (left, right) = (
                function.value(&set.union(&Subset::from_indices(n, [a]))),
                function.value(&set),
            );
            if falls_short(left, right, tolerance) {
                return Some(Violation {
                    law: "monotonicity",
                    set,
                    elements: vec![a],
                    left,
                    right,
                });
            }
        }
    }
    None
}

/// f(∅) = 0 up to `tolerance`.
#[must_use]
pub fn normalisation(function: &dyn SetFunction, tolerance: f64) -> Option<Violation> {
    let set = Subset::empty(function.ground_size());
    let left = function.value(&set);
    differs(left, 0.0, tolerance).then(|| Violation {
        law: "normalisation",
        set,
        elements: vec![],
        left,
        right: 0.0,
    })
}

/// [`SetFunction::grow`] agrees with [`SetFunction::value`]: gains are differences of values, before and after an insertion.
#[must_use]
pub fn growth(function: &dyn SetFunction, tolerance: f64) -> Option<Violation> {
    let n = function.ground_size();
    for set in subsets(n) {
        let growth = function.grow(&set);
        let value = function.value(&set);
        for a in (0..n).filter(|&e| !set.contains(e)) {
            let with = function.value(&set.union(&Subset::from_indices(n, [a])));
            let (left, right) = (growth.gain(a), with - value);
            let mut grown = function.grow(&set);
            grown.insert(a);
            if differs(left, right, tolerance)
                || differs(growth.value(), value, tolerance)
                || differs(grown.value(), with, tolerance)
            {
                return Some(Violation {
                    law: "growth",
                    set,
                    elements: vec![a],
                    left,
                    right,
                });
            }
        }
    }
    None
}

/// NaN keeps no law.
fn falls_short(left: f64, right: f64, tolerance: f64) -> bool {
    left.is_nan() || right.is_nan() || left < right - tolerance
}

fn differs(left: f64, right: f64, tolerance: f64) -> bool {
    (left - right).is_nan() || (left - right).abs() > tolerance
}

fn subsets(n: usize) -> impl Iterator<Item = Subset> {
    (0..1_u64 << n.min(20)).map(move |mask| Subset::from_mask(n, mask))
}

/// Asserts that a set function is submodular and that its growth agrees with its values.
///
/// ```
/// use submodular_minimax::{assert_submodular, functions::Coverage};
/// let sets = vec![vec![0, 1], vec![1, 2], vec![0]];
/// assert_submodular!(&Coverage::new(sets, vec![1.0, 2.0, 4.0])?);
/// # Ok::<(), submodular_minimax::functions::FunctionError>(())
/// ```
#[macro_export]
macro_rules! assert_submodular {
    ($function:expr) => {
        $crate::assert_submodular!($function, 1e-9)
    };
    ($function:expr, $tolerance:expr) => {
        match $function {
            function => {
                assert_eq!($crate::laws::submodularity(function, $tolerance), None);
                assert_eq!($crate::laws::growth(function, $tolerance), None);
            }
        }
    };
}

/// Asserts that a function of two ground sets is submodular on their disjoint union.
#[macro_export]
macro_rules! assert_jointly_submodular {
    ($function:expr) => {
        $crate::assert_jointly_submodular!($function, 1e-9)
    };
    ($function:expr, $tolerance:expr) => {
        assert_eq!(
            $crate::laws::joint_submodularity($function, $tolerance),
            None
        )
    };
}

/// Asserts that no element ever lowers the value.
#[macro_export]
macro_rules! assert_monotone {
    ($function:expr) => {
        assert_eq!($crate::laws::monotonicity($function, 1e-9), None)
    };
}

/// Asserts f(∅) = 0.
#[macro_export]
macro_rules! assert_normalised {
    ($function:expr) => {
        assert_eq!($crate::laws::normalisation($function, 1e-9), None)
    };
}
