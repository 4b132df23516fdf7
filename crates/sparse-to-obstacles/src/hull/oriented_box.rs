//! The box along the principal axes that contains all points: the hull of lines, and the fallback.

use super::axes::Axes;
use super::build::Mesh;
use crate::vector::Vec3;

/// Corner i of a box is high along axis k where bit k of i is set.
pub(super) const FACES: [[usize; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

/// A box that contains the points, or the two ends where they lie on a line to rounding.
pub(super) fn around(points: &[Vec3], axes: &Axes) -> Mesh {
    let extent = axes.extent();
    let rounding = 1e-12 * extent[0];
    if extent[1] <= rounding && extent[2] <= rounding {
        return (ends(points, axes), Vec::new());
    }
    let corners = (0..8).map(|corner| {
        let along = |axis: usize| {
            if corner >> axis & 1 == 1 {
                axes.high[axis]
            } else {
                axes.low[axis]
            }
        };
        axes.global([along(0), along(1), along(2)])
    });
    (corners.collect(), FACES.to_vec())
}

fn ends(points: &[Vec3], axes: &Axes) -> Vec<Vec3> {
    let along = |point: &Vec3| axes.local(*point)[0];
    let first = points.iter().min_by(|a, b| along(a).total_cmp(&along(b)));
    let last = points.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
    first.into_iter().chain(last).copied().collect()
}
