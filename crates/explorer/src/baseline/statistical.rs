//! Statistical outlier removal: the mean distance to the k nearest neighbours against its spread.
//!
//! Reference: Rusu et al., "Towards 3D point cloud based object maps for household environments",
//! Robotics and Autonomous Systems 2008; the filter of PCL and Open3D.

use submodular_minimax::PointLike;

use super::cloud::Cloud;
use super::error::{BaselineError, at_least};
use super::removal::BaselineRemoval;

/// Settings of [`statistical`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatisticalConfig {
    /// Neighbours whose distances are averaged, at least 1; Open3D's tutorial takes 20.
    pub neighbours: usize,
    /// Deviations above the mean that are still kept, at least 0; Open3D's tutorial takes 2.
    pub ratio: f64,
}

impl Default for StatisticalConfig {
    fn default() -> Self {
        Self {
            neighbours: 20,
            ratio: 2.0,
        }
    }
}

impl StatisticalConfig {
    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), BaselineError> {
        at_least("neighbours", self.neighbours as f64, 1.0)?;
        at_least("ratio", self.ratio, 0.0)
    }
}

/// Removes points whose mean neighbour distance exceeds mean + ratio · standard deviation.
///
/// Scores are mean distances in the unit of the points; the point itself is not its neighbour.
///
/// # Errors
/// Points that are not finite, settings out of range.
pub fn statistical<P: PointLike>(
    points: &[P],
    config: &StatisticalConfig,
) -> Result<BaselineRemoval, BaselineError> {
    config.validate()?;
    let cloud = Cloud::new(points)?;
    let mean_distance = |v: usize| {
        let row = cloud.nearest(v, config.neighbours);
        row.iter().map(|n| n.0.sqrt()).sum::<f64>() / row.len().max(1) as f64
    };
    let scores: Vec<f64> = (0..cloud.len()).map(mean_distance).collect();
    let threshold = mean_plus_deviations(&scores, config.ratio);
    let outlier: Vec<bool> = scores.iter().map(|&s| s > threshold).collect();
    let scores = scores.into_iter().map(|s| s * cloud.unit).collect();
    Ok(BaselineRemoval::new(scores, |v| outlier[v]))
}

fn mean_plus_deviations(values: &[f64], ratio: f64) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n.max(1.0);
    let squares = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    mean + ratio * (squares / (n - 1.0).max(1.0)).sqrt()
}
