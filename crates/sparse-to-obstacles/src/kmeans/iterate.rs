//! The iteration that all methods share: assign, repair, move the centroids, decide whether to stop.

use super::accelerated::Accelerated;
use super::lloyd::Lloyd;
use super::plus_plus::Seeds;
use super::{
    Clustering, KMeansConfig, KMeansMethod, KMeansStop, inertia, mini_batch, repair, swap,
};
use crate::vector::{Vec3, distance_squared, sub};
use rand::Rng;

/// One way to find the nearest centroid of every point, ties to the lowest index.
pub(super) trait Assignment {
    /// `labels` come in as those of before, or as any guess.
    fn assign(&mut self, points: &[Vec3], centroids: &[Vec3], labels: &mut [usize]);
    /// The centroids moved since the last assignment.
    fn moved(&mut self, before: &[Vec3], after: &[Vec3]);
    /// The label of a point was changed from outside.
    fn relabelled(&mut self, point: usize);
}

pub(super) fn run(
    points: &[Vec3],
    seeds: Seeds,
    config: &KMeansConfig,
    rng: &mut impl Rng,
) -> Clustering {
    let exact = |from: Seeds| match config.method {
        KMeansMethod::Lloyd => refine(points, from, config, Lloyd),
        _ => refine(points, from, config, Accelerated::new(points.len())),
    };
    if let KMeansMethod::MiniBatch { batch } = config.method {
        let (centroids, batches, stop) =
            mini_batch::run(points, seeds.centroids, batch, config, rng);
        let from = Seeds {
            centroids,
            labels: seeds.labels,
        };
        let once = KMeansConfig {
            max_iterations: 1,
            ..config.clone()
        };
        let last = refine(points, from, &once, Accelerated::new(points.len()));
        return Clustering {
            iterations: batches,
            stop,
            ..last
        };
    }
    swap::improve(points, exact(seeds), config.swap_rounds, exact)
}

fn refine(
    points: &[Vec3],
    from: Seeds,
    config: &KMeansConfig,
    mut assignment: impl Assignment,
) -> Clustering {
    let Seeds {
        mut centroids,
        mut labels,
    } = from;
    let limit = config.tolerance * variance(points);
    let mut former = Vec::new();
    let mut stop = KMeansStop::MaxIterations;
    let mut iterations = 0;
    while iterations < config.max_iterations {
        iterations += 1;
        former.clone_from(&labels);
        assignment.assign(points, &centroids, &mut labels);
        repair::fill_empty(points, &centroids, &mut labels, &mut assignment);
        if iterations > 1 && labels == former {
            stop = KMeansStop::Converged;
            break;
        }
        let moved_to = means(points, &labels, centroids.len());
        let movement: f64 = centroids
            .iter()
            .zip(&moved_to)
            .map(|(a, b)| distance_squared(*a, *b))
            .sum();
        assignment.moved(&centroids, &moved_to);
        centroids = moved_to;
        if movement <= limit {
            stop = if movement == 0.0 {
                KMeansStop::Converged
            } else {
                KMeansStop::Tolerance
            };
            break;
        }
    }
    let inertia = inertia(points, &labels, &centroids);
    Clustering {
        labels,
        centroids,
        inertia,
        iterations,
        stop,
    }
}

/// The mean of each cluster, summed in the order of the points. No cluster is empty.
fn means(points: &[Vec3], labels: &[usize], clusters: usize) -> Vec<Vec3> {
    let mut sums = vec![[0.0; 4]; clusters];
    for (point, &label) in points.iter().zip(labels) {
        let sum = &mut sums[label];
        sum[0] += point[0];
        sum[1] += point[1];
        sum[2] += point[2];
        sum[3] += 1.0;
    }
    sums.iter()
        .map(|sum| [sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]])
        .collect()
}

/// Variance of the coordinates, averaged over the axes.
pub(super) fn variance(points: &[Vec3]) -> f64 {
    let mean = means(points, &vec![0; points.len()], 1)[0];
    let total: f64 = points
        .iter()
        .map(|point| crate::vector::norm_squared(sub(*point, mean)))
        .sum();
    total / (3.0 * points.len() as f64)
}
