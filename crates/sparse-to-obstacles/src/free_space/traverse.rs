//! Which voxels a ray, or the narrow cone around it, crosses.
//!
//! The axis is followed from voxel to voxel (Amanatides and Woo, "A fast voxel traversal algorithm for
//! ray tracing", 1987). Where the cone is wider than a voxel, the voxels whose centres it contains are
//! added, layer by layer along the axis that the ray mostly follows.

use super::config::FreeSpaceConfig;
use super::grid::Grid;
use super::ray::Ray;
use crate::vector::{Vec3, distance, dot, lerp, norm_squared, scale, sub};
use std::ops::ControlFlow;

/// The part of a ray that is carved, or `None` where nothing is.
pub(super) fn carved(ray: &Ray, config: &FreeSpaceConfig) -> Option<(Vec3, Vec3)> {
    let length = distance(ray.origin, ray.end);
    let carved = config.carved_length(length);
    (carved > 0.0 && length.is_finite())
        .then(|| (ray.origin, lerp(ray.origin, ray.end, carved / length)))
}

/// Visits the voxels of the cone around a carved ray, some of them twice.
pub(super) fn visit_cone(
    grid: &Grid,
    (from, to): (Vec3, Vec3),
    config: &FreeSpaceConfig,
    mut visit: impl FnMut(usize),
) {
    let _: ControlFlow<()> = visit_line(grid, (from, to), |index| {
        visit(index);
        ControlFlow::Continue(())
    });
    let widening = config.patch_half_angle.tan();
    if distance(from, to) * widening > 0.5 * grid.resolution {
        widen(grid, from, to, widening, visit);
    }
}

/// Visits the voxels along a segment until told to stop.
pub(super) fn visit_line<B>(
    grid: &Grid,
    (from, to): (Vec3, Vec3),
    mut visit: impl FnMut(usize) -> ControlFlow<B>,
) -> ControlFlow<B> {
    let mut cell = grid.cell_of(from);
    let last = grid.cell_of(to);
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
            next[axis] = (border as f64 * grid.resolution - from[axis]) / along[axis];
            stride[axis] = grid.resolution / along[axis].abs();
        }
    }
    // Both ends lie in the grid, and so does all between them.
    let Some(index) = grid.index(cell) else {
        return ControlFlow::Continue(());
    };
    let mut index = index as isize;
    let strides = grid.strides().map(|stride| stride as isize);
    for _ in 0..=left {
        visit(index as usize)?;
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
    ControlFlow::Continue(())
}

/// Visits the voxels whose centres lie in the cone.
fn widen(grid: &Grid, from: Vec3, to: Vec3, widening: f64, mut visit: impl FnMut(usize)) {
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
    let resolution = grid.resolution;
    let start = lerp(
        from,
        to,
        (0.5 * resolution / widening) / length_squared.sqrt(),
    );
    let first = grid.cell_of(start)[main];
    let last = grid.cell_of(to)[main];
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
                let offset = sub(grid.centre(cell), from);
                let share = dot(offset, along) / length_squared;
                let aside = norm_squared(sub(offset, scale(along, share)));
                let radius_squared = (widening * share).powi(2) * length_squared;
                if (0.0..=1.0).contains(&share)
                    && aside <= radius_squared
                    && let Some(index) = grid.index(cell)
                {
                    visit(index);
                }
            }
        }
    }
}
