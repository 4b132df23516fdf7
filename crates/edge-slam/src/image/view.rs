//! A borrowed 8-bit grey image: the form in which every function here takes pixels.

use super::bilinear::Neighbourhood;

/// Why bytes cannot be an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// No pixel at all.
    #[error("the image is {width} x {height}; both sides must be at least 1")]
    Empty {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Rows would overlap.
    #[error("a row takes {width} bytes, but the stride is only {stride}")]
    Stride {
        /// Columns.
        width: usize,
        /// Bytes from one row to the next.
        stride: usize,
    },
    /// The buffer ends too early.
    #[error(
        "{width} x {height} pixels with this stride need {needed} bytes, the buffer has {found}"
    )]
    TooShort {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Bytes needed.
        needed: usize,
        /// Bytes there.
        found: usize,
    },
}

/// 8-bit grey pixels somewhere else. Pixel (x, y) has its centre at integer coordinates; y grows downwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GrayView<'a> {
    data: &'a [u8],
    width: usize,
    height: usize,
    stride: usize,
}

impl<'a> GrayView<'a> {
    /// Rows packed without gaps.
    ///
    /// # Errors
    /// [`ImageError`] when a side is zero or the buffer too short.
    ///
    /// ```
    /// use edge_slam::image::GrayView;
    /// let view = GrayView::new(&[1, 2, 3, 4, 5, 6], 3, 2)?;
    /// assert_eq!(view.get(2, 1), Some(6));
    /// # Ok::<(), edge_slam::image::ImageError>(())
    /// ```
    pub fn new(data: &'a [u8], width: usize, height: usize) -> Result<Self, ImageError> {
        Self::with_stride(data, width, height, width)
    }

    /// Rows `stride` bytes apart (an image inside a greater one, or padded rows).
    ///
    /// # Errors
    /// [`ImageError`] when a side is zero, the stride under the width, or the buffer too short.
    pub fn with_stride(
        data: &'a [u8],
        width: usize,
        height: usize,
        stride: usize,
    ) -> Result<Self, ImageError> {
        if width == 0 || height == 0 {
            return Err(ImageError::Empty { width, height });
        }
        if stride < width {
            return Err(ImageError::Stride { width, stride });
        }
        let needed = (height - 1).saturating_mul(stride).saturating_add(width);
        if data.len() < needed {
            return Err(ImageError::TooShort {
                width,
                height,
                needed,
                found: data.len(),
            });
        }
        Ok(Self {
            data,
            width,
            height,
            stride,
        })
    }

    /// Pixels whose size was checked before.
    pub(super) fn packed(data: &'a [u8], width: usize, height: usize) -> Self {
        Self {
            data,
            width,
            height,
            stride: width,
        }
    }

    /// Columns, at least 1.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows, at least 1.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixels of row `y`, `width` of them. Rows past the last give the last one.
    #[must_use]
    pub fn row(&self, y: usize) -> &'a [u8] {
        let start = y.min(self.height - 1) * self.stride;
        &self.data[start..start + self.width]
    }

    /// The pixel at column x and row y, if inside.
    #[must_use]
    pub fn get(&self, x: usize, y: usize) -> Option<u8> {
        if y < self.height {
            self.row(y).get(x).copied()
        } else {
            None
        }
    }

    /// The bilinear value at a sub-pixel place, if all four neighbours are inside.
    #[must_use]
    pub fn bilinear(&self, x: f64, y: f64) -> Option<f64> {
        let near = Neighbourhood::of(x, y, self.width, self.height)?;
        let [left, right] = near.columns();
        let [upper, lower] = near.rows().map(|y| self.row(y));
        let corners = [upper[left], upper[right], lower[left], lower[right]];
        Some(near.blend(corners.map(f64::from)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_sizes_are_refused() {
        assert!(matches!(
            GrayView::new(&[], 0, 4),
            Err(ImageError::Empty { .. })
        ));
        assert!(matches!(
            GrayView::new(&[0; 5], 3, 2),
            Err(ImageError::TooShort { needed: 6, .. })
        ));
        assert!(matches!(
            GrayView::with_stride(&[0; 5], 3, 1, 2),
            Err(ImageError::Stride { .. })
        ));
        assert!(GrayView::new(&[0; 5], usize::MAX, usize::MAX).is_err());
    }

    #[test]
    fn a_padded_buffer_shows_the_same_pixels() {
        let view = GrayView::with_stride(&[1, 2, 9, 3, 4], 2, 2, 3).unwrap();
        assert_eq!((view.row(0), view.row(1)), (&[1, 2][..], &[3, 4][..]));
        assert_eq!(view.get(2, 0), None);
        assert_eq!(view.bilinear(0.5, 0.5), Some(2.5));
        assert_eq!(view.bilinear(1.0, 1.0), Some(4.0));
        assert_eq!(view.bilinear(1.1, 0.0), None);
        assert_eq!(view.bilinear(f64::NAN, 0.0), None);
    }
}
