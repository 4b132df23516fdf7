//! FAST-9 corners (Rosten & Drummond 2006): nine neighbours in a row on a circle of 16 all brighter or all darker.
//!
//! 1. For a whole row, at vector width: every arc of nine holds one of each two opposite circle pixels, so a
//!    corner needs min over the 8 opposite pairs of their max > centre + t (or the mirrored test).
//! 2. For the few pixels left, 32 at a time: the exact score, the greatest threshold at which the pixel is still a corner.
//! 3. Suppression of all but the local maxima in 3x3; of equal neighbours the first in reading order stays.

use crate::image::GrayView;
use crate::simd::{Kernel, widest};

/// A corner at whole pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Corner {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Grey levels by which the weakest pixel of the best arc differs from the centre, > threshold.
    pub score: u8,
}

/// All corners whose arc differs from the centre by more than `threshold` grey levels, in reading order.
///
/// Pixels nearer than `border` (at least 3) to the edge are not tested; images without others give nothing.
/// Cost: O(pixels).
#[must_use]
pub fn fast_corners(view: &GrayView<'_>, threshold: u8, border: usize) -> Vec<Corner> {
    let border = border.max(RADIUS);
    let region = Region {
        left: border,
        top: border,
        right: view.width().saturating_sub(border),
        bottom: view.height().saturating_sub(border),
    };
    let mut corners = Vec::new();
    detect(view, region, threshold, &mut corners);
    corners
}

/// Columns `left..right` and rows `top..bottom`, all at least 3 pixels inside the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Region {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) right: usize,
    pub(super) bottom: usize,
}

const RADIUS: usize = 3;

/// The circle of radius 3, clockwise from the top: (dx, dy).
const CIRCLE: [(i32, i32); 16] = [
    (0, -3),
    (1, -3),
    (2, -2),
    (3, -1),
    (3, 0),
    (3, 1),
    (2, 2),
    (1, 3),
    (0, 3),
    (-1, 3),
    (-2, 2),
    (-3, 1),
    (-3, 0),
    (-3, -1),
    (-2, -2),
    (-1, -3),
];

/// Appends the corners of a region, in reading order.
pub(super) fn detect(
    view: &GrayView<'_>,
    region: Region,
    threshold: u8,
    corners: &mut Vec<Corner>,
) {
    if region.left >= region.right || region.top >= region.bottom {
        return;
    }
    let width = region.right - region.left;
    // Padded to whole words, so that empty stretches are skipped eight pixels at a time.
    let mut mask = vec![0_u8; width.next_multiple_of(8)];
    // Three rows of scores with a margin of one on both sides; the third of a row's neighbours follows it.
    let mut scores = [
        vec![0_u8; width + 2],
        vec![0_u8; width + 2],
        vec![0_u8; width + 2],
    ];
    let mut found: [Vec<usize>; 3] = Default::default();
    for y in region.top..=region.bottom {
        let now = y % 3;
        for column in found[now].drain(..) {
            scores[now][column + 1] = 0;
        }
        if y < region.bottom {
            let rows: [&[u8]; 7] = core::array::from_fn(|k| view.row(y + k - RADIUS));
            let (scores, found) = (&mut scores[now], &mut found[now]);
            let row = Row {
                pixels: &rows,
                left: region.left,
                threshold,
            };
            widest(TestRow {
                row,
                width,
                mask: &mut mask,
                scores,
                found,
            });
        }
        if y > region.top {
            let (middle, above) = ((y + 2) % 3, (y + 1) % 3);
            let neighbours = [&scores[above], &scores[middle], &scores[now]];
            suppress(neighbours, &found[middle], region.left, y - 1, corners);
        }
    }
}

/// A row of pixels with the three above and below, and the first column to test.
#[derive(Clone, Copy)]
struct Row<'a> {
    pixels: &'a [&'a [u8]; 7],
    left: usize,
    threshold: u8,
}

struct TestRow<'a> {
    row: Row<'a>,
    width: usize,
    mask: &'a mut [u8],
    scores: &'a mut [u8],
    found: &'a mut Vec<usize>,
}

impl Kernel for TestRow<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            row,
            width,
            mask,
            scores,
            found,
        } = self;

        candidates(row, &mut mask[..width]);
        score_row(row, mask, scores, found);
    }
}

/// Marks the pixels that may be corners: 1 or 0 for each column from `left`.
#[inline(always)]
fn candidates(row: Row<'_>, mask: &mut [u8]) {
    let whole = mask.len() / BATCH * BATCH;
    for start in (0..whole).step_by(BATCH) {
        test_block::<BATCH>(row, start, mask);
    }
    // The rest once more with its neighbours, if the row is long enough for that.
    if let Some(last) = mask.len().checked_sub(BATCH) {
        test_block::<BATCH>(row, last, mask);
    } else {
        (0..mask.len()).for_each(|start| test_block::<1>(row, start, mask));
    }
}

/// The same for `N` columns, which are copied so that the compiler knows them to be apart from the mask.
#[inline(always)]
fn test_block<const N: usize>(row: Row<'_>, start: usize, mask: &mut [u8]) {
    let at = |(dx, dy): (i32, i32)| {
        let from = (row.left + start).wrapping_add_signed(dx as isize);
        let line = row.pixels[RADIUS.wrapping_add_signed(dy as isize)];
        let mut pixels = [0; N];
        pixels.copy_from_slice(&line[from..from + N]);
        pixels
    };
    let (mut bright, mut dark) = ([u8::MAX; N], [u8::MIN; N]);
    for k in 0..8 {
        let (a, b) = (at(CIRCLE[k]), at(CIRCLE[k + 8]));
        for i in 0..N {
            bright[i] = bright[i].min(a[i].max(b[i]));
            dark[i] = dark[i].max(a[i].min(b[i]));
        }
    }
    let (centre, marks) = (at((0, 0)), &mut mask[start..start + N]);
    for i in 0..N {
        let high = centre[i].saturating_add(row.threshold);
        let low = centre[i].saturating_sub(row.threshold);
        marks[i] = u8::from(bright[i] > high) | u8::from(dark[i] < low);
    }
}

/// Pixels whose scores are computed together, one in each lane of a vector.
const BATCH: usize = 32;

type Lanes = [u8; BATCH];

#[inline(always)]
fn score_row(row: Row<'_>, mask: &[u8], scores: &mut [u8], found: &mut Vec<usize>) {
    let (mut batch, mut count) = ([0; BATCH], 0);
    for (word, bytes) in mask.chunks_exact(8).enumerate() {
        let mut packed = u64::from_le_bytes([
            bytes[0], bytes[1], bytes[2], bytes[3], bytes[4], bytes[5], bytes[6], bytes[7],
        ]);
        while packed != 0 {
            batch[count] = word * 8 + packed.trailing_zeros() as usize / 8;
            packed &= packed - 1;
            count += 1;
            if count == BATCH {
                score_batch(row, &batch, scores, found);
                count = 0;
            }
        }
    }
    score_batch(row, &batch[..count], scores, found);
}

/// The score of a pixel is the greatest t for which nine pixels in a row on the circle differ from it by at least t, all to one
/// side.
#[inline(always)]
fn score_batch(row: Row<'_>, columns: &[usize], scores: &mut [u8], found: &mut Vec<usize>) {
    let (mut ring, mut centre) = ([[0; BATCH]; 16], [0; BATCH]);
    for (lane, &column) in columns.iter().enumerate() {
        let x = row.left + column;
        let line = |k: usize| &row.pixels[k][x - RADIUS..x + RADIUS + 1];
        let (a, b, c, d) = (line(0), line(1), line(2), line(3));
        let (e, f, g) = (line(4), line(5), line(6));
        let circle = [
            a[3], a[4], b[5], c[6], d[6], e[6], f[5], g[4], g[3], g[2], f[1], e[0], d[0], c[0],
            b[1], a[2],
        ];
        for (pixels, pixel) in ring.iter_mut().zip(circle) {
            pixels[lane] = pixel;
        }
        centre[lane] = d[3];
    }
    let (mut bright, mut dark) = ([[0; BATCH]; 16], [[0; BATCH]; 16]);
    for k in 0..16 {
        for i in 0..BATCH {
            bright[k][i] = ring[k][i].saturating_sub(centre[i]);
            dark[k][i] = centre[i].saturating_sub(ring[k][i]);
        }
    }
    let (bright, dark) = (best_arcs(&bright), best_arcs(&dark));
    for (lane, &column) in columns.iter().enumerate() {
        let score = bright[lane].max(dark[lane]);
        if score > row.threshold {
            scores[column + 1] = score;
            found.push(column);
        }
    }
}

/// max over the 16 arcs of the minimum over their nine pixels, by doubling the arc: 1, 2, 4, 8, 9.
#[inline(always)]
fn best_arcs(one: &[Lanes; 16]) -> Lanes {
    let two = lesser(one, one, 1);
    let four = lesser(&two, &two, 2);
    let eight = lesser(&four, &four, 4);
    let nine = lesser(&eight, one, 8);
    let mut best = [0; BATCH];
    for arc in &nine {
        for i in 0..BATCH {
            best[i] = best[i].max(arc[i]);
        }
    }
    best
}

/// For every place of the circle the lesser of it and of that of `other` `turn` places on.
#[inline(always)]
fn lesser(one: &[Lanes; 16], other: &[Lanes; 16], turn: usize) -> [Lanes; 16] {
    let mut least = [[0; BATCH]; 16];
    for k in 0..16 {
        let behind = &other[(k + turn) & 15];
        for i in 0..BATCH {
            least[k][i] = one[k][i].min(behind[i]);
        }
    }
    least
}

fn suppress(
    [above, middle, below]: [&Vec<u8>; 3],
    found: &[usize],
    left: usize,
    y: usize,
    corners: &mut Vec<Corner>,
) {
    for &column in found {
        let score = middle[column + 1];
        let near = column..column + 3;
        let before = above[near.clone()].iter().chain(&middle[column..=column]);
        let behind = below[near].iter().chain(&middle[column + 2..column + 3]);
        if before.copied().all(|other| score > other) && behind.copied().all(|other| score >= other)
        {
            let place = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
            corners.push(Corner {
                x: place(left + column),
                y: place(y),
                score,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;
    use proptest::prelude::*;

    /// The definition, word by word.
    fn is_corner(view: &GrayView<'_>, x: usize, y: usize, threshold: i32) -> bool {
        let centre = i32::from(view.row(y)[x]);
        let sign = |k: usize| {
            let (dx, dy) = CIRCLE[k % 16];
            let value = view.row((y as i32 + dy) as usize)[(x as i32 + dx) as usize];
            let difference = i32::from(value) - centre;
            if difference > threshold {
                1
            } else if difference < -threshold {
                -1
            } else {
                0
            }
        };
        (0..16)
            .any(|start| sign(start) != 0 && (0..9).all(|step| sign(start + step) == sign(start)))
    }

    proptest! {
        #[test]
        fn scores_agree_with_the_definition(pixels in prop::collection::vec(0u8.., 7 * 7)) {
            let image = GrayImage::new(pixels, 7, 7).unwrap();
            let corners = fast_corners(&image.view(), 20, 0);
            prop_assert_eq!(corners.len() == 1, is_corner(&image.view(), 3, 3, 20));
            if let Some(corner) = corners.first() {
                let score = i32::from(corner.score);
                prop_assert!(is_corner(&image.view(), 3, 3, score - 1));
                prop_assert!(!is_corner(&image.view(), 3, 3, score));
            }
        }

        #[test]
        fn every_corner_passes_and_no_two_touch(
            blobs in prop::collection::vec((0usize..40, 0usize..30), 1..30),
        ) {
            let mut image = GrayImage::filled(40, 30, 30);
            for (x, y) in blobs {
                image.pixels_mut()[y * 40 + x] = 200;
            }
            let corners = fast_corners(&image.view(), 20, 3);
            for (i, a) in corners.iter().enumerate() {
                prop_assert!(is_corner(&image.view(), a.x as usize, a.y as usize, 20));
                for b in &corners[..i] {
                    prop_assert!(a.x.abs_diff(b.x) > 1 || a.y.abs_diff(b.y) > 1);
                }
            }
        }
    }

    #[test]
    fn small_and_flat_images_have_none() {
        for (w, h) in [(1, 1), (6, 6), (7, 6), (50, 3)] {
            assert!(fast_corners(&GrayImage::filled(w, h, 9).view(), 0, 3).is_empty());
        }
        for grey in [0, 255] {
            assert!(fast_corners(&GrayImage::filled(64, 48, grey).view(), 0, 3).is_empty());
        }
    }

    #[test]
    fn a_dot_is_one_corner() {
        let mut image = GrayImage::filled(20, 20, 0);
        image.pixels_mut()[10 * 20 + 9] = 255;
        let corners = fast_corners(&image.view(), 20, 3);
        assert_eq!(
            corners,
            [Corner {
                x: 9,
                y: 10,
                score: 255
            }]
        );
    }
}
