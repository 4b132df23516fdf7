//! Depth: images of distances, where they come from, and how their scale is found.

mod image;
#[cfg(feature = "depth-onnx")]
mod onnx;
#[cfg(feature = "depth-onnx")]
mod onnx_names;
mod scale;
mod source;

pub use image::{DepthError, DepthImage};
#[cfg(feature = "depth-onnx")]
pub use onnx::OnnxDepth;
pub use scale::{DepthFit, fit_depth};
pub use source::{ConstantDepth, DepthSource, NoDepth, SensorDepth};
