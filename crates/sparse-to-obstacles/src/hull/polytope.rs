//! The hull of points that span a volume, with a proof that it contains them.

use super::build::Mesh;
use crate::vector::{Vec3, add, cross, distance, dot, scale, sub, unit};
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;

/// How far outside a face a point may lie, as a share of the extent: rounding.
const CONTAINMENT: f64 = 1e-9;

/// The hull, or `None` where the hull code failed or lost a point.
pub(super) fn mesh(points: &[Vec3]) -> Option<Mesh> {
    // About the first point and of unit size: the hull code's own tolerances are absolute.
    let origin = points[0];
    let size = points
        .iter()
        .map(|&point| distance(point, origin))
        .fold(0.0, f64::max);
    // So small that squares vanish: its inverse would not be a number to scale by.
    if size < 1e-150 {
        return None;
    }
    let local: Vec<Vec3> = points
        .iter()
        .map(|&point| scale(sub(point, origin), 1.0 / size))
        .collect();
    let input: Vec<Vector> = local
        .iter()
        .map(|&[x, y, z]| Vector::new(x, y, z))
        .collect();
    let (vertices, triangles) = try_convex_hull(&input).ok()?;
    let vertices: Vec<Vec3> = vertices
        .iter()
        .map(|vertex| [vertex.x, vertex.y, vertex.z])
        .collect();
    let triangles: Vec<[usize; 3]> = triangles
        .iter()
        .map(|face| face.map(|vertex| vertex as usize))
        .collect();
    if vertices.len() < 4 || !contains_all(&vertices, &triangles, &local) {
        return None;
    }
    let global = |vertex: &Vec3| add(origin, scale(*vertex, size));
    Some((vertices.iter().map(global).collect(), triangles))
}

/// Is every point on the inner side of every face? Faces without an area prove nothing and are skipped.
fn contains_all(vertices: &[Vec3], triangles: &[[usize; 3]], points: &[Vec3]) -> bool {
    let planes = triangles.iter().filter_map(|face| {
        let [a, b, c] = face.map(|vertex| vertices[vertex]);
        let normal = unit(cross(sub(b, a), sub(c, a)))?;
        Some((normal, dot(normal, a)))
    });
    planes.into_iter().all(|(normal, offset)| {
        points
            .iter()
            .all(|&point| dot(normal, point) - offset <= CONTAINMENT)
    })
}
