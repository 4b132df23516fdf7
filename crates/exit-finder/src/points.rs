//! What counts as a point: anything cheap to copy that converts to three coordinates.

/// A point in space: `[f64; 3]`, a nalgebra or glam vector, or a type of your own with
/// `impl From<YourPoint> for [f64; 3]`.
///
/// The alias is a blanket implementation; nobody implements it by hand.
pub trait PointLike: Copy + Into<[f64; 3]> {}

impl<P: Copy + Into<[f64; 3]>> PointLike for P {}
