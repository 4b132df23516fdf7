//! The space between neighbouring rays of a keyframe: triangles of a spherical Delaunay triangulation.
//!
//! Method: 1. the directions of a keyframe's points are projected stereographically from the point
//! opposite to their mean, which maps circles to circles, so that the planar Delaunay triangulation is
//! the spherical one; 2. triangles with a long edge or unequal depths are dropped, since the surface
//! between their corners is a guess; 3. the rest is filled with rays to places on the triangle that are
//! about a voxel apart.

use super::config::FreeSpaceConfig;
use super::ray::Ray;
use crate::vector::{Vec3, add, cross, distance, dot, lerp, orthogonal, scale, sub, unit};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// Calls `fill` with each triangle of neighbouring points that all were seen from one place, as rays to
/// places on it. `rays` are those of one keyframe.
pub(super) fn between(
    rays: &[Ray],
    config: &FreeSpaceConfig,
    mut fill: impl FnMut(&mut dyn Iterator<Item = Ray>),
) {
    let Some(triangulation) = triangulate(rays) else {
        return;
    };
    for face in triangulation.inner_faces() {
        let triangle = face.vertices().map(|vertex| rays[vertex.data().ray]);
        if is_continuous(&triangle, config) {
            fill(&mut places(triangle, config));
        }
    }
}

/// A direction on the plane of projection.
struct Direction {
    position: Point2<f64>,
    ray: usize,
}

impl HasPosition for Direction {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

fn triangulate(rays: &[Ray]) -> Option<DelaunayTriangulation<Direction>> {
    let directions: Vec<Option<Vec3>> = rays
        .iter()
        .map(|ray| unit(sub(ray.end, ray.origin)))
        .collect();
    let sum = directions
        .iter()
        .flatten()
        .fold([0.0; 3], |sum, &direction| add(sum, direction));
    let ahead = unit(sum).unwrap_or([0.0, 0.0, 1.0]);
    let right = orthogonal(ahead);
    let down = cross(ahead, right);
    let mut projected: Vec<Direction> = directions
        .iter()
        .enumerate()
        .filter_map(|(ray, direction)| {
            let direction = (*direction)?;
            let from_pole = 1.0 + dot(direction, ahead);
            // The pole itself, opposite to where the camera looks, has no image.
            let onto = |axis: Vec3| flushed(dot(direction, axis) / from_pole);
            let position = Point2::new(onto(right), onto(down));
            (from_pole > 1e-6).then_some(Direction { position, ray })
        })
        .collect();
    // Of points in the same direction, the nearest counts.
    let depth = |ray: usize| distance(rays[ray].origin, rays[ray].end);
    projected.sort_by(|a, b| {
        let (p, q) = (a.position, b.position);
        p.x.total_cmp(&q.x)
            .then(p.y.total_cmp(&q.y))
            .then(depth(a.ray).total_cmp(&depth(b.ray)))
            .then(a.ray.cmp(&b.ray))
    });
    projected.dedup_by(|later, first| later.position == first.position);
    DelaunayTriangulation::bulk_load_stable(projected).ok()
}

/// Triangulation refuses what is almost but not quite 0.
fn flushed(value: f64) -> f64 {
    if value.abs() < 1e-100 { 0.0 } else { value }
}

fn is_continuous(triangle: &[Ray; 3], config: &FreeSpaceConfig) -> bool {
    let [a, b, c] = triangle.map(|ray| sub(ray.end, ray.origin));
    let angle = |p: Vec3, q: Vec3| crate::vector::norm(cross(p, q)).atan2(dot(p, q));
    let widest = angle(a, b).max(angle(b, c)).max(angle(c, a));
    let depths = triangle.map(|ray| distance(ray.origin, ray.end));
    let deepest = depths.iter().fold(0.0, |most: f64, &depth| most.max(depth));
    let nearest = depths
        .iter()
        .fold(f64::INFINITY, |least: f64, &depth| least.min(depth));
    widest <= config.max_triangle_angle && deepest <= config.max_depth_ratio * nearest
}

/// How far apart, in voxels, rays may be before what lies between them is filled.
const GAP: f64 = 0.7;

/// Longest edge of the parts of a triangle that get a ray each, in voxels.
const PART: f64 = 1.4;

/// Rays to the centres of the equal parts of a triangle whose edges are about a voxel long. They start
/// where the triangle's own rays are farther apart than [`GAP`], since before that these cross every
/// voxel that the filling would.
fn places(triangle: [Ray; 3], config: &FreeSpaceConfig) -> impl Iterator<Item = Ray> {
    let origin = triangle[0].origin;
    let [a, b, c] = triangle.map(|ray| {
        let length = distance(origin, ray.end);
        lerp(
            origin,
            ray.end,
            (config.carved_length(length) / length).min(1.0),
        )
    });
    let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
    let from = GAP * config.resolution / longest;
    let parts = if from < 1.0 {
        (longest / (PART * config.resolution)).ceil().min(1000.0) as usize
    } else {
        0
    };
    (0..parts).flat_map(move |i| {
        (0..2 * (parts - i) - 1).map(move |j| {
            // Upright and upside-down parts alternate along a row.
            let third = if j % 2 == 0 { 1.0 / 3.0 } else { 2.0 / 3.0 };
            let u = (i as f64 + third) / parts as f64;
            let v = ((j / 2) as f64 + third) / parts as f64;
            let end = add(a, add(scale(sub(b, a), u), scale(sub(c, a), v)));
            Ray {
                origin: lerp(origin, end, from),
                end,
            }
        })
    })
}
