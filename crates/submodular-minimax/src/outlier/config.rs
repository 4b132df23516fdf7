//! Settings of the outlier removal and its named readings.

use super::error::OutlierError;
use crate::minimax::Beta;

/// Settings of [`remove_outliers`](super::remove_outliers).
///
/// Lengths are multiples of the cloud's own spacing (the median distance to the fourth neighbour),
/// so no setting has a unit and a map of unknown scale is cleaned the same way in every scale.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlierConfig {
    /// Which score s(u, v) and which cost λ(v) the set function is made of.
    pub reading: Reading,
    /// λ, the cost of letting a point join, above 0. Paper: 0.6; here 0.25, so that (1 + β) λ = 0.5.
    pub lambda: f64,
    /// β, the weight of the points already in. Paper: 1.
    pub beta: Beta,
    /// k, how many representatives a response may have, at least 1. Paper: 4; here 64, at most n / 4.
    pub max_representatives: usize,
    /// How far a representative reaches, in spacings, above 0; 3.5.
    pub reach: f64,
    /// Neighbours a row keeps at most, at least 4; 64.
    pub neighbours: usize,
    /// Support that makes a full representative, above 0; 2.
    pub support: f64,
    /// Points a linked component needs, so that it may represent, at least 1; 15.
    pub min_component: usize,
    /// Closed form or the iterations of Algorithm 1.
    pub solver: Solver,
}

/// Which score and cost the set function is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reading {
    /// A: s = 1 − 1/d as printed. Nothing can ever join: see the crate's documentation.
    Literal,
    /// D: s = (1 − d/h)₊ between different points.
    Nearest,
    /// F: D times the representative's support.
    Supported,
    /// G: F, where representatives in small detached components weigh nothing.
    Connected,
}

/// How the minimax problem is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// The set that Algorithm 1 ends with, computed directly; one pass.
    ClosedForm,
    /// Iterative-X-Growing with a lazy greedy oracle, iteration by iteration.
    Engine,
}

impl Default for OutlierConfig {
    fn default() -> Self {
        Self {
            reading: Reading::Connected,
            lambda: 0.25,
            beta: Beta::Fixed(1.0),
            max_representatives: 64,
            reach: 3.5,
            neighbours: 64,
            support: 2.0,
            min_component: 15,
            solver: Solver::ClosedForm,
        }
    }
}

impl OutlierConfig {
    /// The constants as printed: s = 1 − 1/d, λ = 0.6, k = 4, β = 1.
    ///
    /// With them nothing is ever found: s < 1 ≤ (1 + β) λ = 1.2, so no point can join and the
    /// algorithm returns the empty set of outliers after one iteration, for every cloud.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            reading: Reading::Literal,
            lambda: 0.6,
            max_representatives: 4,
            solver: Solver::Engine,
            ..Self::default()
        }
    }

    /// Reading G with its studied constants.
    #[must_use]
    pub fn connected() -> Self {
        Self::default()
    }

    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), OutlierError> {
        positive("lambda", self.lambda)?;
        if let Beta::Fixed(beta) = self.beta {
            positive("beta", beta)?;
        }
        at_least("max_representatives", self.max_representatives, 1)?;
        positive("reach", self.reach)?;
        at_least("neighbours", self.neighbours, 4)?;
        positive("support", self.support)?;
        at_least("min_component", self.min_component, 1)
    }
}

fn positive(field: &'static str, value: f64) -> Result<(), OutlierError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(OutlierError::Setting {
        field,
        value,
        range: "finite and above 0",
    })
}

fn at_least(field: &'static str, value: usize, least: usize) -> Result<(), OutlierError> {
    if value >= least {
        return Ok(());
    }
    let range = if least == 1 {
        "at least 1"
    } else {
        "at least 4"
    };
    Err(OutlierError::Setting {
        field,
        value: value as f64,
        range,
    })
}
