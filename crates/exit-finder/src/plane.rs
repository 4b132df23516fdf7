//! The plane of flight: an origin `v`, an orthonormal basis `A` (3 × 2) and a normal.
//!
//! ```text
//! project: p -> Aᵀ (p - v)        lift: q -> A q + v        height: p -> n · (p - v)
//! ```
//!
//! Frames: everything is in the frame and the unit of the map. The basis is right-handed about the
//! normal, so bearings grow counter-clockwise when seen from the tip of `up`. For a SLAM map in the
//! camera convention (y down) pass `up = [0, -1, 0]`; nothing guesses it.

use crate::error::PlaneError;
use crate::vector::{add, cross, dot, is_finite, norm, scale, sub, unit};

/// Largest error of AᵀA against the identity that [`AffinePlane::from_basis`] accepts.
pub const BASIS_TOLERANCE: f64 = 1e-6;

/// Smallest ratio of the second to the first singular value of points that still span a plane.
pub const MIN_SPREAD_RATIO: f64 = 0.05;

/// An affine plane with coordinates: origin, two unit axes and the unit normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AffinePlane {
    origin: [f64; 3],
    axes: [[f64; 3]; 2],
    normal: [f64; 3],
}

impl AffinePlane {
    /// The plane through `through` whose normal is `up`.
    ///
    /// The first axis is the map's x axis laid into the plane (its z axis when x is nearly
    /// parallel to `up`), so with `up = [0, 0, 1]` the coordinates are `(x, y)` and with
    /// `up = [0, -1, 0]` (camera convention) they are `(x, z)`.
    ///
    /// # Errors
    /// [`PlaneError::NonFinite`] or [`PlaneError::ZeroVector`].
    pub fn from_up(up: [f64; 3], through: [f64; 3]) -> Result<Self, PlaneError> {
        let normal = direction(up, "up")?;
        finite(through, "through")?;
        let seed = if normal[0].abs() < 0.9 {
            [1.0, 0.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
        Self::from_normal_and_axis(through, normal, seed)
    }

    /// The plane through three positions, as the paper's flown triangle gives it: origin `a`,
    /// first axis from `a` to `b`, normal on the side of `up`.
    ///
    /// # Errors
    /// [`PlaneError::Degenerate`] when the triangle is (nearly) a line: σ₂/σ₁ < 0.05 of its centred
    /// corners; [`PlaneError::UpInPlane`] when `up` does not tell the two sides apart.
    pub fn from_three_points(
        a: [f64; 3],
        b: [f64; 3],
        c: [f64; 3],
        up: [f64; 3],
    ) -> Result<Self, PlaneError> {
        let fit = Self::from_points(&[a, b, c], up)?;
        let along = sub(b, a);
        let axis = if norm(along) > 0.0 { along } else { sub(c, a) };
        Self::from_normal_and_axis(a, fit.plane.normal, axis)
    }

    /// A plane from an explicit basis; the normal is `first × second`.
    ///
    /// # Errors
    /// [`PlaneError::NotOrthonormal`] when an entry of `AᵀA − I` exceeds 1e-6.
    pub fn from_basis(origin: [f64; 3], axes: [[f64; 3]; 2]) -> Result<Self, PlaneError> {
        finite(origin, "origin")?;
        finite(axes[0], "first axis")?;
        finite(axes[1], "second axis")?;
        let errors = [
            dot(axes[0], axes[0]) - 1.0,
            dot(axes[1], axes[1]) - 1.0,
            dot(axes[0], axes[1]),
        ];
        let error = errors.iter().fold(0.0, |worst: f64, e| worst.max(e.abs()));
        if error > BASIS_TOLERANCE {
            return Err(PlaneError::NotOrthonormal {
                error,
                tolerance: BASIS_TOLERANCE,
            });
        }
        Ok(Self {
            origin,
            axes,
            normal: cross(axes[0], axes[1]),
        })
    }

    /// Plane coordinates of `p`: `Aᵀ (p − v)`.
    #[inline]
    pub fn project(&self, p: [f64; 3]) -> [f64; 2] {
        let d = sub(p, self.origin);
        [dot(self.axes[0], d), dot(self.axes[1], d)]
    }

    /// The point of the plane with coordinates `q`: `A q + v`.
    pub fn lift(&self, q: [f64; 2]) -> [f64; 3] {
        add(self.origin, self.direction(q))
    }

    /// The vector `A q`, without the origin.
    pub fn direction(&self, q: [f64; 2]) -> [f64; 3] {
        add(scale(self.axes[0], q[0]), scale(self.axes[1], q[1]))
    }

    /// Signed distance of `p` from the plane along the normal.
    #[inline]
    pub fn height(&self, p: [f64; 3]) -> f64 {
        dot(self.normal, sub(p, self.origin))
    }

    /// Bearing of a direction in the plane, in `[0, 2π)`; `None` when it has no part in the plane.
    pub fn bearing(&self, direction: [f64; 3]) -> Option<f64> {
        let q = [dot(self.axes[0], direction), dot(self.axes[1], direction)];
        let seen = q[0].hypot(q[1]);
        (seen.is_finite() && seen > 1e-12 * norm(direction))
            .then(|| crate::angle::wrap(q[1].atan2(q[0])))
    }

    /// The origin `v`.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// The two unit axes, the columns of `A`.
    pub fn axes(&self) -> [[f64; 3]; 2] {
        self.axes
    }

    /// The unit normal.
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// Plane with the given unit normal and its first axis as near to `axis` as possible.
    pub(crate) fn from_normal_and_axis(
        origin: [f64; 3],
        normal: [f64; 3],
        axis: [f64; 3],
    ) -> Result<Self, PlaneError> {
        let laid = sub(axis, scale(normal, dot(normal, axis)));
        let first = unit(laid).ok_or(PlaneError::ZeroVector { what: "first axis" })?;
        Ok(Self {
            origin,
            axes: [first, cross(normal, first)],
            normal,
        })
    }
}

pub(crate) fn finite(v: [f64; 3], what: &'static str) -> Result<(), PlaneError> {
    if is_finite(v) {
        Ok(())
    } else {
        Err(PlaneError::NonFinite { what, value: v })
    }
}

pub(crate) fn direction(v: [f64; 3], what: &'static str) -> Result<[f64; 3], PlaneError> {
    finite(v, what)?;
    unit(v).ok_or(PlaneError::ZeroVector { what })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn camera_convention_gives_x_and_z() {
        let plane = AffinePlane::from_up([0.0, -1.0, 0.0], [0.0; 3]).unwrap();
        assert_eq!(plane.project([2.0, 5.0, 3.0]), [2.0, 3.0]);
        assert_eq!(plane.height([2.0, 5.0, 3.0]), -5.0);
    }

    #[test]
    fn bearings_turn_left_seen_from_the_tip_of_up_in_either_convention() {
        // Looking ahead, left is a quarter turn on: ahead is y and left is −x with z up, ahead is z and left is −x with y down.
        for (up, ahead) in [
            ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
            ([0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
        ] {
            let plane = AffinePlane::from_up(up, [0.0; 3]).unwrap();
            let [before, after] = [ahead, cross(up, ahead)].map(|d| plane.bearing(d).unwrap());
            assert!(
                (crate::angle::turn(before, after) - std::f64::consts::FRAC_PI_2).abs() < 1e-12
            );
            assert_eq!(cross(up, ahead), [-1.0, 0.0, 0.0]);
            assert_eq!(plane.bearing(up), None);
        }
    }

    #[test]
    fn the_other_up_mirrors_bearings_and_heights() {
        let [plane, mirrored] =
            [1.0, -1.0].map(|sign| AffinePlane::from_up([0.0, -sign, 0.0], [0.0; 3]).unwrap());
        let p = [2.0, 5.0, 3.0];
        assert_eq!(plane.height(p), -mirrored.height(p));
        let [a, b] = [plane, mirrored].map(|plane| plane.bearing(p).unwrap());
        assert!(crate::angle::turn(a, -b).abs() < 1e-12, "{a} {b}");
    }

    #[test]
    fn lifting_undoes_projecting() {
        let plane = AffinePlane::from_up([0.3, -0.8, 0.2], [1.0, 2.0, 3.0]).unwrap();
        let q = plane.project(plane.lift([0.7, -1.9]));
        assert!((q[0] - 0.7).abs() < 1e-12 && (q[1] + 1.9).abs() < 1e-12);
        let p = [0.4, -3.0, 8.0];
        let rebuilt = add(
            plane.lift(plane.project(p)),
            scale(plane.normal(), plane.height(p)),
        );
        assert!(norm(sub(rebuilt, p)) < 1e-12);
    }

    #[test]
    fn a_skewed_basis_is_refused() {
        let error = AffinePlane::from_basis([0.0; 3], [[1.0, 0.0, 0.0], [0.1, 1.0, 0.0]]);
        assert!(matches!(error, Err(PlaneError::NotOrthonormal { .. })));
        assert!(AffinePlane::from_basis([0.0; 3], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]).is_ok());
    }

    #[test]
    fn a_collinear_triangle_is_refused() {
        let line = AffinePlane::from_three_points(
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [2.0, 0.01, 0.0],
            [0.0, 0.0, 1.0],
        );
        assert!(matches!(line, Err(PlaneError::Degenerate { .. })));
    }

    #[test]
    fn the_normal_looks_up() {
        let up = [0.0, -1.0, 0.0];
        let plane =
            AffinePlane::from_three_points([0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], up).unwrap();
        assert!(dot(plane.normal(), up) > 0.999);
    }
}
