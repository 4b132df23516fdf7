//! What a point is to this crate: anything cheap to copy that converts to `[f64; 3]`.

/// A point in three dimensions. Implemented for every type that qualifies: arrays, tuples, nalgebra's
/// and glam's vectors, and your own type with `impl From<MapPoint> for [f64; 3]`.
pub trait PointLike: Copy + Into<[f64; 3]> {}

impl<P: Copy + Into<[f64; 3]>> PointLike for P {}

/// Converts all points, or names the first one that has a coordinate that is not finite.
pub(crate) fn finite_points<P: PointLike>(points: &[P]) -> Result<Vec<[f64; 3]>, usize> {
    let converted: Vec<[f64; 3]> = points.iter().map(|&point| point.into()).collect();
    match converted.iter().position(|point| !is_finite(*point)) {
        Some(index) => Err(index),
        None => Ok(converted),
    }
}

pub(crate) fn is_finite(point: [f64; 3]) -> bool {
    point.iter().all(|coordinate| coordinate.is_finite())
}
