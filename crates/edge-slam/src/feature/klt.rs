//! Kanade-Lucas-Tomasi tracking (Lucas & Kanade 1981; pyramid of Bouguet 2001): where a patch went, below a pixel.
//!
//! From the coarsest level down: gradients G of the patch in the first image, H = Σ G Gᵀ, and steps
//! d ← d + H⁻¹ Σ G (I₁ − I₂(d)) until they are small. A point is lost when its patch leaves the image, has no texture
//! in some direction, looks different at the end, or does not come back when tracked backwards.

use crate::image::{GrayView, Pyramid, sample_square};

/// Parameters of [`track_points`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KltConfig {
    /// Pixels from the centre to the side of the square patch, 1..=15. Default 7.
    pub radius: usize,
    /// Most steps a level, >= 1. Default 20.
    pub steps: usize,
    /// A step shorter than this ends a level, pixels. Default 0.02.
    pub precision: f64,
    /// Least eigenvalue of H per patch pixel, squared grey levels per pixel². Default 4.
    pub texture: f64,
    /// Greatest mean absolute difference of the patches, grey levels. Default 12.
    pub difference: f64,
    /// Greatest distance from the start after tracking back, pixels; infinite to leave this out. Default 0.7.
    pub way_back: f64,
}

impl Default for KltConfig {
    fn default() -> Self {
        Self {
            radius: 7,
            steps: 20,
            precision: 0.02,
            texture: 4.0,
            difference: 12.0,
            way_back: 0.7,
        }
    }
}

/// The pyramid that the tracker wants: three levels, each half as large as the one before.
#[must_use]
pub fn klt_pyramid(view: &GrayView<'_>) -> Pyramid {
    Pyramid::new(view, 3, 2.0, 24)
}

/// Where points of the first image are in the second, pixels of the full images; `None` where they were lost.
///
/// `guesses` are places to begin at (predictions), as many as points; missing ones begin where the point was.
/// Pyramids of images of different sizes lose everything. Cost: O(points · patch · steps).
///
/// ```
/// use edge_slam::feature::{KltConfig, klt_pyramid, track_points};
/// use edge_slam::image::GrayImage;
/// let image = |shift: usize| {
///     let mut image = GrayImage::filled(60, 60, 40);
///     for y in 20..35 {
///         image.pixels_mut()[y * 60 + 20 + shift..y * 60 + 35 + shift].fill(200);
///     }
///     klt_pyramid(&image.view())
/// };
/// let found = track_points(&image(0), &image(3), &[[20.0, 20.0], [2.0, 2.0]], &[], &KltConfig::default());
/// assert!(found[0].is_some_and(|[x, y]| (x - 23.0).abs() < 0.1 && (y - 20.0).abs() < 0.1));
/// assert_eq!(found[1], None); // too near to the edge
/// ```
#[must_use]
pub fn track_points(
    first: &Pyramid,
    second: &Pyramid,
    points: &[[f64; 2]],
    guesses: &[[f64; 2]],
    config: &KltConfig,
) -> Vec<Option<[f64; 2]>> {
    let radius = config.radius.clamp(1, 15);
    let config = KltConfig { radius, ..*config };
    let mut patch = Patch::default();
    let track = |(index, &point): (usize, &[f64; 2])| {
        let guess = guesses.get(index).copied().unwrap_or(point);
        let found = patch.follow(first, second, point, guess, &config)?;
        if config.way_back.is_finite() {
            let back = patch.follow(second, first, found, point, &config)?;
            let away = (back[0] - point[0]).hypot(back[1] - point[1]);
            return (away <= config.way_back).then_some(found);
        }
        Some(found)
    };
    points.iter().enumerate().map(track).collect()
}

/// Grey levels and gradients of a patch; buffers are kept from point to point.
#[derive(Debug, Default)]
pub(super) struct Patch {
    grey: Vec<f32>,
    across: Vec<f32>,
    down: Vec<f32>,
    /// One pixel wider, for the gradients; then the patch in the second image.
    wide: Vec<f32>,
}

impl Patch {
    fn follow(
        &mut self,
        first: &Pyramid,
        second: &Pyramid,
        point: [f64; 2],
        guess: [f64; 2],
        config: &KltConfig,
    ) -> Option<[f64; 2]> {
        let same = |level: usize| {
            let [a, b] = [first, second].map(|pyramid| pyramid.levels().get(level));
            a.zip(b)
                .filter(|(a, b)| a.width() == b.width() && a.height() == b.height())
        };
        let levels = first.levels().len().min(second.levels().len());
        let mut shift = [guess[0] - point[0], guess[1] - point[1]];
        for level in (0..levels).rev() {
            let (from, to) = same(level)?;
            let place = first.from_full(level, point);
            let start = first.from_full(level, [point[0] + shift[0], point[1] + shift[1]]);
            // Near the edge a coarse patch does not fit: a finer one may.
            let step = self.align(&from.view(), &to.view(), place, start, config);
            match step {
                Some(end) => {
                    let [x, y] = first.to_full(level, end[0], end[1]);
                    shift = [x - point[0], y - point[1]];
                }
                None if level == 0 => return None,
                None => {}
            }
        }
        Some([point[0] + shift[0], point[1] + shift[1]])
    }

    /// Gauss-Newton on one level; the patch's place in the second image.
    #[inline(always)]
    pub(super) fn align(
        &mut self,
        from: &GrayView<'_>,
        to: &GrayView<'_>,
        place: [f64; 2],
        start: [f64; 2],
        config: &KltConfig,
    ) -> Option<[f64; 2]> {
        let radius = config.radius;
        self.describe(from, place, radius)?;
        let [a, b, c] = self.hessian();
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let count = self.grey.len() as f64;
        let least = 0.5 * (a + c - ((a - c) * (a - c) + 4.0 * b * b).sqrt());
        let determinant = a * c - b * b;
        if !(least >= config.texture * count && determinant > 0.0) {
            return None;
        }
        let mut here = start;
        for _ in 0..config.steps.max(1) {
            sample_square(to, here, radius, &mut self.wide)?;
            let [gx, gy] = self.slope();
            let step = [
                (c * gx - b * gy) / determinant,
                (a * gy - b * gx) / determinant,
            ];
            here = [here[0] + step[0], here[1] + step[1]];
            if step[0].hypot(step[1]) < config.precision {
                break;
            }
        }
        sample_square(to, here, radius, &mut self.wide)?;
        let pairs = self.grey.iter().zip(&self.wide);
        let difference = pairs
            .map(|(old, new)| f64::from((old - new).abs()))
            .sum::<f64>();
        (difference <= config.difference * count).then_some(here)
    }

    #[inline(always)]
    fn describe(&mut self, view: &GrayView<'_>, place: [f64; 2], radius: usize) -> Option<()> {
        sample_square(view, place, radius + 1, &mut self.wide)?;
        let side = 2 * radius + 1;
        let stride = side + 2;
        self.grey.clear();
        self.across.clear();
        self.down.clear();
        let half = |(ahead, behind): (&f32, &f32)| 0.5 * (ahead - behind);
        for row in 1..=side {
            let line = |row: usize| &self.wide[row * stride..(row + 1) * stride];
            let here = line(row);
            self.grey.extend(&here[1..=side]);
            self.across.extend(here[2..].iter().zip(here).map(half));
            let vertical = line(row + 1)[1..=side].iter().zip(&line(row - 1)[1..]);
            self.down.extend(vertical.map(half));
        }
        Some(())
    }

    #[inline(always)]
    fn hessian(&self) -> [f64; 3] {
        let (x, y) = (&self.across, &self.down);
        [(x, x), (x, y), (y, y)].map(|(a, b)| dot(a.iter().copied(), b))
    }

    /// Σ G (I₁ − I₂) for the patch that was sampled last.
    #[inline(always)]
    fn slope(&self) -> [f64; 2] {
        let difference = || self.grey.iter().zip(&self.wide).map(|(old, new)| old - new);
        [&self.across, &self.down].map(|gradient| dot(difference(), gradient))
    }
}

/// Eight partial sums, so that the compiler may add eight products at once.
#[inline(always)]
fn dot(a: impl Iterator<Item = f32>, b: &[f32]) -> f64 {
    let mut lanes = [0.0_f32; 8];
    for (k, (a, b)) in a.zip(b).enumerate() {
        lanes[k % 8] += a * b;
    }
    lanes.iter().map(|&lane| f64::from(lane)).sum()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::image::GrayImage;
    use proptest::prelude::*;

    /// A smooth pattern, moved.
    pub(in crate::feature) fn waves(dx: f64, dy: f64) -> GrayImage {
        let pixel = |i: usize| {
            let (x, y) = ((i % 160) as f64 - dx, (i / 160) as f64 - dy);
            let value =
                128.0 + 60.0 * (0.21 * x + 0.05 * y).sin() + 50.0 * (0.17 * y - 0.04 * x).cos();
            value.round() as u8
        };
        GrayImage::new((0..160 * 120).map(pixel).collect(), 160, 120).unwrap()
    }

    fn track(from: &GrayImage, to: &GrayImage, points: &[[f64; 2]]) -> Vec<Option<[f64; 2]>> {
        let [a, b] = [from, to].map(|image| klt_pyramid(&image.view()));
        track_points(&a, &b, points, &[], &KltConfig::default())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn a_shift_is_found_to_a_twentieth_of_a_pixel(dx in -6.0..6.0f64, dy in -6.0..6.0f64) {
            let points = [[60.0, 50.0], [80.5, 60.25], [100.0, 70.0]];
            for (point, found) in points.iter().zip(track(&waves(0.0, 0.0), &waves(dx, dy), &points)) {
                let [x, y] = found.unwrap();
                prop_assert!((x - point[0] - dx).abs() < 0.05 && (y - point[1] - dy).abs() < 0.05, "{x} {y}");
            }
        }

        #[test]
        fn any_image_and_place_is_fine(
            width in 1usize..60, height in 1usize..60, seed in any::<u8>(),
            x in prop::num::f64::ANY, y in -10.0..70.0f64,
        ) {
            let pixels = (0..width * height).map(|i| (i * 37) as u8 ^ seed).collect();
            let image = GrayImage::new(pixels, width, height).unwrap();
            let other = GrayImage::filled(height, width, seed);
            let points = [[x, y], [y, y], [f64::NAN, 0.0]];
            for to in [&image, &other] {
                prop_assert_eq!(track(&image, to, &points).len(), 3);
            }
        }
    }

    #[test]
    fn gradients_are_those_of_the_pattern() {
        let image = waves(0.0, 0.0);
        let mut patch = Patch::default();
        let centre = [80.3, 60.7];
        patch.describe(&image.view(), centre, 7).unwrap();
        let at = |k: usize| {
            (
                centre[0] + (k % 15) as f64 - 7.0,
                centre[1] + (k / 15) as f64 - 7.0,
            )
        };
        for (k, (across, down)) in patch.across.iter().zip(&patch.down).enumerate() {
            let (x, y) = at(k);
            let (a, b) = (0.21 * x + 0.05 * y, 0.17 * y - 0.04 * x);
            let expected = [
                60.0 * 0.21 * a.cos() + 50.0 * 0.04 * b.sin(),
                60.0 * 0.05 * a.cos() - 50.0 * 0.17 * b.sin(),
            ];
            // Rounded grey levels are off by half a level.
            assert!(
                (f64::from(*across) - expected[0]).abs() < 0.7,
                "{across} {expected:?}"
            );
            assert!(
                (f64::from(*down) - expected[1]).abs() < 0.7,
                "{down} {expected:?}"
            );
        }
    }

    proptest! {
        #[test]
        fn the_first_step_goes_nearly_all_the_way(dx in -0.5..0.5f64, dy in -0.5..0.5f64) {
            let (from, to) = (waves(0.0, 0.0), waves(dx, dy));
            let config = KltConfig { steps: 1, ..KltConfig::default() };
            let place = [80.3, 60.7];
            let found = Patch::default().align(&from.view(), &to.view(), place, place, &config);
            let [x, y] = found.unwrap();
            let left = (x - place[0] - dx).hypot(y - place[1] - dy);
            prop_assert!(left < 0.03 + 0.1 * dx.hypot(dy), "{left}");
        }
    }

    #[test]
    fn flat_and_vanished_patches_are_lost() {
        let flat = GrayImage::filled(160, 120, 90);
        let points = [[80.0, 60.0]];
        assert_eq!(track(&flat, &flat, &points), [None]);
        assert_eq!(track(&waves(0.0, 0.0), &flat, &points), [None]);
        assert_eq!(
            track(&waves(0.0, 0.0), &waves(0.0, 0.0), &[[1.0, 1.0]]),
            [None]
        );
    }
}
