//! Nearest neighbours under the Euclidean or the range-normalised distance.

mod graph;
mod tree;

pub(crate) use graph::NeighbourGraph;
pub(crate) use tree::{Neighbour, RangeTree};
