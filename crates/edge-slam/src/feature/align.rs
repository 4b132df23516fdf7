//! Makes matched places agree to a fraction of a pixel: a corner detector puts both on pixels of some pyramid level.
//!
//! Input:   two images, their keypoints and matches.
//! Output:  for every match both places; the second one moved to where the patch of the first one fits best.
//! Method:  Gauss-Newton on the patch at full resolution (Lucas & Kanade 1981), from the keypoint's place. A patch that
//!          leaves the image, has no texture, looks different or ends farther away than the detector's error keeps it.
//! Cost:    O(matches · patch · steps), about 3 µs a match.

use super::klt::Patch;
use super::{Keypoint, KltConfig, Match};
use crate::image::GrayView;
use crate::simd::{Kernel, widest};

/// Parameters of [`align_matches`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlignConfig {
    /// The patch and when its alignment fails; `way_back` is not used. Default: radius 7, texture 1, difference 30,
    /// which ask for less than tracking does, because a descriptor has agreed already.
    pub patch: KltConfig,
    /// Greatest distance from the keypoint, pixels of its pyramid level, > 0. Default 1.5: a corner lies within a
    /// pixel of its level in both images; what moves farther has usually slid along an edge.
    pub max_shift: f64,
    /// Size ratio of neighbouring pyramid levels, >= 1. Default 1.2, as [`super::OrbConfig`].
    pub scale_factor: f64,
}

impl Default for AlignConfig {
    fn default() -> Self {
        Self {
            patch: KltConfig {
                texture: 1.0,
                difference: 30.0,
                way_back: f64::INFINITY,
                ..KltConfig::default()
            },
            max_shift: 1.5,
            scale_factor: 1.2,
        }
    }
}

/// Where a match lies in both images.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlignedMatch {
    /// The first keypoint, pixels of the full image.
    pub first: [f64; 2],
    /// Where the second image shows the same, pixels of the full image.
    pub second: [f64; 2],
    /// Whether the patches were aligned; otherwise `second` is the keypoint's own place.
    pub is_aligned: bool,
}

/// The matches with places that agree to a fraction of a pixel, in their order.
///
/// Matches with an index past the end of its keypoints are left out. Places are pixels of the images as they are: lens
/// distortion is to be taken out afterwards.
///
/// ```
/// use edge_slam::feature::{AlignConfig, Keypoint, Match, align_matches};
/// use edge_slam::image::GrayImage;
/// let image = |shift: usize| {
///     let mut image = GrayImage::filled(60, 60, 40);
///     for y in 20..35 {
///         image.pixels_mut()[y * 60 + 20 + shift..y * 60 + 35 + shift].fill(200);
///     }
///     image
/// };
/// let corner = |x: f32| Keypoint { x, y: 20.0, angle: 0.0, response: 1.0, octave: 0 };
/// let matches = [Match { first: 0, second: 0, distance: 3 }];
/// let (first, second) = (image(0), image(4));
/// // The detector was a pixel off.
/// let keypoints: [&[Keypoint]; 2] = [&[corner(20.0)], &[corner(25.0)]];
/// let found = align_matches([&first.view(), &second.view()], keypoints, &matches, &AlignConfig::default());
/// assert!((found[0].second[0] - 24.0).abs() < 0.05);
/// ```
#[must_use]
pub fn align_matches(
    [first, second]: [&GrayView<'_>; 2],
    keypoints: [&[Keypoint]; 2],
    matches: &[Match],
    config: &AlignConfig,
) -> Vec<AlignedMatch> {
    let patch_config = KltConfig {
        radius: config.patch.radius.clamp(1, 15),
        ..config.patch
    };
    let pairs: Vec<[&Keypoint; 2]> = matches
        .iter()
        .filter_map(|found| {
            Some([
                keypoints[0].get(found.first)?,
                keypoints[1].get(found.second)?,
            ])
        })
        .collect();
    let places = pairs
        .iter()
        .map(|pair| pair.map(|k| [f64::from(k.x), f64::from(k.y)]));
    let mut places: Vec<[[f64; 2]; 2]> = places.collect();
    let mut found = vec![false; pairs.len()];
    widest(AlignPlaces {
        images: [first, second],
        config: &patch_config,
        places: &mut places,
        found: &mut found,
    });
    let keep = |((pair, [from, end]), is_found): ((&[&Keypoint; 2], [[f64; 2]; 2]), bool)| {
        let start = [f64::from(pair[1].x), f64::from(pair[1].y)];
        let octave = i32::from(pair[0].octave.max(pair[1].octave));
        let reach = config.max_shift * config.scale_factor.powi(octave);
        let is_aligned = is_found && (end[0] - start[0]).hypot(end[1] - start[1]) <= reach;
        AlignedMatch {
            first: from,
            second: if is_aligned { end } else { start },
            is_aligned,
        }
    };
    pairs.iter().zip(places).zip(found).map(keep).collect()
}

/// Moves the second places; notes which could be aligned.
struct AlignPlaces<'a> {
    images: [&'a GrayView<'a>; 2],
    config: &'a KltConfig,
    places: &'a mut [[[f64; 2]; 2]],
    found: &'a mut [bool],
}

impl Kernel for AlignPlaces<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            images: [first, second],
            config,
            places,
            found,
        } = self;

        let mut patch = Patch::default();
        for ([from, to], found) in places.iter_mut().zip(found) {
            if let Some(end) = patch.align(first, second, *from, *to, config) {
                (*to, *found) = (end, true);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature::klt::tests::waves;
    use crate::image::GrayImage;
    use proptest::prelude::*;

    fn keypoint(x: f64, y: f64, octave: u8) -> Keypoint {
        Keypoint {
            x: x as f32,
            y: y as f32,
            angle: 0.0,
            response: 1.0,
            octave,
        }
    }

    const MATCH: Match = Match {
        first: 0,
        second: 0,
        distance: 0,
    };

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn a_detector_that_is_a_pixel_off_is_put_right(
            dx in -20.0..20.0f64, dy in -20.0..20.0f64, ex in -1.0..1.0f64, ey in -1.0..1.0f64,
        ) {
            let (a, b) = (waves(0.0, 0.0), waves(dx, dy));
            let keypoints: [&[Keypoint]; 2] =
                [&[keypoint(80.0, 60.0, 0)], &[keypoint(80.0 + dx + ex, 60.0 + dy + ey, 0)]];
            let found = align_matches([&a.view(), &b.view()], keypoints, &[MATCH], &AlignConfig::default());
            let AlignedMatch { second: [x, y], is_aligned, .. } = found[0];
            let is_near = ex.hypot(ey) < 1.4;
            prop_assert!(is_aligned || !is_near);
            if is_aligned {
                prop_assert!((x - 80.0 - dx).abs() < 0.05 && (y - 60.0 - dy).abs() < 0.05, "{x} {y}");
            }
        }

        #[test]
        fn any_image_and_place_is_fine(
            width in 1usize..60, height in 1usize..60, seed in any::<u8>(),
            x in prop::num::f32::ANY, y in -10.0..70.0f32, octave in any::<u8>(), radius in any::<usize>(),
        ) {
            let pixels = (0..width * height).map(|i| (i * 37) as u8 ^ seed).collect();
            let image = GrayImage::new(pixels, width, height).unwrap();
            let other = GrayImage::filled(height, width, seed);
            let point = Keypoint { x, y, angle: 0.0, response: 0.0, octave };
            let mut config = AlignConfig::default();
            config.patch.radius = radius;
            for to in [&image, &other] {
                let views = [&image.view(), &to.view()];
                let past = Match { second: 7, ..MATCH };
                let found = align_matches(views, [&[point], &[point]], &[MATCH, past], &config);
                prop_assert_eq!(found.len(), 1);
            }
        }
    }

    #[test]
    fn a_patch_that_moves_too_far_keeps_its_place() {
        let (a, b) = (waves(0.0, 0.0), waves(3.0, 0.0));
        let places = |octave| {
            [
                [keypoint(80.0, 60.0, octave)],
                [keypoint(80.0, 60.0, octave)],
            ]
        };
        let run = |octave| {
            let [first, second] = places(octave);
            let views = [&a.view(), &b.view()];
            align_matches(views, [&first, &second], &[MATCH], &AlignConfig::default())[0]
        };
        assert!(!run(0).is_aligned && run(0).second == [80.0, 60.0]);
        // A corner of level 4 may be three pixels off.
        assert!(run(4).is_aligned && (run(4).second[0] - 83.0).abs() < 0.05);
    }
}
