//! Carving: what the rays of a call say about the voxels of a grid.
//!
//! First every ray counts, for the voxels that it crosses and against the one in which it ends. By these counts some points are
//! [wrong](super::trust); the rays to all others, and the triangles between them, then prove what they cross.

use super::config::FreeSpaceConfig;
use super::evidence::{Evidence, KeyframeId, Sighting};
use super::grid::Grid;
use super::interpolate;
use super::traverse::{carved, visit_cone};
use super::trust::Trust;
use crate::vector::distance;

pub(super) struct Carver<'a> {
    pub(super) config: &'a FreeSpaceConfig,
    pub(super) grid: &'a Grid,
    pub(super) evidence: &'a mut [Evidence],
    /// The number of the last ray, which tells a voxel whether it has been counted.
    pub(super) rays: &'a mut u32,
}

impl Carver<'_> {
    /// Counts what a ray crosses and where it ends.
    pub(super) fn count(&mut self, sighting: &Sighting) {
        let ray = &sighting.ray;
        // Numbers wrap after four billion rays and skip 0, which means none.
        *self.rays = self.rays.checked_add(1).unwrap_or(1);
        if distance(ray.origin, ray.end) <= self.config.max_range
            && let Some(index) = self.grid.index_of(ray.end)
        {
            self.evidence[index].end();
        }
        let number = *self.rays;
        if let Some(segment) = carved(ray, self.config) {
            visit_cone(self.grid, segment, self.config, |index| {
                self.evidence[index].cross(number);
            });
        }
    }

    /// Makes a keyframe a witness of all that its rays, and the triangles between them, have crossed, but for those of wrong points.
    pub(super) fn prove(&mut self, sightings: &[Sighting], keyframe: KeyframeId, trust: &Trust) {
        for sighting in sightings {
            if trust.is_wrong(sighting.point) {
                continue;
            }
            if let Some(segment) = carved(&sighting.ray, self.config) {
                visit_cone(self.grid, segment, self.config, |index| {
                    self.evidence[index].witness(keyframe, sighting.alone(), true);
                });
            }
        }
        self.prove_between(sightings, keyframe, trust);
    }

    /// The same for what lies between neighbouring rays: the voxels whose centres lie there.
    fn prove_between(&mut self, sightings: &[Sighting], keyframe: KeyframeId, trust: &Trust) {
        if self.config.max_triangle_angle <= 0.0 {
            return;
        }
        // Wrong points take part in the triangulation: without a true one among them triangles would reach past it.
        let Some(panorama) = interpolate::between(sightings, self.config) else {
            return;
        };
        let (low, high) = panorama.extent();
        for (first, indices) in self.grid.around(low, high, 0.0).rows(self.grid) {
            let [x, y, z] = self.grid.centre(first);
            for (step, voxel) in self.evidence[indices].iter_mut().enumerate() {
                let place = [x, y, z + step as f64 * self.grid.resolution];
                if let Some(view) = panorama.seen_through(place)
                    && !view.corners.iter().any(|&corner| trust.is_wrong(corner))
                {
                    voxel.witness(keyframe, view.corners, view.gap <= self.config.max_gap);
                }
            }
        }
    }
}
