//! K-means clustering of points in space: seeding, exact and approximate iterations, warm start.

mod accelerated;
mod config;
mod error;
mod iterate;
mod lloyd;
mod mini_batch;
mod neighbours;
mod plus_plus;
mod repair;
mod scalable;
mod swap;
mod tree;

pub use config::{KMeansConfig, KMeansMethod, KMeansSeeding};
pub use error::KMeansError;

use crate::point::{PointLike, finite_points};
use crate::vector::{Vec3, distance_squared};
use rand::Rng;

/// The outcome of [`kmeans`]: a partition of the points and the mean of each part.
#[derive(Clone, Debug, PartialEq)]
pub struct Clustering {
    /// For each point, in input order, the index of its centroid.
    pub labels: Vec<usize>,
    /// The mean of each cluster. No cluster is empty, so there are fewer than asked for where the
    /// input has fewer distinct points.
    pub centroids: Vec<[f64; 3]>,
    /// Sum of squared distances from the points to their centroids, squared input units.
    pub inertia: f64,
    /// Passes over the data after seeding.
    pub iterations: usize,
    /// Why the iteration stopped.
    pub stop: KMeansStop,
}

impl Clustering {
    /// The indices of the points of each cluster, ascending.
    #[must_use]
    pub fn members(&self) -> Vec<Vec<usize>> {
        let mut members = vec![Vec::new(); self.centroids.len()];
        for (index, &label) in self.labels.iter().enumerate() {
            members[label].push(index);
        }
        members
    }
}

/// Why K-means stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KMeansStop {
    /// No label changed: a local minimum of the inertia.
    Converged,
    /// The centroids moved less than [`KMeansConfig::tolerance`].
    Tolerance,
    /// [`KMeansConfig::max_iterations`] passes were done.
    MaxIterations,
}

/// Partitions `points` into at most `config.clusters` clusters of small inertia.
///
/// The exact methods ([`KMeansMethod::Lloyd`] and [`KMeansMethod::Accelerated`]) give the same bits.
/// The result depends on the points, the configuration and the state of `rng` alone, never on threads.
///
/// Duplicates are kept and share a label. Where there are fewer distinct points than clusters, each
/// distinct point becomes one cluster. Cost per iteration: O(n K) for Lloyd, about O(n + K log K) for the
/// accelerated method; memory O(n + K).
///
/// # Errors
/// No points, a coordinate that is not finite, no clusters or more clusters than points, or a
/// configuration out of its range.
///
/// # Example
/// ```
/// use rand::SeedableRng;
/// use sparse_to_obstacles::{KMeansConfig, kmeans};
///
/// let points = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [5.0, 0.0, 0.0], [5.1, 0.0, 0.0]];
/// let config = KMeansConfig { clusters: 2, ..KMeansConfig::default() };
/// let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
/// let clustering = kmeans(&points, &config, &mut rng)?;
/// assert_eq!(clustering.labels[0], clustering.labels[1]);
/// assert_ne!(clustering.labels[0], clustering.labels[2]);
/// # Ok::<(), sparse_to_obstacles::KMeansError>(())
/// ```
pub fn kmeans<P: PointLike>(
    points: &[P],
    config: &KMeansConfig,
    rng: &mut impl Rng,
) -> Result<Clustering, KMeansError> {
    let points = checked(points, config)?;
    let seeds = match config.seeding {
        KMeansSeeding::PlusPlus { trials } => {
            plus_plus::seed(&points, &[], config.clusters, trials, rng)
        }
        KMeansSeeding::Parallel {
            rounds,
            oversampling,
        } => scalable::seed(&points, config.clusters, rounds, oversampling, rng),
    };
    Ok(iterate::run(&points, seeds, config, rng))
}

/// K-means from the centroids of a former run: the warm start for a map that has grown.
///
/// Centroids that are not finite are ignored, surplus ones are dropped from the end, missing ones are
/// added by k-means++ among the points. Otherwise as [`kmeans`].
///
/// # Errors
/// As [`kmeans`].
pub fn kmeans_from<P: PointLike>(
    points: &[P],
    centroids: &[[f64; 3]],
    config: &KMeansConfig,
    rng: &mut impl Rng,
) -> Result<Clustering, KMeansError> {
    let points = checked(points, config)?;
    let known: Vec<Vec3> = centroids
        .iter()
        .copied()
        .filter(|centroid| crate::point::is_finite(*centroid))
        .take(config.clusters)
        .collect();
    let trials = match config.seeding {
        KMeansSeeding::PlusPlus { trials } => trials,
        KMeansSeeding::Parallel { .. } => None,
    };
    let seeds = plus_plus::seed(&points, &known, config.clusters, trials, rng);
    Ok(iterate::run(&points, seeds, config, rng))
}

fn checked<P: PointLike>(points: &[P], config: &KMeansConfig) -> Result<Vec<Vec3>, KMeansError> {
    config.validate()?;
    if points.is_empty() {
        return Err(KMeansError::NoPoints);
    }
    if config.clusters > points.len() {
        let (clusters, points) = (config.clusters, points.len());
        return Err(KMeansError::TooManyClusters { clusters, points });
    }
    usable_points(points)
}

/// The points, if all are finite and not so large that their squares overflow.
pub(crate) fn usable_points<P: PointLike>(points: &[P]) -> Result<Vec<Vec3>, KMeansError> {
    let points = finite_points(points).map_err(|index| KMeansError::NotFinite { index })?;
    let too_large = |point: &Vec3| point.iter().any(|c| c.abs() > LARGEST);
    match points.iter().position(too_large) {
        Some(index) => Err(KMeansError::TooLarge {
            index,
            largest: LARGEST,
        }),
        None => Ok(points),
    }
}

/// Coordinates beyond this overflow when squared distances are summed.
const LARGEST: f64 = 1e140;

pub(crate) fn inertia(points: &[Vec3], labels: &[usize], centroids: &[Vec3]) -> f64 {
    points
        .iter()
        .zip(labels)
        .map(|(point, &label)| distance_squared(*point, centroids[label]))
        .sum()
}

#[cfg(test)]
mod tests;
