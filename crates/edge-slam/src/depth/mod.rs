//! Depth: images of distances, and where they come from.

mod image;

pub use image::{DepthError, DepthImage};
