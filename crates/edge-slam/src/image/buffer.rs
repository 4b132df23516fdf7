//! An owned 8-bit grey image.

use super::{GrayView, ImageError};

/// 8-bit grey pixels, rows packed without gaps, at least one pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GrayImage {
    data: Vec<u8>,
    width: usize,
    height: usize,
}

impl GrayImage {
    /// Takes a buffer of exactly or more than `width * height` bytes.
    ///
    /// # Errors
    /// [`ImageError`] when a side is zero or the buffer too short.
    pub fn new(mut data: Vec<u8>, width: usize, height: usize) -> Result<Self, ImageError> {
        GrayView::new(&data, width, height)?;
        data.truncate(width * height);
        Ok(Self {
            data,
            width,
            height,
        })
    }

    /// An image of one grey. Sides of zero become one.
    #[must_use]
    pub fn filled(width: usize, height: usize, value: u8) -> Self {
        let (width, height) = (width.max(1), height.max(1));
        Self {
            data: vec![value; width * height],
            width,
            height,
        }
    }

    /// Converts packed RGB bytes by ITU-R 601 luma, rounded: 0.299 R + 0.587 G + 0.114 B.
    ///
    /// # Errors
    /// [`ImageError`] when a side is zero or the buffer too short.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the weights sum to 2^15, so the result is a byte"
    )]
    pub fn from_rgb(rgb: &[u8], width: usize, height: usize) -> Result<Self, ImageError> {
        let luma = rgb.chunks_exact(3).map(|pixel| {
            let [r, g, b] = [
                u32::from(pixel[0]),
                u32::from(pixel[1]),
                u32::from(pixel[2]),
            ];
            ((r * 9798 + g * 19235 + b * 3735 + (1 << 14)) >> 15) as u8
        });
        Self::new(luma.collect(), width, height)
    }

    /// The whole image, borrowed.
    #[must_use]
    pub fn view(&self) -> GrayView<'_> {
        GrayView::packed(&self.data, self.width, self.height)
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        &self.data
    }

    /// All pixels, row by row, to be changed.
    pub fn pixels_mut(&mut self) -> &mut [u8] {
        &mut self.data
    }
}

/// A copy of the pixels.
impl From<GrayView<'_>> for GrayImage {
    fn from(view: GrayView<'_>) -> Self {
        let (width, height) = (view.width(), view.height());
        let mut data = Vec::with_capacity(width * height);
        (0..height).for_each(|y| data.extend_from_slice(view.row(y)));
        Self {
            data,
            width,
            height,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luma_keeps_grey_and_weighs_colours() {
        let rgb = [
            0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 77, 77, 77,
        ];
        let image = GrayImage::from_rgb(&rgb, 6, 1).unwrap();
        assert_eq!(image.pixels(), [0, 255, 76, 150, 29, 77]);
        assert!(GrayImage::from_rgb(&rgb, 7, 1).is_err());
    }
}
