//! A path through ℝᴰ: its length, points along it, and what a vehicle needs to fly it.

mod clearance;
mod legs;
mod polyline;
mod resample;

pub(crate) use clearance::between_samples;
pub use clearance::{ClearanceProfile, ClearanceSample};
pub use legs::Leg;
pub(crate) use legs::{angle_between, direction};
pub(crate) use polyline::Place;
pub use polyline::{Path, PathError};
