//! What a search returns: ranked exits, unseen sectors, and what was turned down and why.

use crate::profile::RangeProfile;
use crate::rule::ScoreParts;
use crate::sector::Sector;

/// One way out.
#[derive(Debug, Clone, PartialEq)]
pub struct Exit {
    /// From the agent to the exit, unit vector, world, in the plane.
    pub direction: [f64; 3],
    /// The same as a bearing in the plane, radians in `[0, 2π)`.
    pub bearing_rad: f64,
    /// Where to fly: behind the jambs, at the agent's height, world.
    pub position: [f64; 3],
    /// The angular sector of the opening.
    pub sector: Sector,
    /// Angular width, radians.
    pub width_rad: f64,
    /// Distance between the jambs, map units.
    pub width: f64,
    /// The two ends of the opening at the agent's height, world; the first at the sector's start.
    pub jambs: [[f64; 3]; 2],
    /// From the agent to `position`, map units.
    pub range: f64,
    /// What gave it away.
    pub kind: ExitKind,
    /// Rank in `[0, 1]`, higher is better. Range-aware rule: [`ScoreParts::probability`], of gaps a third of it.
    /// Algorithm 2: the share of the circle.
    pub score: f64,
    /// Where the score comes from.
    pub parts: ScoreParts,
}

/// What gave an exit away.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExitKind {
    /// Nothing was seen in the sector although its surroundings are full of points.
    Empty,
    /// What was seen lies well behind the continued wall.
    RangeJump,
}

/// A sector that looked like an exit and was turned down.
#[derive(Debug, Clone, PartialEq)]
pub struct Rejected {
    /// The sector.
    pub sector: Sector,
    /// Why.
    pub reason: Rejection,
}

/// Why a candidate is not an exit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Rejection {
    /// Distance between the jambs below `min_width`.
    TooNarrow {
        /// Distance between the jambs, map units.
        width: f64,
        /// What was needed.
        needed: f64,
    },
    /// Empty, but elsewhere walls are so thin or patchy that a wall could look the same.
    Unsupported {
        /// Points in the poorest tenth of such runs elsewhere.
        expected: f64,
        /// What was needed.
        needed: f64,
    },
}

/// What a search found.
#[derive(Debug, Clone, PartialEq)]
pub struct ExitReport {
    /// Exits, best first. Empty: the place is enclosed as far as it was seen.
    pub exits: Vec<Exit>,
    /// Sectors the camera never looked into, ascending by start.
    pub unseen: Vec<Sector>,
    /// Candidates that were turned down, ascending by start.
    pub rejected: Vec<Rejected>,
    /// The profile the decision was taken on.
    pub profile: RangeProfile,
}

impl ExitReport {
    /// The best exit, if there is one.
    pub fn best(&self) -> Option<&Exit> {
        self.exits.first()
    }
}
