//! Radius outlier removal: how many neighbours are near enough?

use submodular_minimax::PointLike;

use super::cloud::Cloud;
use super::error::{BaselineError, at_least, positive};
use super::removal::BaselineRemoval;

/// A distance, given outright or relative to the cloud's own spacing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// In the unit of the points, above 0.
    Absolute(f64),
    /// `factor` times the median distance to the `neighbour`-th nearest neighbour.
    Spacing {
        /// Which neighbour, at least 1.
        neighbour: usize,
        /// How many times its median distance, above 0.
        factor: f64,
    },
}

/// Settings of [`radius`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadiusConfig {
    /// How far a neighbour may be; default four times the median nearest-neighbour distance.
    pub radius: Reach,
    /// Neighbours a point needs to stay, at least 1; default 2.
    pub min_neighbours: usize,
}

impl Default for RadiusConfig {
    fn default() -> Self {
        Self {
            radius: Reach::Spacing {
                neighbour: 1,
                factor: 4.0,
            },
            min_neighbours: 2,
        }
    }
}

impl RadiusConfig {
    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), BaselineError> {
        self.radius.validate()?;
        at_least("min_neighbours", self.min_neighbours as f64, 1.0)
    }
}

/// Removes points with fewer than `min_neighbours` others within the radius.
///
/// Scores are the distances to the `min_neighbours`-th neighbour, in the unit of the points, infinite
/// where there is none.
///
/// # Errors
/// Points that are not finite, settings out of range.
pub fn radius<P: PointLike>(
    points: &[P],
    config: &RadiusConfig,
) -> Result<BaselineRemoval, BaselineError> {
    config.validate()?;
    let cloud = Cloud::new(points)?;
    let radius = config.radius.resolve(&cloud);
    let scores = cloud.distances_to_neighbour(config.min_neighbours);
    let outlier: Vec<bool> = scores.iter().map(|&s| s > radius).collect();
    let scores = scores.into_iter().map(|s| s * cloud.unit).collect();
    Ok(BaselineRemoval::new(scores, |v| outlier[v]))
}

impl Reach {
    pub(super) fn validate(&self) -> Result<(), BaselineError> {
        match *self {
            Self::Absolute(radius) => positive("radius", radius),
            Self::Spacing { neighbour, factor } => {
                at_least("neighbour", neighbour as f64, 1.0)?;
                positive("factor", factor)
            }
        }
    }

    /// The distance in scaled units.
    pub(super) fn resolve(&self, cloud: &Cloud) -> f64 {
        match *self {
            Self::Absolute(radius) => radius / cloud.unit,
            Self::Spacing { neighbour, factor } => {
                let mut spacing = cloud.distances_to_neighbour(neighbour);
                spacing.retain(|d| d.is_finite());
                factor * median(&mut spacing)
            }
        }
    }
}

/// The mean of the middle two for an even count; 0 without values. Reorders.
fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    match values {
        [] => 0.0,
        _ => 0.5 * values[(values.len() - 1) / 2] + 0.5 * values[values.len() / 2],
    }
}
