//! k-means|| seeding: a few rounds that draw many candidates at once, then weighted k-means++.
//!
//! References: Bahmani, Moseley, Vattani, Kumar and Vassilvitskii, "Scalable k-means++", VLDB 2012.

use super::plus_plus::{self, Seeds};
use super::tree::CentroidTree;
use crate::vector::{Vec3, distance_squared};
use rand::{Rng, RngExt};

/// Draws `count` seeds; where too few distinct candidates came up, plain k-means++ adds the rest.
pub(super) fn seed(
    points: &[Vec3],
    count: usize,
    rounds: usize,
    oversampling: f64,
    rng: &mut impl Rng,
) -> Seeds {
    let candidates = candidates(points, rounds, oversampling * count as f64, rng);
    let tree = CentroidTree::new(&candidates);
    let nearest: Vec<usize> = points
        .iter()
        .map(|&point| tree.nearest_two(point).index)
        .collect();
    let mut weights = vec![0.0; candidates.len()];
    for &candidate in &nearest {
        weights[candidate] += 1.0;
    }
    let seeds = plus_plus::seed_weighted(&candidates, Some(&weights), &[], count, None, rng);
    if seeds.centroids.len() < count {
        return plus_plus::seed(points, &seeds.centroids, count, None, rng);
    }
    Seeds {
        labels: nearest
            .iter()
            .map(|&candidate| seeds.labels[candidate])
            .collect(),
        ..seeds
    }
}

fn candidates(points: &[Vec3], rounds: usize, per_round: f64, rng: &mut impl Rng) -> Vec<Vec3> {
    let mut candidates = vec![points[rng.random_range(0..points.len())]];
    let mut squared: Vec<f64> = points
        .iter()
        .map(|&point| distance_squared(point, candidates[0]))
        .collect();
    for _ in 0..rounds {
        let total: f64 = squared.iter().sum();
        if total <= 0.0 {
            break;
        }
        let drawn: Vec<Vec3> = points
            .iter()
            .zip(&squared)
            .filter(|&(_, &cost)| rng.random::<f64>() * total < per_round * cost)
            .map(|(&point, _)| point)
            .collect();
        if drawn.is_empty() {
            continue;
        }
        let tree = CentroidTree::new(&drawn);
        for (point, cost) in points.iter().zip(&mut squared) {
            *cost = cost.min(tree.nearest_two(*point).squared);
        }
        candidates.extend(drawn);
    }
    candidates
}
