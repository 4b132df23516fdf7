//! What can go wrong, one enum per public operation.

use thiserror::Error;

/// Why a plane could not be built.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PlaneError {
    /// A coordinate is NaN or infinite.
    #[error("{what} is not finite: {value:?}; drop broken poses before fitting a plane")]
    NonFinite {
        /// Which argument.
        what: &'static str,
        /// Its value.
        value: [f64; 3],
    },
    /// A direction has no length.
    #[error("{what} has zero length; pass a direction")]
    ZeroVector {
        /// Which argument.
        what: &'static str,
    },
    /// Fewer than three positions.
    #[error("{count} positions do not span a plane; three or more are needed")]
    TooFewPoints {
        /// Positions given.
        count: usize,
    },
    /// The positions lie on a line or at one place.
    #[error(
        "the positions lie on a line: spreads {spread:?}, second/first below {min_ratio}; fly a wider triangle"
    )]
    Degenerate {
        /// Root-mean-square spreads, descending, map units.
        spread: [f64; 3],
        /// Smallest accepted ratio of the second to the first.
        min_ratio: f64,
    },
    /// `up` lies in the fitted plane, so that its side cannot be told.
    #[error(
        "up lies in the fitted plane (cosine with its normal {cosine:.3}); the flight was vertical or up is wrong"
    )]
    UpInPlane {
        /// Cosine between up and the normal.
        cosine: f64,
    },
    /// `AᵀA` differs from the identity.
    #[error(
        "the basis is not orthonormal: AᵀA differs from the identity by {error:.3e} (tolerance {tolerance:.0e})"
    )]
    NotOrthonormal {
        /// Largest absolute difference.
        error: f64,
        /// Largest accepted difference.
        tolerance: f64,
    },
}

/// Why no exits could be looked for.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ExitError {
    /// A config field is out of its range.
    #[error("config field {field} = {value} is outside {range}")]
    Config {
        /// Name of the field.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// The agent's position is NaN or infinite.
    #[error("the agent's position is not finite: {position:?}")]
    Agent {
        /// The position given.
        position: [f64; 3],
    },
    /// Too few usable points: an empty map has no walls, so everything would look like an exit.
    #[error(
        "{usable} of {given} points are usable ({non_finite} not finite, {at_agent} at the agent, \
         {outside_band} outside the height band), {needed} are needed; scan longer or widen the band"
    )]
    InsufficientMap {
        /// Points given.
        given: usize,
        /// Points in the profile.
        usable: usize,
        /// Points with a NaN or infinite coordinate.
        non_finite: usize,
        /// Points whose bearing from the agent is undefined.
        at_agent: usize,
        /// Points outside the height band.
        outside_band: usize,
        /// Smallest accepted number ([`crate::ExitConfig::min_points`]).
        needed: usize,
    },
}
