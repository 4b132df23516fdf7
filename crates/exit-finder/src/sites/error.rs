//! What can go wrong with the graph of sites.

use thiserror::Error;

use super::PortalState;

/// Why the graph refused a call. The graph is unchanged then.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SiteError {
    /// No portal has this number.
    #[error("there is no portal {portal}; the graph has {count}")]
    UnknownPortal {
        /// The number asked for.
        portal: usize,
        /// Portals in the graph.
        count: usize,
    },
    /// No site has this number.
    #[error("there is no site {site}; the graph has {count}")]
    UnknownSite {
        /// The number asked for.
        site: usize,
        /// Sites in the graph.
        count: usize,
    },
    /// The portal has been used before; a portal is entered at most once.
    #[error("portal {portal} is {state:?} and cannot be used again")]
    Used {
        /// The portal.
        portal: usize,
        /// Its state.
        state: PortalState,
    },
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
    /// The report's plane or agent differs from the graph's epoch.
    #[error("the graph belongs to epoch {graph}, the report to epoch {given}; reset the graph")]
    Epoch {
        /// Epoch of the graph.
        graph: u64,
        /// Epoch given.
        given: u64,
    },
    /// A keyframe pose is not finite or its rotation is not orthonormal.
    #[error("the pose of keyframe {keyframe} is not a rigid motion")]
    Pose {
        /// Number of the keyframe.
        keyframe: u64,
    },
}
