//! Cameras: pinhole projection, lens distortion, and maps that remove it.

mod distortion;
mod pinhole;
mod undistortion;

pub use distortion::RadialTangential;
pub use pinhole::{CameraError, PinholeCamera};
pub use undistortion::{Camera, UndistortionMap};
