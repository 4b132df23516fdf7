//! Edges: gradients, Canny with sub-pixel chains, and L-junctions where two straight edges meet.

mod canny;
mod chain;
mod gradient;
mod junction;
mod lift;
mod line;
mod thinning;

pub use canny::{CannyConfig, CannyError, EdgeMap, Norm, Thresholds, canny};
pub use chain::{EdgeChain, EdgePoint, trace_chains};
pub use junction::{JunctionConfig, LJunction, find_junctions};
pub use lift::{EdgePoint3, SpatialJunction, lift_chain, lift_junction};
pub use line::{LineSegment, fit_line, split_chain};
