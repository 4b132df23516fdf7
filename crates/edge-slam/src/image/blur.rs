//! Separable Gaussian smoothing of 8-bit images in integer arithmetic.

use super::{GrayImage, GrayView};
use crate::simd::{Kernel, widest};

/// Greatest radius that [`gaussian_blur`] uses, pixels.
pub const BINOMIAL_RADIUS: usize = 3;

/// Smooths with a Gaussian of `sigma` pixels cut at `radius` (1 to 3) pixels; borders mirror (… 2 1 0 1 2 …).
///
/// Weights are rounded to 1/256, sums to 1, so that results are the same on every machine. A sigma that is not
/// positive returns the image unchanged. Cost: O(pixels).
#[must_use]
pub fn gaussian_blur(view: &GrayView<'_>, sigma: f64, radius: usize) -> GrayImage {
    let mut output = GrayImage::filled(view.width(), view.height(), 0);
    let mut column = Vec::new();
    smooth_with(view, &weights(sigma, radius), &mut column, &mut output);
    output
}

/// As [`gaussian_blur`] with given weights (centre first) into a buffer that the caller keeps.
pub(crate) fn smooth_with(
    view: &GrayView<'_>,
    weights: &[u16; BINOMIAL_RADIUS + 1],
    line: &mut Vec<u8>,
    output: &mut GrayImage,
) {
    let (width, height) = (view.width(), view.height());
    line.clear();
    line.resize(width + 2 * BINOMIAL_RADIUS, 0);
    let pixels = output.pixels_mut();
    for y in 0..height {
        let rows: [&[u8]; 2 * BINOMIAL_RADIUS + 1] =
            core::array::from_fn(|k| view.row(mirror(y + k, BINOMIAL_RADIUS, height)));
        let target = &mut pixels[y * width..(y + 1) * width];
        widest(SmoothRow {
            rows: &rows,
            weights,
            line,
            target,
        });
    }
}

struct SmoothRow<'a> {
    rows: &'a [&'a [u8]; 7],
    weights: &'a [u16; 4],
    line: &'a mut [u8],
    target: &'a mut [u8],
}

impl Kernel for SmoothRow<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            rows,
            weights,
            line,
            target,
        } = self;

        let width = target.len();
        let body = &mut line[BINOMIAL_RADIUS..BINOMIAL_RADIUS + width];
        weigh(*rows, weights, body);
        extend(line, width);
        let shifted = core::array::from_fn(|k| &line[k..]);
        weigh(shifted, weights, target);
    }
}

/// Weights of a Gaussian in 1/256, centre first.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0..=256 after rounding"
)]
pub(crate) fn weights(sigma: f64, radius: usize) -> [u16; BINOMIAL_RADIUS + 1] {
    let mut rounded = [0_u16; BINOMIAL_RADIUS + 1];
    if !(sigma > 0.0) || radius == 0 {
        rounded[0] = 256;
        return rounded;
    }
    let bell = |k: usize| {
        let x = [0.0, 1.0, 2.0, 3.0][k] / sigma;
        if k <= radius {
            (-0.5 * x * x).exp()
        } else {
            0.0
        }
    };
    let total = bell(0) + 2.0 * (1..=BINOMIAL_RADIUS).map(bell).sum::<f64>();
    for (k, weight) in rounded.iter_mut().enumerate() {
        *weight = (256.0 * bell(k) / total).round() as u16;
    }
    rounded[0] = 256 - 2 * rounded[1..].iter().sum::<u16>();
    rounded
}

fn mirror(shifted: usize, offset: usize, length: usize) -> usize {
    let index = shifted.abs_diff(offset);
    let last = length - 1;
    if index <= last {
        index
    } else {
        (2 * last).saturating_sub(index)
    }
    .min(last)
}

/// Each pixel of `output` from the pixels of seven lines in its place.
#[inline(always)]
fn weigh(lines: [&[u8]; 7], weights: &[u16; 4], output: &mut [u8]) {
    let n = output.len();
    let [a, b, c, d, e, f, g] = lines.map(|line| &line[..n]);
    let [w0, w1, w2, w3] = *weights;
    for i in 0..n {
        let sum = w0 * u16::from(d[i])
            + w1 * (u16::from(c[i]) + u16::from(e[i]))
            + w2 * (u16::from(b[i]) + u16::from(f[i]))
            + w3 * (u16::from(a[i]) + u16::from(g[i]));
        output[i] = (sum.saturating_add(128) >> 8) as u8;
    }
}

#[inline(always)]
fn extend(line: &mut [u8], width: usize) {
    for k in 0..BINOMIAL_RADIUS {
        line[k] = line[BINOMIAL_RADIUS + mirror(k, BINOMIAL_RADIUS, width)];
        let right = BINOMIAL_RADIUS + width + k;
        line[right] = line[BINOMIAL_RADIUS + mirror(right, BINOMIAL_RADIUS, width)];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn constant_images_stay() {
        for (w, h) in [(1, 1), (2, 1), (1, 5), (3, 3), (40, 20)] {
            let image = GrayImage::filled(w, h, 255);
            assert_eq!(gaussian_blur(&image.view(), 2.0, 3), image);
        }
    }

    #[test]
    fn weights_sum_to_one() {
        for sigma in [0.0, 0.3, 1.0, 1.4, 2.0, 50.0, f64::NAN, f64::INFINITY] {
            for radius in 0..5 {
                let w = weights(sigma, radius);
                assert_eq!(w[0] + 2 * (w[1] + w[2] + w[3]), 256, "{sigma} {radius}");
            }
        }
    }

    proptest! {
        #[test]
        fn agrees_with_plain_convolution(
            pixels in prop::collection::vec(0u8.., 12 * 9), sigma in 0.5..3.0f64,
        ) {
            let image = GrayImage::new(pixels, 12, 9).unwrap();
            let found = gaussian_blur(&image.view(), sigma, 3);
            let w = weights(sigma, 3);
            let at = |x: i64, y: i64| {
                let fold = |v: i64, n: i64| if v < 0 { -v } else if v >= n { 2 * n - 2 - v } else { v };
                f64::from(image.pixels()[(fold(y, 9) * 12 + fold(x, 12)) as usize])
            };
            for y in 0..9_i64 {
                for x in 0..12_i64 {
                    let mut sum = 0.0;
                    for v in -3..=3_i64 {
                        for u in -3..=3_i64 {
                            let weight = f64::from(w[u.unsigned_abs() as usize])
                                * f64::from(w[v.unsigned_abs() as usize]);
                            sum += weight * at(x + u, y + v) / 65536.0;
                        }
                    }
                    let value = f64::from(found.pixels()[(y * 12 + x) as usize]);
                    prop_assert!((value - sum).abs() <= 1.01);
                }
            }
        }
    }
}
