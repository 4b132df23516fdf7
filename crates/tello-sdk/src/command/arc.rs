//! An arc through two points: its circle's radius must be one that the drone flies.

use super::waypoint::Waypoint;
use crate::units::UnitError;
use core::fmt;

/// Why an arc is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ArcError {
    /// A coordinate is outside -500..=500 cm.
    #[error(transparent)]
    Coordinate(#[from] UnitError),
    /// The start and the two points lie on one line (or coincide), so no circle passes through them.
    #[error(
        "the start and the two points lie on one line: move the middle point aside, or use `go`"
    )]
    Straight,
    /// The circle is smaller than 50 cm or larger than 1000 cm in radius.
    #[error("the arc's radius of about {radius_cm} cm is out of range: it must be 50 to 1000 cm")]
    Radius {
        /// Radius of the circle, rounded down, cm.
        radius_cm: u64,
    },
}

/// The arc from the drone's place through a first point to a second one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Arc {
    via: Waypoint,
    to: Waypoint,
}

impl Arc {
    /// Checks an arc given by two points in centimetres (same axes as [`Waypoint`]).
    ///
    /// # Errors
    /// A coordinate beyond 500 cm, three points on a line, or a radius outside 0.5 to 10 m.
    pub fn from_cm(via: [i64; 3], to: [i64; 3]) -> Result<Self, ArcError> {
        let arc = Self {
            via: Waypoint::free(via[0], via[1], via[2])?,
            to: Waypoint::free(to[0], to[1], to[2])?,
        };
        let (numerator, denominator) = arc.squared_radius();
        if denominator == 0 {
            return Err(ArcError::Straight);
        }
        if numerator < denominator * 50 * 50 || numerator > denominator * 1000 * 1000 {
            return Err(ArcError::Radius {
                radius_cm: (numerator / denominator).isqrt(),
            });
        }
        Ok(arc)
    }

    /// Circumradius² = a² b² c² / (4 |u × v|²), exact in integers as a fraction.
    fn squared_radius(self) -> (u64, u64) {
        let u = self.via.cm().map(i64::from);
        let v = self.to.cm().map(i64::from);
        let w = [v[0] - u[0], v[1] - u[1], v[2] - u[2]];
        let cross = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let square = |a: [i64; 3]| a.iter().map(|c| c.unsigned_abs().pow(2)).sum::<u64>();
        // At most 7.5e5 * 7.5e5 * 3e6 = 1.7e18, below u64::MAX.
        (square(u) * square(v) * square(w), 4 * square(cross))
    }

    /// The point on the way.
    #[must_use]
    pub fn via(self) -> Waypoint {
        self.via
    }

    /// The end.
    #[must_use]
    pub fn to(self) -> Waypoint {
        self.to
    }
}

impl fmt::Display for Arc {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.via, self.to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_circle_of_one_metre_is_accepted() {
        let arc = Arc::from_cm([100, 100, 0], [200, 0, 0]).unwrap();
        assert_eq!(arc.squared_radius().0 / arc.squared_radius().1, 10_000);
    }

    #[test]
    fn lines_points_and_wrong_radii_are_refused() {
        assert_eq!(
            Arc::from_cm([100, 0, 0], [200, 0, 0]),
            Err(ArcError::Straight)
        );
        assert_eq!(Arc::from_cm([0, 0, 0], [0, 0, 0]), Err(ArcError::Straight));
        assert_eq!(
            Arc::from_cm([20, 20, 0], [40, 0, 0]),
            Err(ArcError::Radius { radius_cm: 20 })
        );
        assert!(matches!(
            Arc::from_cm([250, 1, 0], [500, 0, 0]),
            Err(ArcError::Radius { radius_cm: 31_250 })
        ));
        // The largest numbers do not overflow.
        assert!(Arc::from_cm([-500, -500, -500], [500, 500, -500]).is_ok());
        assert!(matches!(
            Arc::from_cm([501, 0, 0], [0, 1, 0]),
            Err(ArcError::Coordinate(_))
        ));
    }
}
