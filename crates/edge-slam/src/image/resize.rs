//! Bilinear resampling of 8-bit images, pixel centres aligned.

use super::bilinear::Between;
use super::{GrayImage, GrayView};
use crate::simd::widest;

/// The image resampled to `width` x `height` pixels by bilinear interpolation (no smoothing: meant for small
/// reductions such as the 1.2 of an ORB pyramid). Sides of zero become one. Cost: O(pixels of both).
///
/// Centre (x, y) of the result shows ((x + ½) sx − ½, (y + ½) sy − ½) of the source, sx = source over result width.
#[must_use]
pub fn resize(view: &GrayView<'_>, width: usize, height: usize) -> GrayImage {
    let mut output = GrayImage::filled(width, height, 0);
    let (width, height) = (output.width(), output.height());
    let columns = taps(view.width(), width);
    let rows = taps(view.height(), height);
    let mut line = vec![0_u16; view.width() + 1];
    for (target, &(y, weight)) in output.pixels_mut().chunks_exact_mut(width).zip(&rows) {
        let (upper, lower) = (view.row(y as usize), view.row(y as usize + 1));
        widest(|| {
            blend_rows(upper, lower, weight, &mut line);
            pick_columns(&line, &columns, target);
        });
    }
    output
}

/// For every target index the first of its neighbours in the source, and the weight of the second one in 1/128: sums of bytes
/// then fit 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "shares are in 0..1; sides of images are small"
)]
fn taps(source: usize, target: usize) -> Vec<(u32, u16)> {
    let ratio = source as f64 / target as f64;
    (0..target)
        .map(|index| {
            let near = Between::nearest((index as f64 + 0.5) * ratio - 0.5, source);
            (near.before as u32, (near.share * 128.0).round() as u16)
        })
        .collect()
}

#[inline(always)]
fn blend_rows(upper: &[u8], lower: &[u8], weight: u16, line: &mut [u16]) {
    let n = upper.len();
    let (lower, body) = (&lower[..n], &mut line[..n]);
    for i in 0..n {
        body[i] = u16::from(upper[i]) * (128 - weight) + u16::from(lower[i]) * weight;
    }
    line[n] = line[n - 1];
}

#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "a weighted mean of bytes is a byte"
)]
fn pick_columns(line: &[u16], columns: &[(u32, u16)], target: &mut [u8]) {
    for (pixel, &(x, weight)) in target.iter_mut().zip(columns) {
        let x = x as usize;
        let pair = &line[x..x + 2];
        let sum =
            u32::from(pair[0]) * u32::from(128 - weight) + u32::from(pair[1]) * u32::from(weight);
        *pixel = ((sum + (1 << 13)) >> 14) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn same_size_changes_nothing() {
        let image = GrayImage::new((0..=255).collect(), 16, 16).unwrap();
        assert_eq!(resize(&image.view(), 16, 16), image);
    }

    proptest! {
        #[test]
        fn agrees_with_plain_bilinear(
            pixels in prop::collection::vec(0u8.., 13 * 7), w in 1usize..20, h in 1usize..20,
        ) {
            let image = GrayImage::new(pixels, 13, 7).unwrap();
            let small = resize(&image.view(), w, h);
            for y in 0..h {
                for x in 0..w {
                    let sx = ((x as f64 + 0.5) * 13.0 / w as f64 - 0.5).clamp(0.0, 12.0);
                    let sy = ((y as f64 + 0.5) * 7.0 / h as f64 - 0.5).clamp(0.0, 6.0);
                    let expected = image.view().bilinear(sx, sy).unwrap();
                    prop_assert!((f64::from(small.pixels()[y * w + x]) - expected).abs() < 2.6);
                }
            }
        }
    }
}
