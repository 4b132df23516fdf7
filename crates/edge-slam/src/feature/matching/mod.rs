//! Nearest descriptors by Hamming distance, where they count as matches.
//!
//! Every search takes two sides and a [`MatchConfig`] and gives [`Match`]es, ascending by `first`:
//!
//! | function | what it compares | against all pairs |
//! | --- | --- | --- |
//! | [`match_descriptors`] | all pairs | the same |
//! | [`match_guided`] | keypoints near predicted places (a grid) | fewer candidates: other ratios |
//! | [`match_by_node`] | descriptors of the same node of a [`Vocabulary`] | loses what fell into another node |
//! | [`match_indexed`] | what shares a piece of its bits ([`MultiIndex`]) | the same |

mod all_pairs;
mod bag_of_words;
mod direct_index;
mod grid;
mod k_majority;
mod multi_index;
mod vocabulary;

pub use all_pairs::match_descriptors;
pub use bag_of_words::BagOfWords;
pub use direct_index::{DirectIndex, match_by_node};
pub use grid::{GuidedConfig, Prediction, match_guided};
pub use multi_index::{MultiIndex, match_indexed};
pub use vocabulary::{Vocabulary, VocabularyConfig, VocabularyError};

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

    /// The same as [`Self::offer`] for candidates that do not come by ascending index.
    fn offer_unordered(&mut self, index: usize, distance: u32) {
        if (distance, index) < (self.distance, self.index) {
            self.second = self.distance;
            self.distance = distance;
            self.index = index;
        } else {
            self.second = self.second.min(distance);
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

/// Up to `max` descriptors of any bits, for the tests of the searches.
#[cfg(test)]
fn descriptors(
    max: usize,
) -> impl proptest::strategy::Strategy<Value = Vec<crate::feature::Descriptor>> {
    use proptest::prelude::*;
    let descriptor = any::<[u64; 4]>().prop_map(crate::feature::Descriptor);
    prop::collection::vec(descriptor, 0..max)
}
