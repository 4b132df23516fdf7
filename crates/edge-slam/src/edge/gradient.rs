//! Sobel gradients of a grey image, borders repeated: row by row, or at one pixel.
//!
//! In Sobel units, eight times the derivative in grey levels per pixel. Rows are never all kept: for a whole image
//! they are four times as large as the image, and writing them costs more than computing them.

use crate::image::GrayView;

/// Room for one row of gradients and for its vertical halves.
#[derive(Debug, Clone)]
pub(super) struct GradientRow {
    pub(super) across: Vec<i16>,
    pub(super) down: Vec<i16>,
    /// A row smoothed, and one differenced vertically, with their border columns repeated.
    smooth: Vec<i16>,
    slope: Vec<i16>,
}

impl GradientRow {
    pub(super) fn new(width: usize) -> Self {
        Self {
            across: vec![0; width],
            down: vec![0; width],
            smooth: vec![0; width + 2],
            slope: vec![0; width + 2],
        }
    }

    /// Computes row `y` of the image. Inline it into a vectorised loop.
    #[inline(always)]
    pub(super) fn compute(&mut self, view: &GrayView<'_>, y: usize) {
        let width = self.across.len();
        let (above, here, below) = (view.row(y.saturating_sub(1)), view.row(y), view.row(y + 1));
        vertical(
            above,
            here,
            below,
            &mut self.smooth[1..=width],
            &mut self.slope[1..=width],
        );
        for line in [&mut self.smooth, &mut self.slope] {
            line[0] = line[1];
            line[width + 1] = line[width];
        }
        horizontal(&self.smooth, &self.slope, &mut self.across, &mut self.down);
    }
}

/// The gradient at a pixel of the image: across and down.
#[inline]
pub(super) fn sobel_at(view: &GrayView<'_>, x: usize, y: usize) -> [i32; 2] {
    let rows = [view.row(y.saturating_sub(1)), view.row(y), view.row(y + 1)];
    let right = (x + 1).min(view.width() - 1);
    let columns = [x.saturating_sub(1), x.min(right), right];
    let [[a, b, c], [d, _, f], [g, h, i]] =
        rows.map(|row| columns.map(|column| i32::from(row[column])));
    [
        (c - a) + 2 * (f - d) + (i - g),
        (g - a) + 2 * (h - b) + (i - c),
    ]
}

#[inline(always)]
fn vertical(above: &[u8], here: &[u8], below: &[u8], smooth: &mut [i16], slope: &mut [i16]) {
    let n = above.len();
    let (here, below, smooth, slope) = (&here[..n], &below[..n], &mut smooth[..n], &mut slope[..n]);
    for i in 0..n {
        let (a, b, c) = (i16::from(above[i]), i16::from(here[i]), i16::from(below[i]));
        smooth[i] = a + 2 * b + c;
        slope[i] = c - a;
    }
}

#[inline(always)]
fn horizontal(smooth: &[i16], slope: &[i16], across: &mut [i16], down: &mut [i16]) {
    let n = across.len();
    let (left, right) = (&smooth[..n], &smooth[2..n + 2]);
    let (a, b, c, down) = (&slope[..n], &slope[1..=n], &slope[2..n + 2], &mut down[..n]);
    for i in 0..n {
        across[i] = right[i] - left[i];
        down[i] = a[i] + 2 * b[i] + c[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;
    use proptest::prelude::*;

    #[test]
    fn a_ramp_has_its_slope() {
        let image = GrayImage::new(
            (0..35).map(|i| (i % 7 * 10 + i / 7 * 3) as u8).collect(),
            7,
            5,
        )
        .unwrap();
        let mut row = GradientRow::new(7);
        row.compute(&image.view(), 2);
        assert_eq!((row.across[3], row.down[3]), (80, 24));
        assert_eq!(sobel_at(&image.view(), 0, 2)[0], 40);
        assert_eq!(sobel_at(&image.view(), 3, 0)[1], 12);
        assert_eq!(sobel_at(&GrayImage::filled(1, 1, 200).view(), 0, 0), [0, 0]);
    }

    proptest! {
        #[test]
        fn rows_and_single_pixels_agree(
            width in 1usize..12, height in 1usize..12, pixels in prop::collection::vec(any::<u8>(), 144),
        ) {
            let image = GrayImage::new(pixels, width, height).unwrap();
            let mut row = GradientRow::new(width);
            for y in 0..height {
                row.compute(&image.view(), y);
                for x in 0..width {
                    let pair = [i32::from(row.across[x]), i32::from(row.down[x])];
                    prop_assert_eq!(pair, sobel_at(&image.view(), x, y));
                }
            }
        }
    }
}
