//! An exit that is remembered.

use super::anchor::Anchor;
use super::site::SiteId;
use crate::vector::{add, scale};

/// Number of a portal, counted from 0 in the order of discovery.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PortalId(pub usize);

/// What became of a portal. Only `Unvisited` portals are ever proposed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortalState {
    /// Nobody went through.
    Unvisited,
    /// The agent flew through; it connects two sites.
    Traversed,
    /// There is no way through.
    Blocked,
    /// What lies behind was explored from elsewhere.
    Exhausted,
}

/// A way out of a site.
#[derive(Debug, Clone, PartialEq)]
pub struct Portal {
    /// Its number.
    pub id: PortalId,
    /// The site from which it was found.
    pub from: SiteId,
    /// The site behind it, once the agent scanned there.
    pub to: Option<SiteId>,
    /// The two ends of the opening, world.
    pub jambs: [[f64; 3]; 2],
    /// Where to fly: behind the jambs, world.
    pub exit: [f64; 3],
    /// Score of the exit when it was found.
    pub score: f64,
    /// What became of it.
    pub state: PortalState,
    pub(crate) anchors: [Anchor; 3],
}

impl Portal {
    /// The middle between the jambs, world.
    pub fn middle(&self) -> [f64; 3] {
        scale(add(self.jambs[0], self.jambs[1]), 0.5)
    }

    /// Whether virtual points close it.
    pub fn is_closed(&self) -> bool {
        matches!(self.state, PortalState::Traversed | PortalState::Blocked)
    }
}
