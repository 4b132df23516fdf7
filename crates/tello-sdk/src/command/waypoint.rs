//! A point to fly to, in centimetres: checked against the drone's dead zone.

use crate::units::{Coordinate, UnitError};
use core::fmt;

/// Why a waypoint is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WaypointError {
    /// A coordinate is outside -500..=500 cm.
    #[error(transparent)]
    Coordinate(#[from] UnitError),
    /// All three coordinates are within 20 cm of zero: the drone would refuse.
    #[error(
        "waypoint ({x}, {y}, {z}) cm is too near: at least one coordinate must be 20 cm or more from zero"
    )]
    TooNear {
        /// Forward, cm.
        x: i16,
        /// Left, cm.
        y: i16,
        /// Up, cm.
        z: i16,
    },
}

/// A point relative to the drone (x forward, y left, z up; the sign of y was not verified on hardware) or to a pad.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Waypoint {
    x: Coordinate,
    y: Coordinate,
    z: Coordinate,
}

impl Waypoint {
    /// Checks a point given in centimetres.
    ///
    /// # Errors
    /// A coordinate beyond 500 cm, or all three closer than 20 cm to zero.
    pub fn from_cm(x: i64, y: i64, z: i64) -> Result<Self, WaypointError> {
        let point = Self::free(x, y, z)?;
        if point.cm().iter().all(|c| c.abs() < 20) {
            let [x, y, z] = point.cm();
            return Err(WaypointError::TooNear { x, y, z });
        }
        Ok(point)
    }

    /// A point of an arc or in a pad's frame: only the single ranges are checked.
    pub(super) fn free(x: i64, y: i64, z: i64) -> Result<Self, UnitError> {
        Ok(Self {
            x: Coordinate::from_cm(x)?,
            y: Coordinate::from_cm(y)?,
            z: Coordinate::from_cm(z)?,
        })
    }

    /// The coordinates in centimetres.
    #[must_use]
    pub fn cm(self) -> [i16; 3] {
        [self.x.cm(), self.y.cm(), self.z.cm()]
    }

    /// The coordinates in metres.
    #[must_use]
    pub fn meters(self) -> [f64; 3] {
        [self.x.meters(), self.y.meters(), self.z.meters()]
    }
}

impl fmt::Display for Waypoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.x, self.y, self.z)
    }
}
