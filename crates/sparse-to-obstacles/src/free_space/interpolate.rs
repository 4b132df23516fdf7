//! The space between neighbouring rays of a keyframe: triangles of a spherical Delaunay triangulation.
//!
//! Method: 1. the directions of a keyframe's points are projected stereographically from the point
//! opposite to their mean, which maps circles to circles, so that the planar Delaunay triangulation is
//! the spherical one; 2. triangles with a wide angle or unequal depths are dropped, since the surface
//! between their corners is a guess; 3. the others are drawn into a panorama, by which the voxels before
//! them are found.

use super::config::FreeSpaceConfig;
use super::evidence::Sighting;
use super::panorama::{Facet, Panorama, Projection};
use super::ray::Ray;
use crate::vector::{Vec3, add, cross, distance, dot, scale, sub, unit};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// What was seen through between the rays, all from one place; `None` where no triangle is usable.
pub(super) fn between(sightings: &[Sighting], config: &FreeSpaceConfig) -> Option<Panorama> {
    let rays: Vec<Ray> = sightings.iter().map(|sighting| sighting.ray).collect();
    let origin = rays.first()?.origin;
    let directions: Vec<Option<Vec3>> = rays
        .iter()
        .map(|ray| unit(sub(ray.end, ray.origin)))
        .collect();
    let sum = directions
        .iter()
        .flatten()
        .fold([0.0; 3], |sum, &direction| add(sum, direction));
    let projection = Projection::towards(unit(sum).unwrap_or([0.0, 0.0, 1.0]));
    let triangulation = triangulate(&rays, &directions, &projection)?;
    let facets: Vec<Facet> = triangulation
        .inner_faces()
        .filter_map(|face| {
            let vertices = face.vertices().map(|vertex| vertex.data().ray);
            let triangle = vertices.map(|ray| rays[ray]);
            let width = width(&triangle);
            (width <= config.max_triangle_angle && is_continuous(&triangle, config)).then(|| {
                Facet::new(
                    triangle.map(|ray| carved(&ray, config)),
                    face.positions().map(|position| [position.x, position.y]),
                    vertices.map(|ray| sightings[ray].point),
                    width,
                )
            })?
        })
        .collect();
    Panorama::draw(origin, projection, facets, config)
}

/// From the origin to where carving ends on this ray.
fn carved(ray: &Ray, config: &FreeSpaceConfig) -> Vec3 {
    let along = sub(ray.end, ray.origin);
    let length = distance(ray.origin, ray.end);
    scale(along, (config.carved_length(length) / length).min(1.0))
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

fn triangulate(
    rays: &[Ray],
    directions: &[Option<Vec3>],
    projection: &Projection,
) -> Option<DelaunayTriangulation<Direction>> {
    let mut projected: Vec<Direction> = directions
        .iter()
        .enumerate()
        .filter_map(|(ray, direction)| {
            let [x, y] = projection.of((*direction)?, 1.0)?;
            let position = Point2::new(flushed(x), flushed(y));
            Some(Direction { position, ray })
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

/// The widest angle between the corners of a triangle, radians.
fn width(triangle: &[Ray; 3]) -> f64 {
    let [a, b, c] = triangle.map(|ray| sub(ray.end, ray.origin));
    let angle = |p: Vec3, q: Vec3| crate::vector::norm(cross(p, q)).atan2(dot(p, q));
    angle(a, b).max(angle(b, c)).max(angle(c, a))
}

/// Are its depths near enough to each other to be of one surface?
fn is_continuous(triangle: &[Ray; 3], config: &FreeSpaceConfig) -> bool {
    let depths = triangle.map(|ray| distance(ray.origin, ray.end));
    let deepest = depths.iter().fold(0.0, |most: f64, &depth| most.max(depth));
    let nearest = depths
        .iter()
        .fold(f64::INFINITY, |least: f64, &depth| least.min(depth));
    deepest <= config.max_depth_ratio * nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FreeSpace, VoxelState};

    /// Two keyframes that see different triangles of points at x = 4, but for one corner that both of them may share.
    fn two_triangles(first_corner: Vec3, second_corner: Vec3) -> Vec<Ray> {
        let ends = |corner, aside: f64| [[4.0, 0.4, 0.5 - aside], [4.0, 0.4, -0.5 + aside], corner];
        let keyframe = |origin: Vec3, ends: [Vec3; 3]| ends.map(|end| Ray { origin, end });
        let first = keyframe([0.0, 0.05, 0.05], ends(first_corner, 0.0));
        let second = keyframe([0.0, 0.1, 0.05], ends(second_corner, 0.1));
        [first, second].concat()
    }

    #[test]
    fn one_point_opens_no_window_between_rays() {
        let config = FreeSpaceConfig {
            max_triangle_angle: 0.4,
            max_gap: 1.0,
            clearance: 0.0,
            ..FreeSpaceConfig::default()
        };
        // Before a blank wall at x = 3, say: no ray crosses it here.
        let behind_the_wall = [3.25, 0.05, 0.05];
        let nothing: [Vec3; 0] = [];
        let state = |rays: Vec<Ray>| {
            let space = FreeSpace::from_rays(rays, &nothing, &config).unwrap();
            space.state(behind_the_wall)
        };
        let wrong = [4.0, -0.6, 0.05];
        let others = two_triangles(wrong, [4.0, -0.65, 0.05]);
        assert_eq!(state(others), VoxelState::Free, "the points differ");
        let shared = two_triangles(wrong, wrong);
        assert_eq!(
            state(shared.clone()),
            VoxelState::Unknown,
            "all hang on one"
        );
        // A ray of each keyframe is proof by itself, but not to one point.
        let keyframes = [shared[0].origin, shared[3].origin];
        let rays = |ends: [Vec3; 2]| {
            let rays = [0, 1].map(|i| Ray {
                origin: keyframes[i],
                end: ends[i],
            });
            state([&shared[..], &rays].concat())
        };
        let [end, other] = [[4.0, 0.05, 0.05], [4.0, 0.05, 0.06]];
        assert_eq!(rays([end, other]), VoxelState::Free);
        assert_eq!(rays([end, end]), VoxelState::Unknown);
    }

    #[test]
    fn wide_triangles_alone_prove_nothing() {
        let rays = two_triangles([4.0, -0.6, 0.05], [4.0, -0.65, 0.05]);
        let nothing: [Vec3; 0] = [];
        let state = |max_gap: f64, rays: Vec<Ray>, place: Vec3| {
            let config = FreeSpaceConfig {
                max_triangle_angle: 0.4,
                max_gap,
                clearance: 0.0,
                ..FreeSpaceConfig::default()
            };
            let space = FreeSpace::from_rays(rays, &nothing, &config).unwrap();
            space.state(place)
        };
        // Both triangles are 1.1 m wide at 4 m: 0.7 m at the nearer place and 0.95 m at the farther one.
        let [near, far] = [[2.55, 0.05, 0.05], [3.45, 0.05, 0.05]];
        assert_eq!(state(0.8, rays.clone(), near), VoxelState::Free);
        assert_eq!(state(0.8, rays.clone(), far), VoxelState::Unknown);
        assert_eq!(state(1.0, rays.clone(), far), VoxelState::Free);
        // One ray vouches for them.
        let ray = Ray {
            origin: rays[0].origin,
            end: [4.0, 0.05, 0.05],
        };
        assert_eq!(
            state(0.8, [rays, vec![ray]].concat(), far),
            VoxelState::Free
        );
    }
}
