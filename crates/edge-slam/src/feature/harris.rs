//! The Harris response (Harris & Stephens 1988) at single pixels, which ranks FAST corners as ORB does.
//!
//! ```text
//! R = det M − 0.04 (tr M)²     M = Σ over 7x7 of ∇I ∇Iᵀ, ∇I by Sobel in grey levels per pixel
//! ```

use crate::image::GrayView;

/// Pixels around the corner that are read.
pub(super) const HARRIS_RADIUS: usize = 4;

const BLOCK: usize = 7;
const SIDE: usize = 2 * HARRIS_RADIUS + 1;

/// R at (x, y), at least [`HARRIS_RADIUS`] pixels inside the image; 1 means one grey level per pixel, squared twice.
#[inline(always)]
pub(super) fn harris(view: &GrayView<'_>, x: usize, y: usize) -> f32 {
    let mut patch = [[0_i32; SIDE]; SIDE];
    for (k, line) in patch.iter_mut().enumerate() {
        let row = &view.row(y + k - HARRIS_RADIUS)[x - HARRIS_RADIUS..=x + HARRIS_RADIUS];
        for (to, &from) in line.iter_mut().zip(row) {
            *to = i32::from(from);
        }
    }
    let (mut xx, mut xy, mut yy) = ([0_i32; BLOCK], [0_i32; BLOCK], [0_i32; BLOCK]);
    for k in 0..BLOCK {
        let [a, b, c] = [&patch[k], &patch[k + 1], &patch[k + 2]];
        for i in 0..BLOCK {
            let across = (a[i + 2] - a[i]) + 2 * (b[i + 2] - b[i]) + (c[i + 2] - c[i]);
            let down = (c[i] - a[i]) + 2 * (c[i + 1] - a[i + 1]) + (c[i + 2] - a[i + 2]);
            xx[i] += across * across;
            xy[i] += across * down;
            yy[i] += down * down;
        }
    }
    // Sobel weighs by 8; M is the mean over the block.
    #[expect(clippy::cast_precision_loss, reason = "sums stay below 2^27")]
    let mean = |sums: [i32; BLOCK]| sums.iter().sum::<i32>() as f32 / (64.0 * 49.0);
    let (a, b, c) = (mean(xx), mean(xy), mean(yy));
    a * c - b * b - 0.04 * (a + c) * (a + c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;

    fn image(bright: impl Fn(usize, usize) -> bool) -> GrayImage {
        let pixels = (0..81).map(|i| if bright(i % 9, i / 9) { 200 } else { 50 });
        GrayImage::new(pixels.collect(), 9, 9).unwrap()
    }

    #[test]
    fn corners_beat_flats_and_edges_lose() {
        let at = |image: GrayImage| harris(&image.view(), 4, 4);
        let corner = at(image(|x, y| x > 4 && y > 4));
        assert_eq!(at(image(|_, _| true)), 0.0);
        assert!(at(image(|x, _| x > 4)) < 0.0);
        assert!(corner > 1e4);
    }
}
