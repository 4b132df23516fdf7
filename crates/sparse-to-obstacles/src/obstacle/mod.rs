//! A set of convex obstacles with exact queries for a moving ball.

mod bvh;
mod config;
mod error;
mod export;
mod query;

pub(crate) use bvh::{Aabb, Bvh};
pub use config::ObstacleConfig;
pub use error::ObstacleError;
pub use query::FirstContact;

use crate::hull::{self, Hull};
use crate::kmeans::{Clustering, kmeans};
use crate::point::{PointLike, finite_points};
use crate::vector::Vec3;
use rand::Rng;

/// Convex obstacles built from clustered points, in a bounding-volume hierarchy.
///
/// The obstacles are the hulls themselves. Every query takes the radius of the moving ball, which is the
/// exact Minkowski sum of hull and ball: rounded edges and corners, no pushed planes.
#[derive(Clone, Debug)]
pub struct ObstacleSet {
    hulls: Vec<Hull>,
    bvh: Bvh,
    inertia: f64,
    centroids: Vec<Vec3>,
}

impl ObstacleSet {
    /// Clusters the points and takes the convex hull of each cluster.
    ///
    /// No points give an empty set, in which every motion is free: what no point shows is not an
    /// obstacle here, see [`FreeSpace`](crate::FreeSpace) for the opposite view.
    ///
    /// # Errors
    /// A coordinate that is not finite, or a configuration out of its range.
    ///
    /// # Example
    /// ```
    /// use rand::SeedableRng;
    /// use sparse_to_obstacles::{ObstacleConfig, ObstacleSet};
    ///
    /// let wall: Vec<[f64; 3]> = (0..100).map(|i| [2.0, f64::from(i % 10), f64::from(i / 10)]).collect();
    /// let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    /// let obstacles = ObstacleSet::from_points(&wall, &ObstacleConfig::with_clusters(1), &mut rng)?;
    /// assert!(!obstacles.motion_is_free([0.0, 5.0, 5.0], [4.0, 5.0, 5.0], 0.1));
    /// assert_eq!(obstacles.clearance([0.0, 5.0, 5.0], [1.5, 5.0, 5.0]), 0.5);
    /// # Ok::<(), sparse_to_obstacles::ObstacleError>(())
    /// ```
    pub fn from_points<P: PointLike>(
        points: &[P],
        config: &ObstacleConfig,
        rng: &mut impl Rng,
    ) -> Result<Self, ObstacleError> {
        config.validate()?;
        if points.is_empty() {
            return Ok(ObstacleSet::from_hulls(Vec::new(), 0.0, Vec::new()));
        }
        let mut kmeans_config = config.kmeans.clone();
        kmeans_config.clusters = kmeans_config.clusters.min(points.len());
        let clustering = kmeans(points, &kmeans_config, rng)?;
        ObstacleSet::from_clustering(points, &clustering)
    }

    /// The hulls of an existing partition. Labels beyond the centroids, or missing ones, are ignored.
    ///
    /// # Errors
    /// A coordinate that is not finite.
    pub fn from_clustering<P: PointLike>(
        points: &[P],
        clustering: &Clustering,
    ) -> Result<Self, ObstacleError> {
        let points =
            finite_points(points).map_err(|index| crate::KMeansError::NotFinite { index })?;
        let mut members = vec![Vec::new(); clustering.centroids.len()];
        for (index, &label) in clustering.labels.iter().enumerate().take(points.len()) {
            if let Some(members) = members.get_mut(label) {
                members.push(index);
            }
        }
        members.retain(|members| !members.is_empty());
        let hulls = build_hulls(&points, members);
        let centroids = clustering.centroids.clone();
        Ok(ObstacleSet::from_hulls(
            hulls,
            clustering.inertia,
            centroids,
        ))
    }

    fn from_hulls(hulls: Vec<Hull>, inertia: f64, centroids: Vec<Vec3>) -> Self {
        let bvh = Bvh::new(hulls.iter().map(|hull| Aabb::of(&hull.vertices)).collect());
        ObstacleSet {
            hulls,
            bvh,
            inertia,
            centroids,
        }
    }

    /// The obstacles, in the order of their clusters.
    #[must_use]
    pub fn obstacles(&self) -> &[Hull] {
        &self.hulls
    }

    /// How many obstacles there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.hulls.len()
    }

    /// Is there no obstacle at all?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.hulls.is_empty()
    }

    /// How many obstacles are points, segments or flat polygons.
    #[must_use]
    pub fn degenerate_count(&self) -> usize {
        self.hulls
            .iter()
            .filter(|hull| hull.kind.is_degenerate())
            .count()
    }

    /// Sum of squared distances from the points to the centroids of their clusters, squared map units.
    #[must_use]
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// The centroids of the clusters, for a warm start.
    #[must_use]
    pub fn centroids(&self) -> &[[f64; 3]] {
        &self.centroids
    }
}

#[cfg(not(feature = "rayon"))]
fn build_hulls(points: &[Vec3], clusters: Vec<Vec<usize>>) -> Vec<Hull> {
    clusters
        .into_iter()
        .map(|members| hull::build(points, members))
        .collect()
}

#[cfg(feature = "rayon")]
fn build_hulls(points: &[Vec3], clusters: Vec<Vec<usize>>) -> Vec<Hull> {
    use rayon::prelude::*;
    clusters
        .into_par_iter()
        .map(|members| hull::build(points, members))
        .collect()
}

#[cfg(test)]
mod tests;
