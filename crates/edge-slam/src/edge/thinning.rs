//! Thinning of Canny's edges: pixels that are stronger than both neighbours across the edge.
//!
//! Strengths of three rows are kept at a time; one pass over the image. The direction is the nearest of four, by
//! exact integer comparison with tan 22.5° and tan 67.5° = 2 + tan 22.5° in 1/2^15.

use super::Norm;
use super::gradient::GradientRow;
use crate::image::GrayView;
use crate::simd::{Kernel, widest};

pub(super) const NONE: u8 = 0;
pub(super) const WEAK: u8 = 1;
pub(super) const STRONG: u8 = 2;

/// tan 22.5° in 1/2^15.
const TAN_22: i32 = 13_573;

/// The class of each pixel, nothing, weak or strong, with a margin of one pixel of nothing all around.
///
/// `limits` are the low and the high threshold in the unit of [`strength`].
pub(super) fn thin(view: &GrayView<'_>, norm: Norm, limits: [i32; 2]) -> Vec<u8> {
    let (width, height) = (view.width(), view.height());
    let mut class = vec![NONE; (width + 2) * (height + 2)];
    match norm {
        // No strength reaches 2^15 - 1, so that a higher threshold may be lowered to it.
        Norm::L1 => {
            let limits = limits.map(|limit| i16::try_from(limit).unwrap_or(i16::MAX));
            thin_image(view, limits, &mut class);
        }
        Norm::L2 => thin_image(view, limits, &mut class),
    }
    class
}

fn thin_image<T: Strength>(view: &GrayView<'_>, limits: [T; 2], class: &mut [u8]) {
    widest(Thin {
        view,
        limits,
        class,
    });
}

/// A strength in the narrowest integer that holds it: sums of [`Norm::L1`] fit 16 bits, squares of [`Norm::L2`] do not.
trait Strength: Copy + Default + PartialOrd {
    fn of(gx: i16, gy: i16) -> Self;
}

impl Strength for i16 {
    #[inline(always)]
    fn of(gx: i16, gy: i16) -> Self {
        gx.abs() + gy.abs()
    }
}

impl Strength for i32 {
    #[inline(always)]
    fn of(gx: i16, gy: i16) -> Self {
        strength(gx.into(), gy.into(), Norm::L2)
    }
}

/// How strong a gradient is: Sobel units, squared for [`Norm::L2`].
#[inline(always)]
pub(super) fn strength(gx: i32, gy: i32, norm: Norm) -> i32 {
    match norm {
        Norm::L1 => gx.abs() + gy.abs(),
        Norm::L2 => gx * gx + gy * gy,
    }
}

/// Gradients of a row with their strengths, which have a margin of zeros.
struct Line<T> {
    gradient: GradientRow,
    strength: Vec<T>,
}

struct Thin<'a, T> {
    view: &'a GrayView<'a>,
    limits: [T; 2],
    class: &'a mut [u8],
}

impl<T: Strength> Kernel for Thin<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            view,
            limits,
            class,
        } = self;

        let (width, height) = (view.width(), view.height());
        let mut lines: [Line<T>; 3] = core::array::from_fn(|_| Line {
            gradient: GradientRow::new(width),
            strength: vec![T::default(); width + 2],
        });
        for y in 0..=height {
            let newest = &mut lines[2];
            if y < height {
                newest.gradient.compute(view, y);
                let GradientRow { across, down, .. } = &newest.gradient;
                let pairs = across.iter().zip(down);
                for (to, (&gx, &gy)) in newest.strength[1..=width].iter_mut().zip(pairs) {
                    *to = T::of(gx, gy);
                }
            } else {
                newest.strength.fill(T::default());
            }
            if y > 0 {
                let start = y * (width + 2) + 1;
                thin_row(&lines, limits, &mut class[start..start + width]);
            }
            lines.rotate_left(1);
        }
    }
}

#[inline(always)]
fn thin_row<T: Copy + PartialOrd>(
    [above, here, below]: &[Line<T>; 3],
    [low, high]: [T; 2],
    class: &mut [u8],
) {
    let n = class.len();
    let (gx, gy) = (&here.gradient.across[..n], &here.gradient.down[..n]);
    let [a, b, c] = thirds(&above.strength, n);
    let [d, e, f] = thirds(&here.strength, n);
    let [g, h, k] = thirds(&below.strength, n);
    for i in 0..n {
        let (wide, tall) = (gx[i].abs(), gy[i].abs());
        let flat = times_tan_22(wide);
        let centre = e[i];
        let lies = tall <= flat;
        let stands = tall > flat + 2 * wide;
        let falling = (gx[i] ^ gy[i]) >= 0;
        // All comparisons are made: choosing by bits keeps the loop free of branches.
        let across = lies & (centre > d[i]) & (centre >= f[i]);
        let down = stands & (centre > b[i]) & (centre >= h[i]);
        let slanted = !(lies | stands)
            & ((falling & (centre > a[i]) & (centre > k[i]))
                | (!falling & (centre > c[i]) & (centre > g[i])));
        let peak = (across | down | slanted) & (centre > low);
        class[i] = u8::from(peak) + u8::from(peak & (centre > high));
    }
}

/// ⌊x tan 22.5°⌋ for x in 0..2^14. A whole number is at most x tan 22.5° exactly when it is at most this; the
/// product is whole itself only for x = 0, whose pixels are too weak for an edge or upright.
#[inline(always)]
fn times_tan_22(x: i16) -> i16 {
    ((i32::from(2 * x) * TAN_22) >> 16) as i16
}

#[inline(always)]
fn thirds<T>(line: &[T], n: usize) -> [&[T]; 3] {
    [&line[..n], &line[1..=n], &line[2..n + 2]]
}

#[cfg(test)]
mod tests {
    use super::super::gradient::sobel_at;
    use super::*;
    use crate::image::GrayImage;
    use proptest::prelude::*;

    /// The definition, pixel by pixel, with wide integers.
    fn class_of(view: &GrayView<'_>, norm: Norm, [low, high]: [i32; 2], x: usize, y: usize) -> u8 {
        let at = |dx: isize, dy: isize| {
            let (u, v) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
            if u >= view.width() || v >= view.height() {
                return 0;
            }
            let [gx, gy] = sobel_at(view, u, v);
            strength(gx, gy, norm)
        };
        let [gx, gy] = sobel_at(view, x, y);
        let (wide, tall) = (i64::from(gx.abs()), i64::from(gy.abs()) << 15);
        let centre = at(0, 0);
        let peak = if tall < wide * 13_573 {
            centre > at(-1, 0) && centre >= at(1, 0)
        } else if tall > wide * (13_573 + (2 << 15)) {
            centre > at(0, -1) && centre >= at(0, 1)
        } else {
            let side = if (gx ^ gy) >= 0 { 1 } else { -1 };
            centre > at(-side, -1) && centre > at(side, 1)
        };
        u8::from(peak && centre > low) + u8::from(peak && centre > low && centre > high)
    }

    proptest! {
        #[test]
        fn rows_agree_with_the_definition(
            width in 1usize..14, height in 1usize..14, pixels in prop::collection::vec(any::<u8>(), 196),
            low in 0i32..400, more in 0i32..400,
        ) {
            let image = GrayImage::new(pixels, width, height).unwrap();
            for (norm, limits) in [
                (Norm::L1, [low, low + more]),
                (Norm::L2, [low * low, (low + more) * (low + more)]),
            ] {
                let class = thin(&image.view(), norm, limits);
                for y in 0..height {
                    for x in 0..width {
                        let expected = class_of(&image.view(), norm, limits, x, y);
                        prop_assert_eq!(class[(y + 1) * (width + 2) + x + 1], expected);
                    }
                }
            }
        }
    }
}
