//! Nearest neighbour by looking at every point: the reference for the tree.

use super::closer;
use crate::euclid::squared_distance;

/// Points in the order of insertion, searched one by one.
#[derive(Clone, Debug, Default)]
pub struct LinearScan<const D: usize> {
    points: Vec<[f64; D]>,
}

impl<const D: usize> LinearScan<D> {
    /// No points yet.
    pub fn new() -> Self {
        Self { points: Vec::new() }
    }

    /// Adds a point; its index is the number of points before it. O(1).
    pub fn insert(&mut self, point: [f64; D]) {
        self.points.push(point);
    }

    /// Index of the nearest point and the squared distance to it; the lowest index of equals. `None` without points. O(n).
    pub fn nearest(&self, query: &[f64; D]) -> Option<(usize, f64)> {
        let mut best = (usize::MAX, f64::INFINITY);
        for (index, point) in self.points.iter().enumerate() {
            let squared = squared_distance(query, point);
            if closer(&(index, squared), &best) {
                best = (index, squared);
            }
        }
        (best.0 != usize::MAX).then_some(best)
    }

    /// The `k` nearest points, each with its squared distance, nearest first; of equals the lower index first. O(n log n).
    pub fn nearest_k(&self, query: &[f64; D], k: usize) -> Vec<(usize, f64)> {
        let mut all: Vec<(usize, f64)> = self
            .points
            .iter()
            .map(|point| squared_distance(query, point))
            .enumerate()
            .filter(|found| found.1 < f64::INFINITY)
            .collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        all.truncate(k);
        all
    }

    /// Indices of all points at most `radius` away, ascending. O(n).
    pub fn within(&self, query: &[f64; D], radius: f64) -> Vec<usize> {
        let limit = if radius >= 0.0 { radius * radius } else { -1.0 };
        (0..self.points.len())
            .filter(|&index| squared_distance(query, &self.points[index]) <= limit)
            .collect()
    }
}
