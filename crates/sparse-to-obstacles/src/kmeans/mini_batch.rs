//! Mini-batch K-means: random batches pull their nearest centroids by a falling learning rate.
//!
//! References: Sculley, "Web-scale k-means clustering", WWW 2010.

use super::iterate::variance;
use super::tree::CentroidTree;
use super::{KMeansConfig, KMeansStop};
use crate::vector::{Vec3, distance_squared, lerp};
use rand::{Rng, RngExt};

/// Batches whose mean squared movement must stay under the tolerance before the iteration stops.
const CALM: usize = 5;

/// Returns the centroids, the number of batches and why it stopped. `max_iterations` counts batches.
pub(super) fn run(
    points: &[Vec3],
    mut centroids: Vec<Vec3>,
    batch: usize,
    config: &KMeansConfig,
    rng: &mut impl Rng,
) -> (Vec<Vec3>, usize, KMeansStop) {
    let batch = batch.min(points.len());
    let limit = config.tolerance * variance(points);
    let mut counts = vec![0.0; centroids.len()];
    let mut calm = 0;
    for batches in 1..=config.max_iterations {
        let tree = CentroidTree::new(&centroids);
        let drawn: Vec<(Vec3, usize)> = (0..batch)
            .map(|_| points[rng.random_range(0..points.len())])
            .map(|point| (point, tree.nearest_two(point).index))
            .collect();
        let before = centroids.clone();
        for (point, nearest) in drawn {
            counts[nearest] += 1.0;
            centroids[nearest] = lerp(centroids[nearest], point, 1.0 / counts[nearest]);
        }
        let movement: f64 = before
            .iter()
            .zip(&centroids)
            .map(|(a, b)| distance_squared(*a, *b))
            .sum();
        calm = if movement <= limit { calm + 1 } else { 0 };
        if calm == CALM {
            return (centroids, batches, KMeansStop::Tolerance);
        }
    }
    (centroids, config.max_iterations, KMeansStop::MaxIterations)
}
