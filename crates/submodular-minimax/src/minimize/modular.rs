//! The closed form for modular functions: take what is negative.

use super::{MinimizeError, MinimizeStop, Minimizer, Minimum};
use crate::set_function::SetFunction;

/// Exact in O(n) for functions whose [`as_modular`](SetFunction::as_modular) answers; the smallest
/// minimiser.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ModularMinimizer;

impl Minimizer for ModularMinimizer {
    fn minimize(&self, function: &dyn SetFunction) -> Result<Minimum, MinimizeError> {
        let modular = function.as_modular().ok_or(MinimizeError::NotModular)?;
        let set = modular.minimizer();
        let value = modular.value(&set);
        if !value.is_finite() {
            return Err(MinimizeError::NonFinite {
                value,
                elements: set.len(),
            });
        }
        let stop = MinimizeStop::Optimal;
        Ok(Minimum {
            set,
            value,
            lower_bound: value,
            iterations: 1,
            stop,
        })
    }
}
