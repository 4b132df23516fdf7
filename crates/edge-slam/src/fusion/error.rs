//! Why the filter refuses an input.

/// What is wrong with an input of [`super::Ekf`]. The filter is unchanged after an error.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FusionError {
    /// A parameter is outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Parameter {
        /// Field.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// A sample holds NaN or infinity.
    #[error("{name} holds a number that is not finite")]
    NonFinite {
        /// Which sample.
        name: &'static str,
    },
    /// Time went backwards.
    #[error(
        "the sample of {time} s is older than the filter's {now} s; hand samples in their order"
    )]
    TimeBackwards {
        /// The sample's time, seconds.
        time: f64,
        /// The filter's time, seconds.
        now: f64,
    },
    /// Euler angles break down.
    #[error("a pitch of {pitch_degrees} degrees is too near to 90 for Euler angles")]
    GimbalLock {
        /// What was measured or estimated.
        pitch_degrees: f64,
    },
}
