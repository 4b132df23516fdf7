//! What a mission tells while it runs, for progress lines and reports.

use core::fmt;
use core::time::Duration;

use super::outcome::Outcome;

/// One line of the mission's story.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// The drone is in the air.
    TookOff,
    /// SLAM has a map.
    Initialized,
    /// A turn on the spot begins.
    ScanStarted {
        /// Which scan of the mission, from 1.
        number: usize,
    },
    /// The map was cleaned, exits were looked for.
    Perceived {
        /// Points of the map.
        points: usize,
        /// Points that were kept.
        kept: usize,
        /// Exits found from here.
        exits: usize,
    },
    /// A new place to fly to was chosen.
    Heading {
        /// Metres along the planned path.
        meters: f64,
        /// What for.
        goal: Goal,
    },
    /// The pose was lost in flight.
    Lost,
    /// The pose came back.
    Recovered,
    /// Landing begins.
    Landing {
        /// Why.
        outcome: Outcome,
    },
}

/// What a flight is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Goal {
    /// Through an exit.
    Through,
    /// Nearer to an exit, as far as space is proven free.
    Approach,
    /// Back to a place from which an exit was left unvisited.
    Return,
    /// To a reachable place that no scan has seen.
    Unseen,
    /// To a place from which edges of what is proven free can be looked beyond.
    Edge,
    /// Back to where the drone took off.
    Home,
}

/// An event and when it happened.
#[derive(Debug, Clone, PartialEq)]
pub struct Logged {
    /// On the caller's clock.
    pub time: Duration,
    /// What happened.
    pub event: Event,
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TookOff => f.write_str("took off"),
            Self::Initialized => f.write_str("SLAM is initialised"),
            Self::ScanStarted { number } => write!(f, "scan {number}"),
            Self::Perceived {
                points,
                kept,
                exits,
            } => {
                write!(f, "{points} points, {kept} kept, {exits} exits")
            }
            Self::Heading { meters, goal } => {
                let what = match goal {
                    Goal::Through => "through an exit",
                    Goal::Approach => "nearer to an exit",
                    Goal::Return => "back to an unvisited exit",
                    Goal::Home => "home",
                    Goal::Edge => "to look beyond the edges",
                    Goal::Unseen => "to a place that no scan has seen",
                };
                write!(f, "flying {meters:.1} m {what}")
            }
            Self::Lost => f.write_str("tracking lost"),
            Self::Recovered => f.write_str("tracking is back"),
            Self::Landing { outcome } => write!(f, "landing: {outcome}"),
        }
    }
}
