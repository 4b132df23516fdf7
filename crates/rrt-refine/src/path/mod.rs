//! A path through ℝᴰ: its length, points along it, and what a vehicle needs to fly it.

mod polyline;
mod resample;

pub use polyline::{Path, PathError};
