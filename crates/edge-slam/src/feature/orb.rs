//! ORB (Rublee et al. 2011): oriented FAST corners and rotated BRIEF over a pyramid.
//!
//! 1. Pyramid of `levels` images, each `scale_factor` smaller.
//! 2. FAST per level; for an even spread, cells without a corner are searched again with the low threshold.
//! 3. Each level keeps its share of the features, proportional to its side: the strongest, or as [`Selection`] says.
//! 4. Direction from the intensity centroid; descriptor on the level smoothed with σ = 2.

use super::brief::{PATCH_RADIUS, RotatedPattern};
use super::fast::{Region, detect};
use super::harris::harris;
use super::orientation::{DISC_RADIUS, Orientation};
use super::{
    Corner, Descriptor, OrbConfig, OrbConfigError, Selection, balanced_corners, spread_corners,
};
use crate::image::{GrayImage, GrayView, Pyramid, smooth_with, weights};
use crate::simd::{Kernel, widest};

/// A corner of some pyramid level, in pixels of the full image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Keypoint {
    /// Column in the full image, pixels.
    pub x: f32,
    /// Row in the full image, pixels.
    pub y: f32,
    /// Direction, radians in (−π, π], from +x towards +y.
    pub angle: f32,
    /// Harris response; only ranks the features of one image.
    pub response: f32,
    /// Pyramid level, 0 the full image. The position is good to about `scale_factor^octave` pixels.
    pub octave: u8,
}

/// Keypoints and their descriptors, index by index.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// Where; by level, then in reading order.
    pub keypoints: Vec<Keypoint>,
    /// What it looks like; as many as keypoints.
    pub descriptors: Vec<Descriptor>,
}

/// Finds ORB features. Holds the rotated pattern, so build it once.
///
/// ```
/// use edge_slam::feature::{OrbConfig, OrbExtractor};
/// use edge_slam::image::GrayImage;
/// let mut image = GrayImage::filled(120, 90, 40);
/// for y in 30..50 {
///     for x in 40..70 {
///         image.pixels_mut()[y * 120 + x] = 200;
///     }
/// }
/// let features = OrbExtractor::new(OrbConfig::default())?.extract(&image.view());
/// assert!(features.keypoints.len() >= 4);
/// # Ok::<(), edge_slam::feature::OrbConfigError>(())
/// ```
#[derive(Debug, Clone)]
pub struct OrbExtractor {
    config: OrbConfig,
    pattern: RotatedPattern,
}

/// A corner and its Harris response.
type Ranked = (Corner, f32);

/// Distance from the image's edge within which nothing is described, pixels of the level.
const BORDER: usize = if PATCH_RADIUS > DISC_RADIUS {
    PATCH_RADIUS
} else {
    DISC_RADIUS
};

impl OrbExtractor {
    /// An extractor with these parameters.
    ///
    /// # Errors
    /// [`OrbConfigError`] when a field is outside its range.
    pub fn new(config: OrbConfig) -> Result<Self, OrbConfigError> {
        config.validate()?;
        Ok(Self {
            config,
            pattern: RotatedPattern::new(),
        })
    }

    /// The features of an image. Images with a side under 33 pixels, and flat ones, have none.
    /// Cost: O(pixels + features).
    #[must_use]
    pub fn extract(&self, view: &GrayView<'_>) -> Features {
        let smallest = 2 * BORDER + 1;
        let pyramid = Pyramid::new(view, self.config.levels, self.config.scale_factor, smallest);
        let shares = self.shares(pyramid.levels().len());
        let kernel = weights(2.0, 3);
        let mut features = Features::default();
        let mut line = Vec::new();
        for (level, (image, share)) in pyramid.levels().iter().zip(shares).enumerate() {
            let corners = self.corners(&image.view());
            let chosen = self.choose(&image.view(), corners, share);
            let mut smooth = GrayImage::filled(image.width(), image.height(), 0);
            smooth_with(&image.view(), &kernel, &mut line, &mut smooth);
            self.describe(&pyramid, level, &smooth.view(), &chosen, &mut features);
        }
        features
    }

    /// How many features each level gives, in proportion to its side.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "at most 100 000 features"
    )]
    fn shares(&self, levels: usize) -> Vec<usize> {
        let weight: Vec<f64> =
            core::iter::successors(Some(1.0), |w| Some(w / self.config.scale_factor))
                .take(levels)
                .collect();
        let total: f64 = weight.iter().sum();
        let mut given = 0;
        let mut before = 0.0;
        let share = |w: &f64| {
            before += w;
            let until = (self.config.features as f64 * before / total).round() as usize;
            let share = until - given;
            given = until;
            share
        };
        weight.iter().map(share).collect()
    }

    fn corners(&self, view: &GrayView<'_>) -> Vec<Corner> {
        let inner = |side: usize| BORDER..side.saturating_sub(BORDER).max(BORDER);
        let (columns, rows) = (inner(view.width()), inner(view.height()));
        let whole = Region {
            left: columns.start,
            top: rows.start,
            right: columns.end,
            bottom: rows.end,
        };
        let mut corners = Vec::new();
        detect(view, whole, self.config.threshold, &mut corners);
        let spread = self.config.selection == Selection::Spread;
        if spread && self.config.low_threshold < self.config.threshold {
            self.fill_empty_cells(view, whole, &mut corners);
        }
        corners
    }

    /// At most `share` of the corners, in reading order of their detection, with their Harris responses.
    fn choose(&self, view: &GrayView<'_>, mut corners: Vec<Corner>, share: usize) -> Vec<Ranked> {
        if self.config.selection == Selection::Strongest && corners.len() > 2 * share {
            corners.sort_by_key(|corner| core::cmp::Reverse(corner.score));
            corners.truncate(2 * share);
            corners.sort_by_key(|corner| (corner.y, corner.x));
        }
        let mut responses = vec![0.0; corners.len()];
        widest(Rank {
            view,
            corners: &corners,
            responses: &mut responses,
        });
        let chosen = match self.config.selection {
            Selection::Strongest => strongest(&responses, share),
            Selection::Balanced => {
                let size = [view.width(), view.height()];
                balanced_corners(&corners, &responses, share, size)
            }
            Selection::Spread => spread_corners(&corners, &responses, share),
        };
        chosen
            .into_iter()
            .map(|index| (corners[index], responses[index]))
            .collect()
    }

    fn fill_empty_cells(&self, view: &GrayView<'_>, whole: Region, corners: &mut Vec<Corner>) {
        let cell = self.config.cell;
        let columns = (whole.right - whole.left).div_ceil(cell).max(1);
        let rows = (whole.bottom - whole.top).div_ceil(cell);
        let mut filled = vec![false; columns * rows];
        for corner in corners.iter() {
            let (x, y) = (
                corner.x as usize - whole.left,
                corner.y as usize - whole.top,
            );
            filled[y / cell * columns + x / cell] = true;
        }
        for index in (0..filled.len()).filter(|&index| !filled[index]) {
            let left = whole.left + index % columns * cell;
            let top = whole.top + index / columns * cell;
            let region = Region {
                left,
                top,
                right: (left + cell).min(whole.right),
                bottom: (top + cell).min(whole.bottom),
            };
            detect(view, region, self.config.low_threshold, corners);
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "pixel coordinates and at most 16 levels"
    )]
    fn describe(
        &self,
        pyramid: &Pyramid,
        level: usize,
        smooth: &GrayView<'_>,
        corners: &[Ranked],
        features: &mut Features,
    ) {
        let sharp = pyramid.levels()[level].view();
        for &(corner, response) in corners {
            let (x, y) = (corner.x as usize, corner.y as usize);
            let angle = widest(Orientation { view: &sharp, x, y });
            let [full_x, full_y] = pyramid.to_full(level, f64::from(corner.x), f64::from(corner.y));
            features.keypoints.push(Keypoint {
                x: full_x as f32,
                y: full_y as f32,
                angle,
                response,
                octave: level as u8,
            });
            features
                .descriptors
                .push(self.pattern.describe(smooth, x, y, angle));
        }
    }
}

struct Rank<'a> {
    view: &'a GrayView<'a>,
    corners: &'a [Corner],
    responses: &'a mut [f32],
}

impl Kernel for Rank<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            view,
            corners,
            responses,
        } = self;

        for (corner, response) in corners.iter().zip(responses) {
            *response = harris(view, corner.x as usize, corner.y as usize);
        }
    }
}

/// Indices of the `count` greatest responses, ascending.
fn strongest(responses: &[f32], count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..responses.len()).collect();
    order.sort_by(|&a, &b| responses[b].total_cmp(&responses[a]));
    order.truncate(count);
    order.sort_unstable();
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::gaussian_blur;
    use proptest::prelude::*;

    /// Smoothed noise: corners everywhere.
    fn texture(width: usize, height: usize, seed: u64) -> GrayImage {
        let mut state = seed;
        let pixels = (0..width * height).map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            if state >> 63 == 0 { 20 } else { 235 }
        });
        let noise = GrayImage::new(pixels.collect(), width, height).unwrap();
        gaussian_blur(&noise.view(), 1.5, 3)
    }

    #[test]
    fn gives_the_wanted_number_on_texture() {
        let image = texture(320, 240, 1);
        let config = OrbConfig {
            features: 400,
            ..Default::default()
        };
        let features = OrbExtractor::new(config).unwrap().extract(&image.view());
        assert_eq!(features.keypoints.len(), 400);
        assert_eq!(features.descriptors.len(), 400);
        let octaves = features.keypoints.iter().map(|k| k.octave).max();
        assert_eq!(octaves, Some(7));
    }

    #[test]
    fn a_shift_keeps_descriptors() {
        let image = texture(200, 200, 2);
        let moved = GrayView::with_stride(&image.pixels()[7 * 200 + 5..], 190, 190, 200).unwrap();
        let extractor = OrbExtractor::new(OrbConfig {
            features: 2000,
            levels: 1,
            ..Default::default()
        })
        .unwrap();
        let (a, b) = (extractor.extract(&image.view()), extractor.extract(&moved));
        let same = b.keypoints.iter().zip(&b.descriptors).filter(|(k, d)| {
            let at = |o: &Keypoint| o.x == k.x + 5.0 && o.y == k.y + 7.0;
            let twin = a.keypoints.iter().position(at);
            twin.is_some_and(|index| a.descriptors[index].distance(d) <= 8)
        });
        assert!(same.count() * 10 > b.keypoints.len() * 9);
    }

    #[test]
    fn bad_parameters_are_refused() {
        for config in [
            OrbConfig {
                features: 0,
                ..Default::default()
            },
            OrbConfig {
                scale_factor: f64::NAN,
                ..Default::default()
            },
            OrbConfig {
                low_threshold: 21,
                ..Default::default()
            },
        ] {
            assert!(OrbExtractor::new(config).is_err());
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn any_image_is_fine(width in 1usize..90, height in 1usize..90, seed in any::<u64>(), grey in any::<Option<u8>>()) {
            let image = grey.map_or_else(|| texture(width, height, seed), |g| GrayImage::filled(width, height, g));
            let features = OrbExtractor::new(OrbConfig::default()).unwrap().extract(&image.view());
            for keypoint in &features.keypoints {
                prop_assert!(keypoint.x >= 0.0 && keypoint.x < width as f32);
                prop_assert!(keypoint.y >= 0.0 && keypoint.y < height as f32);
            }
        }
    }
}
