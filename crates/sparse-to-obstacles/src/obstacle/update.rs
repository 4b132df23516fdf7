//! Obstacles of a map that has grown: a warm start, and hulls of unchanged clusters taken over.

use super::config::ObstacleConfig;
use super::error::ObstacleError;
use super::{ObstacleSet, split};
use crate::free_space::Ray;
use crate::hull::{self, Hull};
use crate::kmeans::{KMeansError, kmeans_from};
use crate::point::{PointLike, finite_points};
use crate::vector::Vec3;
use rand::Rng;

/// What an update had to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObstacleUpdate {
    /// Hulls taken over because their points are the same.
    pub reused: usize,
    /// Hulls built anew.
    pub built: usize,
    /// Passes of K-means over the data.
    pub iterations: usize,
}

impl ObstacleSet {
    /// Replaces the obstacles by those of a map that has grown or moved: all its points, old and new.
    ///
    /// K-means starts from the former centroids and makes no swaps, so little is left to do where little changed; the
    /// result is an [`ObstacleSet`] like any other, though not the same as one built at once. On an error
    /// the set stays as it was. `rays` may be empty.
    ///
    /// # Errors
    /// As [`from_observed_points`](Self::from_observed_points).
    pub fn update<P: PointLike>(
        &mut self,
        points: &[P],
        rays: &[Ray],
        config: &ObstacleConfig,
        rng: &mut impl Rng,
    ) -> Result<ObstacleUpdate, ObstacleError> {
        config.validate()?;
        if let Some(index) = rays.iter().position(|ray| !ray.is_finite()) {
            return Err(ObstacleError::RayNotFinite { index });
        }
        let points = finite_points(points).map_err(|index| KMeansError::NotFinite { index })?;
        if points.is_empty() {
            *self = ObstacleSet::default();
            return Ok(ObstacleUpdate {
                reused: 0,
                built: 0,
                iterations: 0,
            });
        }
        let mut kmeans_config = config.kmeans.clone();
        kmeans_config.clusters = kmeans_config.clusters.min(points.len());
        if !self.centroids.is_empty() {
            // A warm start is to stay near where it was.
            kmeans_config.swap_rounds = 0;
        }
        let clustering = kmeans_from(&points, &self.centroids, &kmeans_config, rng)?;
        let former = Former::of(self);
        let hulls = split::hulls(&points, clustering.members(), rays, config, |members| {
            former
                .hull(&points, &members)
                .unwrap_or_else(|| hull::build(&points, members))
        });
        let reused = hulls
            .iter()
            .filter(|hull| former.holds(&points, hull))
            .count();
        let built = hulls.len() - reused;
        self.inertia = clustering.inertia;
        self.centroids = clustering.centroids;
        self.replace(hulls, points);
        Ok(ObstacleUpdate {
            reused,
            built,
            iterations: clustering.iterations,
        })
    }
}

/// The hulls before the update, found by their first point.
struct Former<'a> {
    set: &'a ObstacleSet,
    hull_of_point: Vec<usize>,
}

impl<'a> Former<'a> {
    fn of(set: &'a ObstacleSet) -> Self {
        let mut hull_of_point = vec![usize::MAX; set.points.len()];
        for (number, hull) in set.hulls.iter().enumerate() {
            for &index in &hull.point_indices {
                hull_of_point[index] = number;
            }
        }
        Former { set, hull_of_point }
    }

    /// The former hull of exactly these points, if none of them has moved.
    fn hull(&self, points: &[Vec3], members: &[usize]) -> Option<Hull> {
        let hull = self
            .set
            .hulls
            .get(*self.hull_of_point.get(*members.first()?)?)?;
        let same = hull.point_indices == members
            && members
                .iter()
                .all(|&index| points[index] == self.set.points[index]);
        same.then(|| hull.clone())
    }

    fn holds(&self, points: &[Vec3], hull: &Hull) -> bool {
        self.hull(points, &hull.point_indices).is_some()
    }
}
