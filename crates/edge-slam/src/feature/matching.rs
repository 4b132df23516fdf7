//! Nearest descriptors by Hamming distance, over all candidates or near a predicted place.

use super::{Descriptor, Keypoint};
use crate::simd::{Kernel, widest};

/// A pair of descriptors that look alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Match {
    /// Index into the first slice.
    pub first: usize,
    /// Index into the second slice.
    pub second: usize,
    /// Differing bits.
    pub distance: u32,
}

/// Which nearest neighbours count as matches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatchConfig {
    /// Greatest distance, bits, 0..=256. Default 64.
    pub max_distance: u32,
    /// The nearest must be less than this times as far as the second nearest, 0..=1; 1 accepts all but
    /// ties. Default 0.8 (Lowe 2004).
    pub ratio: f64,
    /// Whether the nearest of the nearest must be the start again. Default true.
    pub mutual: bool,
}

impl Default for MatchConfig {
    fn default() -> Self {
        Self {
            max_distance: 64,
            ratio: 0.8,
            mutual: true,
        }
    }
}

/// For each descriptor of `first` its nearest in `second`, where that is a match; ascending by `first`.
///
/// Ties in distance go to the lower index (and fail any ratio below 1). Empty slices give no match.
/// Cost: O(n m), about 1 ns per pair.
#[must_use]
pub fn match_descriptors(
    first: &[Descriptor],
    second: &[Descriptor],
    config: &MatchConfig,
) -> Vec<Match> {
    let mut reverse = vec![Nearest::default(); second.len()];
    let mut forward = vec![Nearest::default(); first.len()];
    widest(Compare {
        first,
        second,
        forward: &mut forward,
        reverse: &mut reverse,
    });
    let accepted = forward.iter().enumerate().filter_map(|(index, nearest)| {
        let found = nearest.accept(index, config)?;
        (!config.mutual || reverse[found.second].index == index).then_some(found)
    });
    accepted.collect()
}

/// Offers every pair to both of its descriptors.
struct Compare<'a> {
    first: &'a [Descriptor],
    second: &'a [Descriptor],
    forward: &'a mut [Nearest],
    reverse: &'a mut [Nearest],
}

impl Kernel for Compare<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            first,
            second,
            forward,
            reverse,
        } = self;

        for (index, (query, best)) in first.iter().zip(forward).enumerate() {
            for (other, (candidate, back)) in second.iter().zip(&mut *reverse).enumerate() {
                let distance = query.distance(candidate);
                best.offer(other, distance);
                back.offer(index, distance);
            }
        }
    }
}

/// How predicted places restrict matching.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GuidedConfig {
    /// Radius around the predicted place, pixels at level 0, > 0. Default 15.
    pub radius: f64,
    /// Greatest difference of pyramid levels. Default 1.
    pub octaves: u8,
    /// Which of the near ones count.
    pub descriptor: MatchConfig,
}

impl Default for GuidedConfig {
    fn default() -> Self {
        let descriptor = MatchConfig {
            ratio: 0.9,
            ..MatchConfig::default()
        };
        Self {
            radius: 15.0,
            octaves: 1,
            descriptor,
        }
    }
}

/// A descriptor and where it should be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// What to look for.
    pub descriptor: Descriptor,
    /// Where, pixels of the full image.
    pub place: [f64; 2],
    /// Expected pyramid level.
    pub octave: u8,
}

/// Matches predictions only with keypoints near their places (a map projected into a frame).
///
/// Two predictions may claim one keypoint only when `mutual` is off; the nearer one keeps it else, the lower
/// index on a tie. Predictions at places that are not finite match nothing. Cost: O(n k) with k keypoints of a
/// radius' neighbourhood (a grid of cells of that size).
#[must_use]
pub fn match_guided(
    predictions: &[Prediction],
    keypoints: &[Keypoint],
    descriptors: &[Descriptor],
    config: &GuidedConfig,
) -> Vec<Match> {
    let grid = KeypointGrid::new(keypoints, config.radius);
    let mut owner: Vec<Option<Match>> = vec![None; keypoints.len().min(descriptors.len())];
    let mut free = Vec::new();
    for (index, prediction) in predictions.iter().enumerate() {
        let mut nearest = Nearest::default();
        grid.visit(prediction.place, |other| {
            let (Some(keypoint), Some(descriptor)) = (keypoints.get(other), descriptors.get(other))
            else {
                return;
            };
            let shift = (f64::from(keypoint.x) - prediction.place[0])
                .hypot(f64::from(keypoint.y) - prediction.place[1]);
            let level = keypoint.octave.abs_diff(prediction.octave);
            if shift <= config.radius && level <= config.octaves {
                nearest.offer(other, prediction.descriptor.distance(descriptor));
            }
        });
        let Some(found) = nearest.accept(index, &config.descriptor) else {
            continue;
        };
        if config.descriptor.mutual {
            let slot = &mut owner[found.second];
            if slot.is_none_or(|other| found.distance < other.distance) {
                *slot = Some(found);
            }
        } else {
            free.push(found);
        }
    }
    free.extend(owner.into_iter().flatten());
    free.sort_unstable_by_key(|found| found.first);
    free
}

#[derive(Debug, Clone, Copy)]
struct Nearest {
    index: usize,
    distance: u32,
    second: u32,
}

impl Default for Nearest {
    fn default() -> Self {
        Self {
            index: usize::MAX,
            distance: u32::MAX,
            second: u32::MAX,
        }
    }
}

impl Nearest {
    #[inline(always)]
    fn offer(&mut self, index: usize, distance: u32) {
        if distance < self.distance {
            self.second = self.distance;
            self.distance = distance;
            self.index = index;
        } else if distance < self.second {
            self.second = distance;
        }
    }

    fn accept(&self, first: usize, config: &MatchConfig) -> Option<Match> {
        let near = self.index != usize::MAX && self.distance <= config.max_distance;
        let clear = self.second == u32::MAX
            || f64::from(self.distance) < config.ratio * f64::from(self.second);
        (near && clear).then_some(Match {
            first,
            second: self.index,
            distance: self.distance,
        })
    }
}

/// Keypoints by square cells, so that a circle needs a look at nine of them.
struct KeypointGrid {
    cell: f64,
    columns: usize,
    rows: usize,
    members: Vec<Vec<usize>>,
}

impl KeypointGrid {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped first"
    )]
    fn new(keypoints: &[Keypoint], radius: f64) -> Self {
        let usable = |k: &&Keypoint| k.x >= 0.0 && k.y >= 0.0 && k.x < 65_536.0 && k.y < 65_536.0;
        let greatest = |value: fn(&Keypoint) -> f32| {
            keypoints
                .iter()
                .filter(usable)
                .map(value)
                .fold(0.0_f32, f32::max)
        };
        let (right, bottom) = (f64::from(greatest(|k| k.x)), f64::from(greatest(|k| k.y)));
        let cell = if radius >= 4.0 { radius.min(1e6) } else { 4.0 };
        let (columns, rows) = ((right / cell) as usize + 1, (bottom / cell) as usize + 1);
        let mut members = vec![Vec::new(); columns * rows];
        for (index, keypoint) in keypoints.iter().enumerate().filter(|(_, k)| usable(k)) {
            let (column, row) = (f64::from(keypoint.x) / cell, f64::from(keypoint.y) / cell);
            members[row as usize * columns + column as usize].push(index);
        }
        Self {
            cell,
            columns,
            rows,
            members,
        }
    }

    /// Calls `visit` with ascending indices per cell for all cells that touch the circle.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "the range is checked first"
    )]
    fn visit(&self, [x, y]: [f64; 2], mut visit: impl FnMut(usize)) {
        let (column, row) = ((x / self.cell).floor(), (y / self.cell).floor());
        let inside = column >= -1.0
            && row >= -1.0
            && column <= self.columns as f64
            && row <= self.rows as f64;
        if !inside {
            return;
        }
        let span = |centre: f64, count: usize| {
            (centre - 1.0).max(0.0) as usize..((centre + 2.0).max(0.0) as usize).min(count)
        };
        for row in span(row, self.rows) {
            for column in span(column, self.columns) {
                self.members[row * self.columns + column]
                    .iter()
                    .for_each(|&index| visit(index));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn descriptors(max: usize) -> impl Strategy<Value = Vec<Descriptor>> {
        prop::collection::vec(any::<[u64; 4]>().prop_map(Descriptor), 0..max)
    }

    proptest! {
        #[test]
        fn agrees_with_brute_force(a in descriptors(12), b in descriptors(12)) {
            let config = MatchConfig { max_distance: 128, ratio: 0.99, mutual: true };
            let mut expected = Vec::new();
            for (i, x) in a.iter().enumerate() {
                let mut order: Vec<usize> = (0..b.len()).collect();
                order.sort_by_key(|&j| (x.distance(&b[j]), j));
                let Some(&j) = order.first() else { continue };
                let distance = x.distance(&b[j]);
                let clear = order.get(1).is_none_or(|&k| {
                    f64::from(distance) < 0.99 * f64::from(x.distance(&b[k]))
                });
                let back = (0..a.len()).min_by_key(|&k| (a[k].distance(&b[j]), k));
                if clear && distance <= 128 && back == Some(i) {
                    expected.push(Match { first: i, second: j, distance });
                }
            }
            prop_assert_eq!(match_descriptors(&a, &b, &config), expected);
        }

        #[test]
        fn guidance_by_a_huge_radius_is_plain_matching(a in descriptors(9), b in descriptors(9)) {
            let keypoint = |i: usize| Keypoint { x: i as f32 * 9.0, y: 3.0, angle: 0.0, response: 1.0, octave: 0 };
            let keypoints: Vec<_> = (0..b.len()).map(keypoint).collect();
            let predictions: Vec<_> = a.iter().map(|&descriptor| {
                Prediction { descriptor, place: [20.0, 3.0], octave: 0 }
            }).collect();
            let descriptor = MatchConfig { max_distance: 256, ratio: 1.0, mutual: false };
            let config = GuidedConfig { radius: 1e4, octaves: 1, descriptor };
            prop_assert_eq!(
                match_guided(&predictions, &keypoints, &b, &config),
                match_descriptors(&a, &b, &descriptor)
            );
        }
    }

    #[test]
    fn far_keypoints_are_not_seen() {
        let at = |x: f32| Keypoint {
            x,
            y: 10.0,
            angle: 0.0,
            response: 1.0,
            octave: 0,
        };
        let keypoints = [at(10.0), at(60.0)];
        let descriptors = [Descriptor([0; 4]), Descriptor([1; 4])];
        let prediction = |x| Prediction {
            descriptor: Descriptor([1; 4]),
            place: [x, 10.0],
            octave: 0,
        };
        let config = GuidedConfig::default();
        let near = |x| match_guided(&[prediction(x)], &keypoints, &descriptors, &config);
        assert_eq!(near(20.0)[0].second, 0);
        assert_eq!(near(50.0)[0].second, 1);
        assert!(near(35.0).is_empty() && near(f64::NAN).is_empty() && near(-1e300).is_empty());
    }
}
