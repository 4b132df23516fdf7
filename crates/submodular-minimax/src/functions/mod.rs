//! Ready-made set functions, dense and sparse, and the joint function of the exploration paper.

mod bounded_greedy;
mod client_blocks;
mod combine;
mod coverage;
mod error;
mod facility_location;
mod gain_bound;
mod graph_cut;
mod modular;
mod representation;
mod similarity;

pub use combine::{Restriction, WeightedSum};
pub use coverage::Coverage;
pub use error::FunctionError;
pub use facility_location::FacilityLocation;
pub use graph_cut::GraphCut;
pub use modular::Modular;
pub use representation::Representation;
pub use similarity::{Dense, Kernel, Points, Similarity, Sparse};
