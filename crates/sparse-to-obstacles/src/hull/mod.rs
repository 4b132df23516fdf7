//! Convex hulls of every rank: point, segment, flat polygon, polytope.

mod axes;
mod build;
mod gjk;
mod oriented_box;
mod polygon;
mod polytope;

pub(crate) use axes::longest_axis;
pub(crate) use build::build;
pub(crate) use gjk::separation;

/// A convex obstacle: the hull of some input points, before it is inflated by a query's radius.
///
/// Contains every one of its points (to a billionth of its extent). Thin hulls, whose extent along an
/// axis is at most a thousandth of their length, are widened to contain their points: a segment with
/// such a thickness is a box around its line, a polygon a prism around its plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// The rank of the points.
    pub kind: HullKind,
    /// Corners, map units. All of them lie on the hull.
    pub vertices: Vec<[f64; 3]>,
    /// Faces as indices of `vertices`, counter-clockwise seen from outside. Flat polygons have both
    /// sides, points and exact segments none.
    pub triangles: Vec<[usize; 3]>,
    /// The input points inside, as ascending indices into the caller's slice.
    pub point_indices: Vec<usize>,
}

/// The rank of a hull's points: how many directions they extend in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum HullKind {
    /// All points coincide.
    Point,
    /// All points lie on a line, to a thousandth of their extent.
    Segment,
    /// All points lie in a plane, to a thousandth of their extent.
    Polygon,
    /// The points span a volume.
    Polytope,
}

impl HullKind {
    /// Does the hull lack a volume of its own?
    #[must_use]
    pub fn is_degenerate(self) -> bool {
        self != HullKind::Polytope
    }
}

#[cfg(test)]
mod tests;
