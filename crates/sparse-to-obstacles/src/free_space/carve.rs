//! Carving: which voxels a ray, or the narrow cone around it, has crossed.
//!
//! The axis is followed from voxel to voxel (Amanatides and Woo, "A fast voxel traversal algorithm for
//! ray tracing", 1987). Where the cone is wider than a voxel, the voxels whose centres it contains are
//! added, layer by layer along the axis that the ray mostly follows.

use super::config::FreeSpaceConfig;
use super::evidence::{Evidence, KeyframeId, PointId, Sighting};
use super::grid::Grid;
use super::interpolate;
use crate::vector::{Vec3, distance, dot, lerp, norm_squared, scale, sub};

pub(super) struct Carver<'a> {
    config: &'a FreeSpaceConfig,
    grid: &'a Grid,
    evidence: &'a mut [Evidence],
    /// The number of the last ray, which tells a voxel whether it has been counted.
    rays: &'a mut u32,
}

impl<'a> Carver<'a> {
    pub(super) fn new(
        config: &'a FreeSpaceConfig,
        grid: &'a Grid,
        evidence: &'a mut [Evidence],
        rays: &'a mut u32,
    ) -> Self {
        Carver {
            config,
            grid,
            evidence,
            rays,
        }
    }

    pub(super) fn carve(&mut self, sighting: &Sighting, keyframe: KeyframeId) {
        let Sighting { ray, point } = *sighting;
        // Numbers wrap after four billion rays and skip 0, which means none.
        *self.rays = self.rays.checked_add(1).unwrap_or(1);
        let length = distance(ray.origin, ray.end);
        if length <= self.config.max_range
            && let Some(index) = self.grid.index_of(ray.end)
        {
            self.evidence[index].end();
        }
        let carved = self.config.carved_length(length);
        if carved <= 0.0 || !length.is_finite() {
            return;
        }
        let end = lerp(ray.origin, ray.end, carved / length);
        let number = *self.rays;
        self.follow(ray.origin, end, |voxel| {
            voxel.cross(keyframe, point, number);
        });
        let widening = self.config.patch_half_angle.tan();
        if carved * widening > 0.5 * self.grid.resolution {
            self.widen(ray.origin, end, widening, (keyframe, point));
        }
    }

    /// Carves what lies between neighbouring rays of one keyframe: the voxels whose centres lie there.
    pub(super) fn carve_between(&mut self, sightings: &[Sighting], keyframe: KeyframeId) {
        if self.config.max_triangle_angle <= 0.0 {
            return;
        }
        let Some(panorama) = interpolate::between(sightings, self.config) else {
            return;
        };
        let (low, high) = panorama.extent();
        for (first, indices) in self.grid.around(low, high, 0.0).rows(self.grid) {
            let [x, y, z] = self.grid.centre(first);
            for (step, voxel) in self.evidence[indices].iter_mut().enumerate() {
                let place = [x, y, z + step as f64 * self.grid.resolution];
                if let Some(corners) = panorama.seen_through(place) {
                    voxel.witness(keyframe, corners);
                }
            }
        }
    }

    /// Marks the voxels along a segment.
    fn follow(&mut self, from: Vec3, to: Vec3, mut mark: impl FnMut(&mut Evidence)) {
        let resolution = self.grid.resolution;
        let mut cell = self.grid.cell_of(from);
        let last = self.grid.cell_of(to);
        let along = sub(to, from);
        let mut step = [0_i64; 3];
        let mut next = [f64::INFINITY; 3];
        let mut stride = [f64::INFINITY; 3];
        let mut left = 0;
        for axis in 0..3 {
            left += (last[axis] - cell[axis]).abs();
            if last[axis] != cell[axis] {
                step[axis] = (last[axis] - cell[axis]).signum();
                let border = cell[axis] + i64::from(step[axis] > 0);
                next[axis] = (border as f64 * resolution - from[axis]) / along[axis];
                stride[axis] = resolution / along[axis].abs();
            }
        }
        // Both ends lie in the grid, and so does all between them.
        let Some(index) = self.grid.index(cell) else {
            return;
        };
        let mut index = index as isize;
        let strides = self.grid.strides().map(|stride| stride as isize);
        for _ in 0..=left {
            if let Some(voxel) = self.evidence.get_mut(index as usize) {
                mark(voxel);
            }
            let mut axis = if next[0] <= next[1] { 0 } else { 1 };
            if next[2] < next[axis] {
                axis = 2;
            }
            cell[axis] += step[axis];
            index += strides[axis] * step[axis] as isize;
            next[axis] = if cell[axis] == last[axis] {
                f64::INFINITY
            } else {
                next[axis] + stride[axis]
            };
        }
    }

    /// Marks the voxels whose centres lie in the cone.
    fn widen(
        &mut self,
        from: Vec3,
        to: Vec3,
        widening: f64,
        (keyframe, point): (KeyframeId, PointId),
    ) {
        let along = sub(to, from);
        let length_squared = norm_squared(along);
        let main = (1..3).fold(0, |best, axis| {
            if along[axis].abs() > along[best].abs() {
                axis
            } else {
                best
            }
        });
        let (u, v) = ((main + 1) % 3, (main + 2) % 3);
        let resolution = self.grid.resolution;
        let start = lerp(
            from,
            to,
            (0.5 * resolution / widening) / length_squared.sqrt(),
        );
        let first = self.grid.cell_of(start)[main];
        let last = self.grid.cell_of(to)[main];
        let slant = length_squared.sqrt() / along[main].abs();
        for layer in first.min(last)..=first.max(last) {
            let height = (layer as f64 + 0.5) * resolution - from[main];
            let t = (height / along[main]).clamp(0.0, 1.0);
            let axis_point = lerp(from, to, t);
            let reach = widening * t * length_squared.sqrt() * slant + resolution;
            let low = |axis: usize| ((axis_point[axis] - reach) / resolution).floor() as i64;
            let high = |axis: usize| ((axis_point[axis] + reach) / resolution).floor() as i64;
            for a in low(u)..=high(u) {
                for b in low(v)..=high(v) {
                    let mut cell = [layer; 3];
                    (cell[u], cell[v]) = (a, b);
                    let offset = sub(self.grid.centre(cell), from);
                    let share = dot(offset, along) / length_squared;
                    let aside = norm_squared(sub(offset, scale(along, share)));
                    let radius_squared = (widening * share).powi(2) * length_squared;
                    if (0.0..=1.0).contains(&share)
                        && aside <= radius_squared
                        && let Some(index) = self.grid.index(cell)
                    {
                        self.evidence[index].cross(keyframe, point, *self.rays);
                    }
                }
            }
        }
    }
}
