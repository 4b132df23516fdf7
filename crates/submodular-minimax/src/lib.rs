#![doc = include_str!("../README.md")]

mod disjoint_sets;
pub mod functions;
mod joint_function;
pub mod laws;
pub mod maximize;
pub mod minimax;
pub mod minimize;
mod neighbours;
pub mod outlier;
mod points;
mod set_function;
mod subset;
mod views;

pub use joint_function::{Joined, JointFunction, Split};
pub use minimax::{Beta, Certificate, MinimaxConfig, StopReason};
pub use outlier::{
    AmongCameras, Cues, DepthSource, ImageNeighbours, OutlierConfig, OutlierError, OutlierRemoval,
    RayConfig, Reading, Solver, Tolerance, remove_outliers,
};
pub use points::PointLike;
pub use set_function::{Growth, SetFunction};
pub use subset::Subset;
pub use views::{Views, ViewsError};
