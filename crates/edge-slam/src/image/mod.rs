//! Grey images: a borrowed view, an owned buffer, smoothing, resizing and pyramids.

mod bilinear;
mod blur;
mod buffer;
mod pyramid;
mod resize;
mod view;

pub(crate) use bilinear::{Neighbourhood, sample_square};
pub use blur::{BINOMIAL_RADIUS, gaussian_blur};
pub(crate) use blur::{smooth_with, weights};
pub use buffer::GrayImage;
pub use pyramid::Pyramid;
pub use resize::resize;
pub use view::{GrayView, ImageError};
