//! One camera frame, as a caller hands it in.

use crate::depth::DepthImage;
use crate::image::GrayView;

/// A grey image with its time and, where a sensor took one, its depth image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame<'a> {
    /// Seconds on the caller's clock.
    pub time: f64,
    /// The image as the camera gave it, lens distortion included.
    pub image: GrayView<'a>,
    /// Registered depth of the same size, if any.
    pub depth: Option<&'a DepthImage>,
}
