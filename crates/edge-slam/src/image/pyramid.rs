//! An image at falling sizes.

use super::{GrayImage, GrayView, resize};

/// Levels of an image, each smaller than the one before by the same factor, none under one pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Pyramid {
    levels: Vec<GrayImage>,
    scales: Vec<[f64; 2]>,
}

impl Pyramid {
    /// `count` levels (at least 1, the image itself), each `factor` times smaller than the one before.
    ///
    /// Levels with a side under `smallest_side` pixels are left out, and factors under 1.01 (or NaN) give one
    /// level. Cost: O(pixels).
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "sides of images are small"
    )]
    pub fn new(view: &GrayView<'_>, count: usize, factor: f64, smallest_side: usize) -> Self {
        let mut pyramid = Self {
            levels: vec![GrayImage::from(*view)],
            scales: vec![[1.0, 1.0]],
        };
        let mut scale = 1.0;
        for level in 1..count {
            scale *= factor;
            let side = |full: usize| (full as f64 / scale).round() as usize;
            let (width, height) = (side(view.width()), side(view.height()));
            if !(factor >= 1.01) || width.min(height) < smallest_side.max(1) {
                break;
            }
            let smaller = resize(&pyramid.levels[level - 1].view(), width, height);
            pyramid.levels.push(smaller);
            pyramid.scales.push([
                view.width() as f64 / width as f64,
                view.height() as f64 / height as f64,
            ]);
        }
        pyramid
    }

    /// The levels, greatest first; never empty.
    #[must_use]
    pub fn levels(&self) -> &[GrayImage] {
        &self.levels
    }

    /// A place on a level, in pixels of the full image. Levels past the last count as the last.
    #[must_use]
    pub fn to_full(&self, level: usize, x: f64, y: f64) -> [f64; 2] {
        let [sx, sy] = self.scales[level.min(self.scales.len() - 1)];
        [(x + 0.5) * sx - 0.5, (y + 0.5) * sy - 0.5]
    }

    /// A place of the full image, in pixels of a level. Levels past the last count as the last.
    #[must_use]
    pub fn from_full(&self, level: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let [sx, sy] = self.scales[level.min(self.scales.len() - 1)];
        [(x + 0.5) / sx - 0.5, (y + 0.5) / sy - 0.5]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_shrink_and_stop() {
        let image = GrayImage::filled(100, 60, 7);
        let pyramid = Pyramid::new(&image.view(), 50, 1.2, 20);
        let last = pyramid.levels().last().unwrap();
        assert!(last.height() >= 20 && last.height() < 24);
        assert!(last.pixels().iter().all(|&p| p == 7));
        assert_eq!(
            Pyramid::new(&image.view(), 8, f64::NAN, 1).levels().len(),
            1
        );
        assert_eq!(
            Pyramid::new(&GrayImage::filled(1, 1, 0).view(), 8, 1.2, 1)
                .levels()
                .len(),
            4
        );
    }

    #[test]
    fn a_ramp_keeps_its_place() {
        let pixels = (0..64 * 8).map(|i| ((i % 64) * 4) as u8).collect();
        let image = GrayImage::new(pixels, 64, 8).unwrap();
        let pyramid = Pyramid::new(&image.view(), 3, 1.2, 1);
        let level = &pyramid.levels()[2];
        let [x, _] = pyramid.to_full(2, 10.0, 2.0);
        assert!((f64::from(level.view().row(2)[10]) - 4.0 * x).abs() < 2.0);
    }
}
