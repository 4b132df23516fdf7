#![doc = include_str!("../README.md")]

mod map;
mod source;

pub use map::{Frustum, KeyFrame, KeyFrameId, Map, MapPoint, PointId, Scale};
pub use nalgebra;
pub use source::{SlamSource, SlamUpdate, TrackingState};
