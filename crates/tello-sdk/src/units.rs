//! Checked quantities of the drone's commands: a value that exists is a value that the drone accepts.
//!
//! Every constructor refuses what is out of range with the number and the bounds; nothing is clamped. Ranges are
//! those of the vendor's SDK guides 1.3, 2.0 and 3.0 (the narrowest where they differ).

use core::fmt;

/// A value lies outside the range that the drone accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UnitError {
    /// The value is outside `min..=max`.
    #[error("{quantity} of {value} {unit} is out of range: give {min} to {max} {unit}")]
    OutOfRange {
        /// What the value is, for example "distance".
        quantity: &'static str,
        /// The unit of the three numbers.
        unit: &'static str,
        /// The value that was given.
        value: i64,
        /// Smallest accepted value.
        min: i64,
        /// Largest accepted value.
        max: i64,
    },
    /// The value in metres is not a finite number.
    #[error("{quantity} is not a finite number")]
    NotFinite {
        /// What the value is.
        quantity: &'static str,
    },
}

macro_rules! bounded {
    ($(#[$doc:meta])* $name:ident, $repr:ty, $quantity:literal, $unit:literal, $range:expr, $new:ident, $get:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name($repr);

        impl $name {
            /// Smallest value.
            pub const MIN: Self = Self(*$range.start());
            /// Largest value.
            pub const MAX: Self = Self(*$range.end());

            #[doc = concat!("Checks a ", $quantity, " in ", $unit, ".")]
            ///
            /// # Errors
            /// [`UnitError::OutOfRange`] with the value and the bounds.
            pub fn $new(value: i64) -> Result<Self, UnitError> {
                match <$repr>::try_from(value) {
                    Ok(small) if $range.contains(&small) => Ok(Self(small)),
                    _ => Err(UnitError::OutOfRange {
                        quantity: $quantity,
                        unit: $unit,
                        value,
                        min: i64::from(*$range.start()),
                        max: i64::from(*$range.end()),
                    }),
                }
            }

            #[doc = concat!("The ", $quantity, " in ", $unit, ".")]
            #[must_use]
            pub const fn $get(self) -> $repr {
                self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

bounded!(
    /// Length of a straight move, 20 to 500 cm.
    ///
    /// ```
    /// use tello_sdk::Distance;
    /// assert_eq!(Distance::from_cm(50)?.meters(), 0.5);
    /// assert!(Distance::from_cm(19).is_err());
    /// # Ok::<(), tello_sdk::UnitError>(())
    /// ```
    Distance, u16, "distance", "cm", (20..=500u16), from_cm, cm
);
bounded!(
    /// Angle of a turn on the spot, 1 to 360 degrees (SDK 1.3 alone would take 3600).
    Turn, u16, "turn", "deg", (1..=360u16), from_degrees, degrees
);
bounded!(
    /// Speed of straight moves, 10 to 100 cm/s.
    Speed, u8, "speed", "cm/s", (10..=100u8), from_cm_per_s, cm_per_s
);
bounded!(
    /// Speed along an arc, 10 to 60 cm/s.
    ArcSpeed, u8, "arc speed", "cm/s", (10..=60u8), from_cm_per_s, cm_per_s
);
bounded!(
    /// Deflection of one stick, -100 to 100 percent.
    Stick, i8, "stick", "percent", (-100..=100i8), from_percent, percent
);
bounded!(
    /// One coordinate of a waypoint, -500 to 500 cm.
    Coordinate, i16, "coordinate", "cm", (-500..=500i16), from_cm, cm
);
bounded!(
    /// Charge of the battery, 0 to 100 percent.
    Battery, u8, "battery", "percent", (0..=100u8), from_percent, percent
);
bounded!(
    /// A UDP port that the drone may be told to send to, 1025 to 65535.
    Port, u16, "port", "(UDP)", (1025..=65535u16), from_number, number
);
bounded!(
    /// Bit rate of the video, 1 to 5 Mbit/s (automatic is a variant of the command).
    BitRate, u8, "bit rate", "Mbit/s", (1..=5u8), from_mbit_per_s, mbit_per_s
);
bounded!(
    /// Number printed on a mission pad, 1 to 8.
    PadNumber, u8, "mission pad", "(number)", (1..=8u8), from_number, number
);

impl Distance {
    /// Checks a length in metres, rounded to the nearest centimetre.
    ///
    /// # Errors
    /// [`UnitError::NotFinite`], or [`UnitError::OutOfRange`] after rounding.
    pub fn from_meters(meters: f64) -> Result<Self, UnitError> {
        Self::from_cm(rounded("distance", meters * 100.0)?)
    }

    /// The length in metres.
    #[must_use]
    pub fn meters(self) -> f64 {
        f64::from(self.0) / 100.0
    }
}

impl Turn {
    /// The angle in radians.
    #[must_use]
    pub fn radians(self) -> f64 {
        f64::from(self.0) * core::f64::consts::PI / 180.0
    }
}

impl Speed {
    /// The speed in metres per second.
    #[must_use]
    pub fn meters_per_s(self) -> f64 {
        f64::from(self.0) / 100.0
    }
}

impl Coordinate {
    /// The coordinate in metres.
    #[must_use]
    pub fn meters(self) -> f64 {
        f64::from(self.0) / 100.0
    }
}

impl Stick {
    /// The stick at rest.
    pub const CENTER: Self = Self(0);
}

/// Rounds half away from zero without the standard library.
fn rounded(quantity: &'static str, value: f64) -> Result<i64, UnitError> {
    if !value.is_finite() {
        return Err(UnitError::NotFinite { quantity });
    }
    // `as` saturates, so a huge value stays huge and fails the range check.
    Ok((value + if value < 0.0 { -0.5 } else { 0.5 }) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_accepted_and_their_neighbours_refused() {
        assert_eq!(Distance::from_cm(20), Ok(Distance::MIN));
        assert_eq!(Distance::from_cm(500), Ok(Distance::MAX));
        for bad in [i64::MIN, -20, 0, 19, 501, 65_536 + 20, i64::MAX] {
            let error = Distance::from_cm(bad).unwrap_err();
            assert!(
                matches!(error, UnitError::OutOfRange { value, min: 20, max: 500, .. } if value == bad)
            );
        }
        assert!(Turn::from_degrees(0).is_err() && Turn::from_degrees(361).is_err());
        assert!(Speed::from_cm_per_s(9).is_err() && Speed::from_cm_per_s(101).is_err());
        assert!(Stick::from_percent(-101).is_err() && Stick::from_percent(-100).is_ok());
        assert!(Port::from_number(1024).is_err() && Port::from_number(65_535).is_ok());
    }

    #[test]
    fn meters_round_to_the_nearest_centimetre() {
        assert_eq!(Distance::from_meters(0.505).map(Distance::cm), Ok(51));
        assert_eq!(Distance::from_meters(4.999).map(Distance::cm), Ok(500));
        assert!(Distance::from_meters(0.194).is_err());
        assert_eq!(
            Distance::from_meters(f64::NAN),
            Err(UnitError::NotFinite {
                quantity: "distance"
            })
        );
        assert!(Distance::from_meters(f64::MAX).is_err());
        assert!(Distance::from_meters(f64::NEG_INFINITY).is_err());
    }

    #[test]
    fn the_error_says_what_to_do() {
        let text = std::format!("{}", Distance::from_cm(7).unwrap_err());
        assert_eq!(text, "distance of 7 cm is out of range: give 20 to 500 cm");
    }
}
