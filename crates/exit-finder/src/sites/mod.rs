//! Never explore a place twice: scan sites, the portals between them, and when to stop.
//!
//! A *site* is a place where the agent turned and looked; it owns the polygon it saw. A *portal* is an
//! exit found there, kept as its two jambs, with a state:
//!
//! ```text
//! Unvisited --traverse--> Traversed        Unvisited --block--> Blocked
//! Unvisited --what lies behind is explored--> Exhausted
//! ```
//!
//! No transition leads back to Unvisited.
//!
//! 1. [`SiteGraph::add_site`] turns the exits of a report into portals, but not those that lead into the
//!    polygon of an earlier site, and not those that are an earlier portal seen again.
//! 2. [`SiteGraph::traverse`] marks a portal before the agent flies through it, [`SiteGraph::block`]
//!    when no path exists.
//! 3. [`SiteGraph::virtual_points`] closes used portals for the next search
//!    ([`crate::ExitView::virtual_points`]): the agent does not find the door it came through.
//! 4. [`SiteGraph::next_portal`] is the nearest unvisited portal along known connections, or `None`:
//!    explored.
//!
//! # It terminates
//! Call a *step* what the agent does between two decisions: ask for the next portal, then traverse or
//! block it, then scan at most once. Let `u` be the number of unvisited portals. A step lowers `u` by
//! one, since the portal it asked for leaves the state for good. A scan raises `u` by the number of exits
//! accepted there. An exit is accepted only if its exit point lies outside the shrunk polygons of all
//! earlier sites and is not within the merge distance of an earlier portal's middle. Middles of
//! portals are therefore pairwise farther apart than the merge distance `m`, and a bounded map of area
//! `S` holds at most `P ≤ 4 (√S/m + 1)²` of them (discs of radius `m/2` around them are disjoint). Each
//! portal is asked for at most once, so there are at most `P` steps and at most `P + 1` scans, whatever
//! the searches report; a caller that limits the range of exits thus always ends in `None`. Two rooms
//! cannot be visited in turn for ever: the door between them is one portal, which is taken once.
//!
//! # Map corrections
//! Sites and portals are anchored to keyframes. After a correction pass the new keyframe poses to
//! [`SiteGraph::reanchor`]; everything moves with its keyframe. A new epoch (the map was reset) voids all
//! coordinates: [`SiteGraph::reset`].

mod anchor;
mod correction;
mod error;
mod graph;
mod portal;
mod route;
mod site;

pub use anchor::{Anchor, KeyframePose};
pub use error::SiteError;
pub use graph::{Admission, History, Refusal, SiteConfig, SiteGraph};
pub use portal::{Portal, PortalId, PortalState};
pub use route::NextPortal;
pub use site::{Site, SiteId};
