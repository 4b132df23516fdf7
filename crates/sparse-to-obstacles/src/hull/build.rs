//! From a cluster of points to its convex hull, by the rank of the points.

use super::axes::Axes;
use super::{Hull, HullKind, oriented_box, polygon, polytope};
use crate::vector::Vec3;

/// An extent below this share of the largest one counts as none. Hull code in floating point silently
/// drops points of sets thinner than that.
const RANK_TOLERANCE: f64 = 1e-3;

/// The hull of the points with these indices, which must not be empty; all points are finite.
pub(crate) fn build(points: &[Vec3], point_indices: Vec<usize>) -> Hull {
    let mut own: Vec<Vec3> = point_indices.iter().map(|&index| points[index]).collect();
    own.sort_unstable_by(|a, b| {
        a[0].total_cmp(&b[0])
            .then(a[1].total_cmp(&b[1]))
            .then(a[2].total_cmp(&b[2]))
    });
    own.dedup();
    let (kind, (vertices, triangles)) = shape(&own);
    Hull {
        kind,
        vertices,
        triangles,
        point_indices,
    }
}

pub(super) type Mesh = (Vec<Vec3>, Vec<[usize; 3]>);

fn shape(points: &[Vec3]) -> (HullKind, Mesh) {
    if points.len() == 1 {
        return (HullKind::Point, (points.to_vec(), Vec::new()));
    }
    if points.len() == 2 {
        return (HullKind::Segment, (points.to_vec(), Vec::new()));
    }
    let axes = Axes::of(points);
    let extent = axes.extent();
    let thin = RANK_TOLERANCE * extent[0];
    if extent[1] <= thin {
        (HullKind::Segment, oriented_box::around(points, &axes))
    } else if extent[2] <= thin {
        (HullKind::Polygon, polygon::prism(points, &axes))
    } else {
        let mesh = polytope::mesh(points).unwrap_or_else(|| oriented_box::around(points, &axes));
        (HullKind::Polytope, mesh)
    }
}
