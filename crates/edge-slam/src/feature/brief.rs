//! Rotated BRIEF: 256 comparisons of smoothed pixels, the pattern turned by the corner's direction.
//!
//! The published ORB pattern was learnt from photographs. The one here is drawn once from an isotropic Gaussian
//! (Calonder et al. 2010, σ = patch / 5), of which pairs that lie apart are kept; see the README for how the two
//! compare on real images.

use core::f64::consts::TAU;

use crate::image::GrayView;

/// 256 binary comparisons.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Descriptor(pub [u64; 4]);

impl Descriptor {
    /// Number of differing bits, 0..=256.
    #[inline(always)]
    #[must_use]
    pub fn distance(&self, other: &Self) -> u32 {
        let [a, b, c, d] = self.0;
        let [e, f, g, h] = other.0;
        (a ^ e).count_ones() + (b ^ f).count_ones() + (c ^ g).count_ones() + (d ^ h).count_ones()
    }
}

/// Greatest distance of a rotated comparison from the centre, pixels.
pub(super) const PATCH_RADIUS: usize = 16;

const SIDE: usize = 2 * PATCH_RADIUS + 1;
const STRIDE: usize = 64;
/// Directions to which the pattern is rounded: 3 degrees apart.
const DIRECTIONS: usize = 120;
const PAIRS: usize = 256;

/// The pattern at every rounded direction, as indices into a patch of 64 bytes a row.
#[derive(Debug, Clone)]
pub(super) struct RotatedPattern {
    turned: Vec<[[u16; 2]; PAIRS]>,
}

impl RotatedPattern {
    pub(super) fn new() -> Self {
        let pattern = draw_pattern();
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let angle = |direction: usize| direction as f64 * TAU / DIRECTIONS as f64;
        let turn = |direction| pattern.map(|pair| pair.map(|p| patch_index(p, angle(direction))));
        Self {
            turned: (0..DIRECTIONS).map(turn).collect(),
        }
    }

    /// Describes the patch around (x, y) of a smoothed image, which must hold it wholly.
    #[inline(always)]
    pub(super) fn describe(
        &self,
        smooth: &GrayView<'_>,
        x: usize,
        y: usize,
        angle: f32,
    ) -> Descriptor {
        let mut patch = [0_u8; STRIDE * STRIDE];
        let left = x - PATCH_RADIUS;
        for (k, line) in patch.chunks_exact_mut(STRIDE).take(SIDE).enumerate() {
            let row: &[u8] = smooth.row(y + k - PATCH_RADIUS);
            line[..SIDE].copy_from_slice(&row[left..left + SIDE]);
        }
        let pattern = &self.turned[direction_of(angle)];
        let mut bits = [0_u64; 4];
        for (word, pairs) in bits.iter_mut().zip(pattern.chunks_exact(64)) {
            for (bit, [first, second]) in pairs.iter().enumerate() {
                let a = patch[usize::from(*first) % (STRIDE * STRIDE)];
                let b = patch[usize::from(*second) % (STRIDE * STRIDE)];
                *word |= u64::from(a < b) << bit;
            }
        }
        Descriptor(bits)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "0..120 after the remainder"
)]
fn direction_of(angle: f32) -> usize {
    let turns = f64::from(angle) / TAU;
    let rounded = (turns * DIRECTIONS as f64)
        .round()
        .rem_euclid(DIRECTIONS as f64);
    (rounded as usize).min(DIRECTIONS - 1)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "within the patch"
)]
fn patch_index([x, y]: [f64; 2], angle: f64) -> u16 {
    let (sin, cos) = angle.sin_cos();
    let radius = 16.0;
    let column = (cos * x - sin * y).round() + radius;
    let row = (sin * x + cos * y).round() + radius;
    row as u16 * 64 + column as u16
}

/// 256 pairs of places within 15 pixels of the centre.
fn draw_pattern() -> [[[f64; 2]; 2]; PAIRS] {
    let mut random = SplitMix(0x5EED_0B1E_F000_0001);
    core::array::from_fn(|_| {
        loop {
            let pair = [random.place(), random.place()];
            let [[a, b], [c, d]] = pair;
            if (a - c).hypot(b - d) >= 2.0 {
                return pair;
            }
        }
    })
}

/// The generator of Steele, Lea & Flood (2014): the pattern must never change with a library's version.
struct SplitMix(u64);

impl SplitMix {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
        let unit = (z >> 11) as f64 / (1_u64 << 53) as f64;
        unit
    }

    /// A Gaussian place, σ = 31 / 5 pixels, redrawn outside the disc. Sum of uniforms: exact on every machine.
    fn place(&mut self) -> [f64; 2] {
        loop {
            let mut normal = || (0..12).map(|_| self.unit()).sum::<f64>() - 6.0;
            let place = [(normal() * 6.2).round(), (normal() * 6.2).round()];
            if place[0] * place[0] + place[1] * place[1] <= 225.0 {
                return place;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::GrayImage;
    use proptest::prelude::*;

    #[test]
    fn every_direction_stays_in_the_patch() {
        let pattern = RotatedPattern::new();
        for pair in pattern.turned.iter().flatten().flatten() {
            assert!(usize::from(*pair) % STRIDE < SIDE && usize::from(*pair) / STRIDE < SIDE);
        }
    }

    #[test]
    fn angles_wrap() {
        assert_eq!(direction_of(0.0), 0);
        assert_eq!(direction_of(core::f32::consts::PI), 60);
        assert_eq!(direction_of(-core::f32::consts::PI), 60);
        assert_eq!(direction_of(-0.001), 0);
        assert_eq!(direction_of(f32::NAN), 0);
    }

    #[test]
    fn a_quarter_turn_of_image_and_angle_changes_nothing() {
        let random = &mut SplitMix(3);
        let pixels: Vec<u8> = (0..33 * 33)
            .map(|_| (random.unit() * 256.0) as u8)
            .collect();
        let turned = (0..33 * 33)
            .map(|i| pixels[(32 - i % 33) * 33 + i / 33])
            .collect();
        let upright = GrayImage::new(pixels.clone(), 33, 33).unwrap();
        let turned = GrayImage::new(turned, 33, 33).unwrap();
        let pattern = RotatedPattern::new();
        let a = pattern.describe(&upright.view(), 16, 16, 0.3);
        let b = pattern.describe(&turned.view(), 16, 16, 0.3 + core::f32::consts::FRAC_PI_2);
        assert!(a.distance(&b) <= 4, "{}", a.distance(&b));
        assert!(
            a.0.iter()
                .map(|w| w.count_ones())
                .sum::<u32>()
                .abs_diff(128)
                < 40
        );
    }

    proptest! {
        #[test]
        fn distance_is_a_metric(a in any::<[u64; 4]>(), b in any::<[u64; 4]>(), c in any::<[u64; 4]>()) {
            let (a, b, c) = (Descriptor(a), Descriptor(b), Descriptor(c));
            prop_assert_eq!(a.distance(&a), 0);
            prop_assert_eq!(a.distance(&b), b.distance(&a));
            prop_assert!(a.distance(&c) <= a.distance(&b) + b.distance(&c));
        }
    }
}
