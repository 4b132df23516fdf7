//! The reference assignment: every point against every centroid, ties to the lowest index.

use super::iterate::Assignment;
use crate::vector::{Vec3, distance_squared};

/// Lloyd's assignment step. References: Lloyd, "Least squares quantization in PCM", 1982.
pub(super) struct Lloyd;

impl Assignment for Lloyd {
    fn assign(&mut self, points: &[Vec3], centroids: &[Vec3], labels: &mut [usize]) {
        for (point, label) in points.iter().zip(labels) {
            let mut best = f64::INFINITY;
            for (index, centroid) in centroids.iter().enumerate() {
                let squared = distance_squared(*point, *centroid);
                if squared < best {
                    best = squared;
                    *label = index;
                }
            }
        }
    }

    fn moved(&mut self, _: &[Vec3], _: &[Vec3]) {}

    fn relabelled(&mut self, _: usize) {}
}
