//! Edges: gradients, Canny with sub-pixel chains, and L-junctions where two straight edges meet.

mod canny;
mod chain;
mod gradient;
mod junction;
mod line;

pub use canny::{CannyConfig, CannyError, EdgeMap, Norm, Thresholds, canny};
pub use chain::{EdgeChain, EdgePoint, trace_chains};
pub use junction::{JunctionConfig, LJunction, find_junctions};
pub use line::{LineSegment, fit_line, split_chain};
