//! Sobel gradients of a grey image, borders repeated.

use crate::image::GrayView;
use crate::simd::widest;

/// Eight times the derivative in grey levels per pixel, row by row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Gradient {
    pub(super) across: Vec<i16>,
    pub(super) down: Vec<i16>,
}

/// The 3x3 Sobel derivatives. Cost: O(pixels).
pub(super) fn sobel(view: &GrayView<'_>) -> Gradient {
    let (width, height) = (view.width(), view.height());
    let mut gradient = Gradient {
        across: vec![0; width * height],
        down: vec![0; width * height],
    };
    // A row, smoothed and differenced vertically, with its border columns repeated.
    let mut smooth = vec![0_i16; width + 2];
    let mut slope = vec![0_i16; width + 2];
    let rows = gradient
        .across
        .chunks_exact_mut(width)
        .zip(gradient.down.chunks_exact_mut(width));
    for (y, (across, down)) in rows.enumerate() {
        let (above, here, below) = (view.row(y.saturating_sub(1)), view.row(y), view.row(y + 1));
        widest(|| {
            vertical(
                above,
                here,
                below,
                &mut smooth[1..=width],
                &mut slope[1..=width],
            );
            for line in [&mut smooth, &mut slope] {
                line[0] = line[1];
                line[width + 1] = line[width];
            }
            horizontal(&smooth, &slope, across, down);
        });
    }
    gradient
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

    #[test]
    fn a_ramp_has_its_slope() {
        let image = GrayImage::new(
            (0..35).map(|i| (i % 7 * 10 + i / 7 * 3) as u8).collect(),
            7,
            5,
        )
        .unwrap();
        let gradient = sobel(&image.view());
        assert_eq!(
            (gradient.across[2 * 7 + 3], gradient.down[2 * 7 + 3]),
            (80, 24)
        );
        assert_eq!((gradient.across[2 * 7], gradient.down[3]), (40, 12));
        let one = sobel(&GrayImage::filled(1, 1, 200).view());
        assert_eq!((one.across, one.down), (vec![0], vec![0]));
    }
}
