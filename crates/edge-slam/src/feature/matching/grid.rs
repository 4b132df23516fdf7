//! Hamming matching near predicted places: a grid of keypoints, so that a prediction looks at few of them.

use super::{Match, MatchConfig, Nearest};
use crate::feature::{Descriptor, Keypoint};

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
    use crate::feature::match_descriptors;
    use crate::feature::matching::descriptors;
    use proptest::prelude::*;

    proptest! {
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
