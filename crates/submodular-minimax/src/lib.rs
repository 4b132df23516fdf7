#![doc = include_str!("../README.md")]

pub mod baseline;
mod disjoint_sets;
pub mod minimax;
mod neighbours;
pub mod outlier;
mod points;
mod views;

pub use minimax::{Beta, Certificate, StopReason};
pub use outlier::{OutlierConfig, OutlierError, OutlierRemoval, Reading, Solver, remove_outliers};
pub use points::PointLike;
pub use views::{Views, ViewsError};
