//! The settings of obstacle building and their ranges.

use super::error::ObstacleError;
use crate::kmeans::KMeansConfig;

/// Settings of [`ObstacleSet::from_points`](crate::ObstacleSet::from_points). Lengths are map units.
#[derive(Clone, Debug, PartialEq)]
pub struct ObstacleConfig {
    /// How the points are clustered. Its `clusters` is K in the paper; it is lowered to the number of
    /// points where there are fewer. Default 300 clusters.
    pub kmeans: KMeansConfig,
    /// Largest extent of an obstacle along its longest principal axis; clusters beyond it are split at
    /// their largest gap. More than 0; infinite (the default, and the paper) never splits.
    pub max_diameter: f64,
    /// How many rays may cross a hull before it is taken to span a gap and is split. Only with
    /// [`from_observed_points`](crate::ObstacleSet::from_observed_points). At least 1. Default 3.
    pub max_piercing_rays: usize,
    /// Share of a ray before its end that proves nothing, because the range of a sparse point is
    /// uncertain. 0 to below 1. Default 0.1.
    pub ray_margin: f64,
    /// Clusters of fewer points are not split on account of rays. At least 2. Default 4.
    pub min_split_points: usize,
}

impl Default for ObstacleConfig {
    fn default() -> Self {
        ObstacleConfig {
            kmeans: KMeansConfig::default(),
            max_diameter: f64::INFINITY,
            max_piercing_rays: 3,
            ray_margin: 0.1,
            min_split_points: 4,
        }
    }
}

impl ObstacleConfig {
    /// The default with another number of clusters.
    #[must_use]
    pub fn with_clusters(clusters: usize) -> Self {
        let kmeans = KMeansConfig {
            clusters,
            ..KMeansConfig::default()
        };
        ObstacleConfig {
            kmeans,
            ..ObstacleConfig::default()
        }
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// The first field that is out of range, with its value.
    pub fn validate(&self) -> Result<(), ObstacleError> {
        self.kmeans.validate()?;
        if self.max_diameter.is_nan() || self.max_diameter <= 0.0 {
            return Err(ObstacleError::MaxDiameter {
                max_diameter: self.max_diameter,
            });
        }
        if self.max_piercing_rays == 0 {
            return Err(ObstacleError::NoPiercingRays);
        }
        if !(0.0..1.0).contains(&self.ray_margin) {
            return Err(ObstacleError::RayMargin {
                ray_margin: self.ray_margin,
            });
        }
        if self.min_split_points < 2 {
            let min_split_points = self.min_split_points;
            return Err(ObstacleError::MinSplitPoints { min_split_points });
        }
        Ok(())
    }
}
