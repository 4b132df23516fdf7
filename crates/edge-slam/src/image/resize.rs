//! Bilinear resampling of 8-bit images, pixel centres aligned.

use super::bilinear::Between;
use super::{GrayImage, GrayView};
use crate::simd::{Kernel, widest};

/// The image resampled to `width` x `height` pixels by bilinear interpolation (no smoothing: meant for small
/// reductions such as the 1.2 of an ORB pyramid). Sides of zero become one. Cost: O(pixels of both).
///
/// Centre (x, y) of the result shows ((x + ½) sx − ½, (y + ½) sy − ½) of the source, sx = source over result width.
#[must_use]
pub fn resize(view: &GrayView<'_>, width: usize, height: usize) -> GrayImage {
    let mut output = GrayImage::filled(width, height, 0);
    let (width, height) = (output.width(), output.height());
    let columns = Columns::new(view.width(), width);
    let rows = taps(view.height(), height);
    let mut line = vec![0_u16; view.width() + 1 + WINDOW];
    for (target, &(y, weight)) in output.pixels_mut().chunks_exact_mut(width).zip(&rows) {
        let (upper, lower) = (view.row(y as usize), view.row(y as usize + 1));
        widest(ResizeRow {
            upper,
            lower,
            weight,
            line: &mut line,
            target,
            columns: &columns,
        });
    }
    output
}

/// Which source columns a target column is made of.
struct Columns {
    taps: Vec<(u32, u16)>,
    blocks: Option<Vec<Block>>,
}

impl Columns {
    fn new(source: usize, target: usize) -> Self {
        let taps = taps(source, target);
        let blocks = blocks_of(&taps);
        Self { taps, blocks }
    }
}

struct ResizeRow<'a> {
    upper: &'a [u8],
    lower: &'a [u8],
    weight: u16,
    line: &'a mut [u16],
    target: &'a mut [u8],
    columns: &'a Columns,
}

impl Kernel for ResizeRow<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            upper,
            lower,
            weight,
            line,
            target,
            columns,
        } = self;

        blend_rows(upper, lower, weight, line);
        match &columns.blocks {
            Some(blocks) => mix_columns(line, blocks, &columns.taps, target),
            None => pick_columns(line, &columns.taps, target),
        }
    }
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

/// Columns of the target that are computed at once, and the most source columns behind one's own that they reach.
const LANES: usize = 8;
const SPAN: usize = 4;
const WINDOW: usize = LANES + SPAN - 1;

/// Eight neighbouring target columns as sums over a window of the source: column i is Σ window[i + k] weights[k][i], so that
/// the loop over i reads the line in order.
struct Block {
    start: usize,
    weights: [[u32; LANES]; SPAN],
}

/// The whole blocks of a row; `None` when the reduction is too great (beyond 1.28) for their windows.
fn blocks_of(columns: &[(u32, u16)]) -> Option<Vec<Block>> {
    let block = |columns: &[(u32, u16)]| {
        let start = columns[0].0 as usize;
        let mut weights = [[0; LANES]; SPAN];
        for (i, &(x, weight)) in columns.iter().enumerate() {
            let k = (x as usize).checked_sub(start + i)?;
            weights.get_mut(k + 1)?[i] = u32::from(weight);
            weights[k][i] = u32::from(128 - weight);
        }
        Some(Block { start, weights })
    };
    columns.chunks_exact(LANES).map(block).collect()
}

#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "a weighted mean of bytes is a byte"
)]
fn mix_columns(line: &[u16], blocks: &[Block], columns: &[(u32, u16)], target: &mut [u8]) {
    let whole = blocks.len() * LANES;
    let (body, rest) = target.split_at_mut(whole);
    for (block, pixels) in blocks.iter().zip(body.chunks_exact_mut(LANES)) {
        let window = &line[block.start..block.start + WINDOW];
        let mut sums = [1_u32 << 13; LANES];
        for (k, weights) in block.weights.iter().enumerate() {
            let shifted = &window[k..k + LANES];
            for i in 0..LANES {
                sums[i] += u32::from(shifted[i]) * weights[i];
            }
        }
        for (pixel, sum) in pixels.iter_mut().zip(sums) {
            *pixel = (sum >> 14) as u8;
        }
    }
    pick_columns(line, &columns[whole..], rest);
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
        fn blocks_give_what_single_columns_give(
            source in 8usize..200, target in 1usize..220, seed in any::<u32>(),
        ) {
            let columns = taps(source, target);
            if let Some(blocks) = blocks_of(&columns) {
                let grey = |i: usize| (i as u32).wrapping_mul(seed | 1) as u16 % 32_641;
                let line: Vec<u16> = (0..=source + WINDOW).map(grey).collect();
                let [mut a, mut b] = [vec![0; target], vec![1; target]];
                mix_columns(&line, &blocks, &columns, &mut a);
                pick_columns(&line, &columns, &mut b);
                prop_assert_eq!(a, b);
            } else {
                prop_assert!(!(100 * target..=128 * target).contains(&(100 * source)), "{} {}", source, target);
            }
        }

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
