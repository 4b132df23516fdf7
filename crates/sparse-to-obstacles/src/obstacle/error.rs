//! What can be wrong with the input of obstacle building.

use crate::kmeans::KMeansError;
use thiserror::Error;

/// Why an [`ObstacleSet`](crate::ObstacleSet) could not be built.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ObstacleError {
    /// The points could not be clustered.
    #[error(transparent)]
    KMeans(#[from] KMeansError),
    /// `max_diameter` is not positive.
    #[error("max_diameter is {max_diameter}: it must be above 0")]
    MaxDiameter {
        /// The value given.
        max_diameter: f64,
    },
    /// `max_piercing_rays` is zero.
    #[error("max_piercing_rays is 0: allow at least 1, or build without rays")]
    NoPiercingRays,
    /// `ray_margin` is not a share.
    #[error("ray_margin is {ray_margin}: it must be from 0 to below 1")]
    RayMargin {
        /// The value given.
        ray_margin: f64,
    },
    /// `min_split_points` is too small.
    #[error(
        "min_split_points is {min_split_points}: a cluster needs at least 2 points to be split"
    )]
    MinSplitPoints {
        /// The value given.
        min_split_points: usize,
    },
    /// A ray has an end that is not finite.
    #[error("ray {index} has a coordinate that is not finite: remove it")]
    RayNotFinite {
        /// Index into the rays.
        index: usize,
    },
    /// A ball has a centre or radius that is not finite, or a negative radius.
    #[error("a ball of radius {radius}: centre and radius must be finite, the radius at least 0")]
    Ball {
        /// The radius given.
        radius: f64,
    },
}
