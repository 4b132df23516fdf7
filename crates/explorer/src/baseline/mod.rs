//! What people use to clean point clouds today, behind one result type, to compare with.
//!
//! | function | removes | as in |
//! | --- | --- | --- |
//! | [`statistical`] | mean distance to k neighbours above mean + ratio · deviation | PCL, Open3D |
//! | [`radius`] | too few neighbours within a radius | PCL, Open3D |
//! | [`lof`] | local reachability density below that of the neighbours | Breunig et al. 2000 |
//! | [`dbscan`] | noise and clusters that are too small | Ester et al. 1996 |
//!
//! They serve `explorer clean --method` and the comparisons; a program of your own that wants to clean takes
//! `submodular-minimax`. All are deterministic, run in O(n k log n) expected time and take any number of points: with
//! none, the result is empty; a point without neighbours to judge it by is kept by [`statistical`]
//! and [`lof`] and removed by [`radius`] and [`dbscan`], whose definitions demand neighbours.

mod cloud;
mod dbscan;
mod error;
mod lof;
mod radius;
mod removal;
mod statistical;

pub use dbscan::{DbscanConfig, dbscan};
pub use error::BaselineError;
pub use lof::{LofConfig, lof};
pub use radius::{RadiusConfig, Reach, radius};
pub use removal::BaselineRemoval;
pub use statistical::{StatisticalConfig, statistical};
