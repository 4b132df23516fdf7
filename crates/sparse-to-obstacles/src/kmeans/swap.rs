//! Escape from poor local minima: centroids that are hardly missed move to clusters that need two.
//!
//! Method: 1. price each centroid by how much the inertia grows without it (every point knows its second
//! nearest centroid); 2. the cheapest ones leave, and as many of the clusters of largest inertia get a
//! second centroid at their farthest point; 3. iterate as before; 4. keep the outcome only if the inertia
//! fell, else try half as many.
//!
//! References: Fritzke, "Breathing k-means", arXiv 2006.15666, from which it departs by removing and
//! adding at once.

use super::Clustering;
use super::neighbours::Neighbours;
use super::plus_plus::Seeds;
use super::tree::CentroidTree;
use crate::vector::{Vec3, distance_squared};

/// The share of the centroids that moves in the first round.
const SHARE: usize = 8;

/// Up to `rounds` rounds. `improve` iterates from given centroids. The inertia never grows.
pub(super) fn improve(
    points: &[Vec3],
    mut best: Clustering,
    rounds: usize,
    mut improve: impl FnMut(Seeds) -> Clustering,
) -> Clustering {
    let mut moving = best.centroids.len().div_ceil(SHARE);
    for _ in 0..rounds {
        let Some(centroids) = swapped(points, &best, moving) else {
            break;
        };
        let candidate = improve(Seeds {
            centroids,
            labels: best.labels.clone(),
        });
        let iterations = best.iterations + candidate.iterations;
        if candidate.inertia < best.inertia {
            best = candidate;
        } else {
            moving /= 2;
        }
        best.iterations = iterations;
    }
    best
}

/// The centroids after `moving` of them have changed place, or `None` where nothing is to be gained.
fn swapped(points: &[Vec3], clustering: &Clustering, moving: usize) -> Option<Vec<Vec3>> {
    let needs = Needs::of(points, clustering);
    let count = clustering.centroids.len();
    let mut cheapest: Vec<usize> = (0..count).collect();
    cheapest.sort_by(|&a, &b| needs.price[a].total_cmp(&needs.price[b]).then(a.cmp(&b)));
    let mut neediest: Vec<usize> = (0..count).collect();
    neediest.sort_by(|&a, &b| {
        needs.inertia[b]
            .total_cmp(&needs.inertia[a])
            .then(a.cmp(&b))
    });
    let mut centroids = clustering.centroids.clone();
    let mut swaps = 0;
    for (&leaving, &target) in cheapest.iter().zip(&neediest).take(moving) {
        if leaving != target && needs.inertia[target] > needs.price[leaving] {
            centroids[leaving] = points[needs.farthest[target]];
            swaps += 1;
        }
    }
    (swaps > 0).then_some(centroids)
}

/// Per cluster: what its centroid saves, its share of the inertia, and its farthest point.
struct Needs {
    price: Vec<f64>,
    inertia: Vec<f64>,
    farthest: Vec<usize>,
}

impl Needs {
    fn of(points: &[Vec3], clustering: &Clustering) -> Self {
        let tree = CentroidTree::new(&clustering.centroids);
        let neighbours = Neighbours::new(&clustering.centroids, &tree);
        let count = clustering.centroids.len();
        let mut needs = Needs {
            price: vec![0.0; count],
            inertia: vec![0.0; count],
            farthest: vec![0; count],
        };
        let mut widest = vec![f64::NEG_INFINITY; count];
        for (index, (&point, &label)) in points.iter().zip(&clustering.labels).enumerate() {
            let squared = distance_squared(point, clustering.centroids[label]);
            let near = neighbours.nearest_two(&clustering.centroids, point, label);
            let two = near.unwrap_or_else(|| tree.nearest_two(point));
            needs.price[label] += (two.second_squared - squared).max(0.0);
            needs.inertia[label] += squared;
            if squared > widest[label] {
                widest[label] = squared;
                needs.farthest[label] = index;
            }
        }
        needs
    }
}
