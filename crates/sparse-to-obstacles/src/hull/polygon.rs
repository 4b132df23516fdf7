//! The hull of points in a plane: a convex polygon, as thick as the points deviate from the plane.

use super::axes::Axes;
use super::build::Mesh;
use crate::vector::Vec3;

/// A prism over the planar hull that contains all points; a flat two-sided polygon where they are
/// coplanar to rounding.
pub(super) fn prism(points: &[Vec3], axes: &Axes) -> Mesh {
    let local: Vec<Vec3> = points.iter().map(|&point| axes.local(point)).collect();
    let rim = monotone_chain(&local);
    let count = rim.len();
    let (low, high) = (axes.low[2], axes.high[2]);
    let at = |height: f64| -> Vec<Vec3> {
        rim.iter()
            .map(|&index| axes.global([local[index][0], local[index][1], height]))
            .collect()
    };
    let fan = (1..count - 1).map(|i| [0, i, i + 1]);
    if high - low <= 1e-12 * axes.extent()[0] {
        let vertices = rim.iter().map(|&index| points[index]).collect();
        let both = fan.flat_map(|[a, b, c]| [[a, b, c], [a, c, b]]).collect();
        return (vertices, both);
    }
    let vertices = [at(low), at(high)].concat();
    let mut triangles: Vec<[usize; 3]> = fan
        .flat_map(|[a, b, c]| [[a, c, b], [a + count, b + count, c + count]])
        .collect();
    for i in 0..count {
        let j = (i + 1) % count;
        triangles.extend([[i, j, j + count], [i, j + count, i + count]]);
    }
    (vertices, triangles)
}

/// Indices of the planar hull's corners, counter-clockwise in the first two coordinates.
///
/// References: Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979.
fn monotone_chain(local: &[Vec3]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..local.len()).collect();
    order.sort_by(|&a, &b| {
        local[a][0]
            .total_cmp(&local[b][0])
            .then(local[a][1].total_cmp(&local[b][1]))
    });
    let mut rim = half_chain(local, order.iter().copied());
    rim.pop();
    let mut back = half_chain(local, order.iter().rev().copied());
    back.pop();
    rim.extend(back);
    rim
}

fn half_chain(local: &[Vec3], order: impl Iterator<Item = usize>) -> Vec<usize> {
    let turn = |a: usize, b: usize, c: usize| {
        let (p, q, r) = (local[a], local[b], local[c]);
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let mut chain: Vec<usize> = Vec::new();
    for index in order {
        while let [.., a, b] = chain[..]
            && turn(a, b, index) <= 0.0
        {
            chain.pop();
        }
        chain.push(index);
    }
    chain
}
