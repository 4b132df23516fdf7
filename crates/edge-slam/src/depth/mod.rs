//! Depth: images of distances, where they come from, and how their scale is found.

mod image;
mod scale;
mod source;

pub use image::{DepthError, DepthImage};
pub use scale::{DepthFit, fit_depth};
pub use source::{ConstantDepth, DepthSource, NoDepth, SensorDepth};
