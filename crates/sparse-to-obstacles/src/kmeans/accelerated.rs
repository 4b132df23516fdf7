//! The same assignment as Lloyd's, with most points proved unchanged by distance bounds.
//!
//! Each point keeps an upper bound of the distance to its centroid and a lower bound of the distance to
//! every other one. When the centroids move, the bounds widen by the movements. While upper < lower the
//! label cannot change; the other points search a k-d tree of the centroids for the two nearest.
//! Bounds are kept a little slack, so that rounding can only cause a search, never a wrong label: the
//! labels equal Lloyd's bit for bit, ties included.
//!
//! References: Hamerly, "Making k-means even faster", SDM 2010.

use super::iterate::Assignment;
use super::tree::CentroidTree;
use crate::vector::{Vec3, distance};

/// Relative slack of the bounds: far above the rounding of the few operations between refreshes.
const SLACK: f64 = 1e-9;
/// Absolute slack: squares of shorter distances have lost digits.
const LEAST: f64 = 1e-150;

pub(super) struct Accelerated {
    bounds: Vec<Bounds>,
    /// How far each centroid moved since the bounds were updated, and the two largest movements.
    moves: Vec<f64>,
    largest: (usize, f64),
    second_largest: f64,
}

#[derive(Clone, Copy)]
struct Bounds {
    upper: f64,
    lower: f64,
}

impl Bounds {
    const UNKNOWN: Bounds = Bounds {
        upper: f64::INFINITY,
        lower: 0.0,
    };
}

impl Accelerated {
    pub(super) fn new(points: usize) -> Self {
        Accelerated {
            bounds: vec![Bounds::UNKNOWN; points],
            moves: Vec::new(),
            largest: (0, 0.0),
            second_largest: 0.0,
        }
    }

    fn widen(&self, bounds: &mut Bounds, label: usize) {
        let Some(&own) = self.moves.get(label) else {
            return;
        };
        let other = if label == self.largest.0 {
            self.second_largest
        } else {
            self.largest.1
        };
        bounds.upper = (bounds.upper + own) * (1.0 + SLACK) + LEAST;
        bounds.lower = ((bounds.lower - other) * (1.0 - SLACK) - LEAST).max(0.0);
    }

    fn assign_one(
        &self,
        tree: &CentroidTree,
        centroids: &[Vec3],
        point: Vec3,
        of: (&mut Bounds, &mut usize),
    ) {
        let (bounds, label) = of;
        self.widen(bounds, *label);
        if bounds.upper < bounds.lower {
            return;
        }
        if bounds.upper.is_finite() {
            bounds.upper = distance(point, centroids[*label]) * (1.0 + SLACK) + LEAST;
            if bounds.upper < bounds.lower {
                return;
            }
        }
        let nearest = tree.nearest_two(point);
        *label = nearest.index;
        bounds.upper = nearest.squared.sqrt() * (1.0 + SLACK) + LEAST;
        bounds.lower = nearest.second_squared.sqrt() * (1.0 - SLACK);
    }
}

impl Assignment for Accelerated {
    #[cfg(not(feature = "rayon"))]
    fn assign(&mut self, points: &[Vec3], centroids: &[Vec3], labels: &mut [usize]) {
        let tree = CentroidTree::new(centroids);
        let mut bounds = std::mem::take(&mut self.bounds);
        for ((point, label), bounds) in points.iter().zip(labels).zip(&mut bounds) {
            self.assign_one(&tree, centroids, *point, (bounds, label));
        }
        self.bounds = bounds;
    }

    #[cfg(feature = "rayon")]
    fn assign(&mut self, points: &[Vec3], centroids: &[Vec3], labels: &mut [usize]) {
        use rayon::prelude::*;
        let tree = CentroidTree::new(centroids);
        let mut bounds = std::mem::take(&mut self.bounds);
        points
            .par_iter()
            .zip(labels.par_iter_mut())
            .zip(bounds.par_iter_mut())
            .with_min_len(1024)
            .for_each(|((point, label), bounds)| {
                self.assign_one(&tree, centroids, *point, (bounds, label));
            });
        self.bounds = bounds;
    }

    fn moved(&mut self, before: &[Vec3], after: &[Vec3]) {
        self.moves = before
            .iter()
            .zip(after)
            .map(|(a, b)| distance(*a, *b))
            .collect();
        self.largest = (0, 0.0);
        self.second_largest = 0.0;
        for (index, &length) in self.moves.iter().enumerate() {
            if length > self.largest.1 {
                self.second_largest = self.largest.1;
                self.largest = (index, length);
            } else if length > self.second_largest {
                self.second_largest = length;
            }
        }
    }

    fn relabelled(&mut self, point: usize) {
        self.bounds[point] = Bounds::UNKNOWN;
    }
}
