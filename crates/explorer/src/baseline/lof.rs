//! Local outlier factor: how much sparser is a point's neighbourhood than its neighbours'?
//!
//! Reference: Breunig, Kriegel, Ng, Sander, "LOF: identifying density-based local outliers",
//! SIGMOD 2000.

use submodular_minimax::PointLike;

use super::cloud::{Cloud, Neighbour};
use super::error::{BaselineError, at_least, positive};
use super::removal::BaselineRemoval;

/// Settings of [`lof`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LofConfig {
    /// Neighbours that make a neighbourhood, at least 1; 20 is customary.
    pub neighbours: usize,
    /// The largest factor that is kept, above 0; 1 is as dense as the neighbours, 1.5 is customary.
    pub threshold: f64,
}

impl Default for LofConfig {
    fn default() -> Self {
        Self {
            neighbours: 20,
            threshold: 1.5,
        }
    }
}

impl LofConfig {
    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), BaselineError> {
        at_least("neighbours", self.neighbours as f64, 1.0)?;
        positive("threshold", self.threshold)
    }
}

/// Removes points whose local outlier factor exceeds the threshold.
///
/// Scores are the factors, without unit. Among duplicates the density is capped at 10¹⁰ times the
/// scaled unit, so that a stack of equal points has factor 1.
///
/// # Errors
/// Points that are not finite, settings out of range.
pub fn lof<P: PointLike>(
    points: &[P],
    config: &LofConfig,
) -> Result<BaselineRemoval, BaselineError> {
    config.validate()?;
    let cloud = Cloud::new(points)?;
    let rows: Vec<Vec<Neighbour>> = (0..cloud.len())
        .map(|v| cloud.nearest(v, config.neighbours))
        .collect();
    let density: Vec<f64> = (0..cloud.len())
        .map(|v| reachability_density(&rows, v))
        .collect();
    let factor = |v: usize| {
        let row = &rows[v];
        if row.is_empty() {
            return 1.0;
        }
        let around: f64 = row.iter().map(|n| density[n.1]).sum();
        around / row.len() as f64 / density[v]
    };
    let scores: Vec<f64> = (0..cloud.len()).map(factor).collect();
    let outlier: Vec<bool> = scores.iter().map(|&s| s > config.threshold).collect();
    Ok(BaselineRemoval::new(scores, |v| outlier[v]))
}

fn reachability_density(rows: &[Vec<Neighbour>], v: usize) -> f64 {
    let row = &rows[v];
    let reach = |u: usize| rows[u].last().map_or(0.0, |n| n.0.sqrt());
    let sum: f64 = row.iter().map(|n| n.0.sqrt().max(reach(n.1))).sum();
    1.0 / (sum / row.len().max(1) as f64 + 1e-10)
}
