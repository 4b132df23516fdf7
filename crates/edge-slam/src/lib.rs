//! Monocular edge-aware visual-inertial SLAM in small pure steps.
//!
// An example of the README reads recorded pictures.
#![cfg_attr(feature = "image-files", doc = include_str!("../README.md"))]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a negated comparison refuses NaN as well"
)]

pub mod camera;
pub mod depth;
pub mod edge;
pub mod evaluation;
pub mod feature;
mod frame;
pub mod fusion;
pub mod image;
pub mod odometry;
pub mod pnp;
#[cfg(feature = "image-files")]
pub mod sequence;
mod simd;
pub mod two_view;

pub use frame::Frame;
pub use nalgebra;
