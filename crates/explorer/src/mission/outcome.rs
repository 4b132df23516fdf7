//! How a mission ends.

use core::fmt;

/// Why the mission is over. The drone is on the ground in every case but [`Outcome::LandingUnconfirmed`].
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// No exit is left: everything that can be reached was explored.
    Explored,
    /// The battery reached its floor.
    BatteryLow {
        /// Charge when the landing began, percent.
        percent: u8,
    },
    /// The pose was lost and did not come back.
    TrackingLost,
    /// SLAM never initialised, in spite of translation in several directions.
    NeverInitialized,
    /// The time budget ran out.
    OutOfTime,
    /// The number of scans reached its limit.
    OutOfScans,
    /// The drone would not take off.
    TakeOffRefused {
        /// The drone's own words.
        answer: String,
    },
    /// Somebody asked to stop.
    Stopped,
    /// The drone stopped answering or refused command after command.
    DroneFailed {
        /// The last answer, or that there was none.
        answer: String,
    },
    /// The drone did not confirm the landing; look after it.
    LandingUnconfirmed,
}

impl Outcome {
    /// One word for tables and JSON.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Explored => "explored",
            Self::BatteryLow { .. } => "battery-low",
            Self::TrackingLost => "tracking-lost",
            Self::NeverInitialized => "never-initialized",
            Self::OutOfTime => "out-of-time",
            Self::OutOfScans => "out-of-scans",
            Self::TakeOffRefused { .. } => "take-off-refused",
            Self::Stopped => "stopped",
            Self::DroneFailed { .. } => "drone-failed",
            Self::LandingUnconfirmed => "landing-unconfirmed",
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Explored => f.write_str("explored: no exit is left"),
            Self::BatteryLow { percent } => write!(f, "stopped at {percent} % battery"),
            Self::TrackingLost => f.write_str("landed because the pose was lost for good"),
            Self::NeverInitialized => {
                f.write_str("landed because SLAM never initialised; give it more texture and light")
            }
            Self::OutOfTime => f.write_str("landed because the time budget ran out"),
            Self::OutOfScans => f.write_str("landed because the scan budget ran out"),
            Self::TakeOffRefused { answer } => write!(f, "the drone refused to take off: {answer}"),
            Self::Stopped => f.write_str("landed on request"),
            Self::DroneFailed { answer } => write!(f, "landed because the drone failed: {answer}"),
            Self::LandingUnconfirmed => {
                f.write_str("the landing was not confirmed; look after the drone")
            }
        }
    }
}
