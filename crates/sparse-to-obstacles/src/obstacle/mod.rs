//! A set of convex obstacles with exact queries for a moving ball.

mod bvh;
mod clear;
mod config;
mod error;
mod export;
mod query;
mod split;
mod update;

use bvh::{Aabb, Bvh};
pub use config::ObstacleConfig;
pub use error::ObstacleError;
pub use query::FirstContact;
pub use update::ObstacleUpdate;

use crate::free_space::Ray;
use crate::hull::{self, Hull};
use crate::kmeans::{self, Clustering};
use crate::point::PointLike;
use crate::vector::Vec3;
use rand::Rng;

/// Convex obstacles built from clustered points, in a bounding-volume hierarchy.
///
/// The obstacles are the hulls themselves. Every query takes the radius of the moving ball, which is the
/// exact Minkowski sum of hull and ball: rounded edges and corners, no pushed planes.
#[derive(Clone, Debug, Default)]
pub struct ObstacleSet {
    hulls: Vec<Hull>,
    bvh: Bvh,
    inertia: f64,
    centroids: Vec<Vec3>,
    /// The points that the hulls were built from.
    points: Vec<Vec3>,
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
        ObstacleSet::from_observed_points(points, &[], config, rng)
    }

    /// As [`from_points`](Self::from_points), and splits the clusters that the camera has seen through:
    /// an obstacle must not bridge a doorway. `rays` are lines of sight from keyframes to points; a hull
    /// that more than [`ObstacleConfig::max_piercing_rays`] cross is cut in two, again and again.
    ///
    /// # Errors
    /// As [`from_points`](Self::from_points), and a ray that is not finite.
    pub fn from_observed_points<P: PointLike>(
        points: &[P],
        rays: &[Ray],
        config: &ObstacleConfig,
        rng: &mut impl Rng,
    ) -> Result<Self, ObstacleError> {
        let mut set = ObstacleSet::default();
        set.update(points, rays, config, rng)?;
        Ok(set)
    }

    /// The hulls of an existing partition. Labels beyond the centroids, or missing ones, are ignored.
    ///
    /// # Errors
    /// A coordinate that is not finite or beyond 1e140.
    pub fn from_clustering<P: PointLike>(
        points: &[P],
        clustering: &Clustering,
    ) -> Result<Self, ObstacleError> {
        let points = kmeans::usable_points(points)?;
        let mut members = vec![Vec::new(); clustering.centroids.len()];
        for (index, &label) in clustering.labels.iter().enumerate().take(points.len()) {
            if let Some(members) = members.get_mut(label) {
                members.push(index);
            }
        }
        members.retain(|members| !members.is_empty());
        let hulls = build_hulls(&points, members);
        let mut set = ObstacleSet {
            inertia: clustering.inertia,
            ..ObstacleSet::default()
        };
        set.centroids.clone_from(&clustering.centroids);
        set.replace(hulls, points);
        Ok(set)
    }

    fn replace(&mut self, hulls: Vec<Hull>, points: Vec<Vec3>) {
        self.bvh = Bvh::new(hulls.iter().map(|hull| Aabb::of(&hull.vertices)).collect());
        self.hulls = hulls;
        self.points = points;
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
