//! A vocabulary of binary words: a tree of clusters (Nistér & Stewénius 2006; binary words as Gálvez-López & Tardós 2012, DBoW2).
//!
//! Input:   descriptors of some images of the user's own.
//! Output:  a tree; a descriptor goes down it by the nearest child, and the leaf where it ends is its word.
//! Method:  each node's descriptors are split by k-majority until `depth` or until they are all the same. A word weighs
//!          ln(images / images that show it), so that what every image shows says nothing.
//! Cost:    training O(descriptors · branching · iterations · depth); a word O(branching · depth), 30 comparisons by default.
//! Deviations: no file format: training on 40,000 descriptors takes a fraction of a second and gives the same tree for the same seed.

use rand::Rng;

use super::k_majority::{k_majority, nearest_centre};
use super::{BagOfWords, DirectIndex};
use crate::feature::Descriptor;

/// Parameters of [`Vocabulary::train`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VocabularyConfig {
    /// Children of a node, 2..=64. Default 10 (DBoW2).
    pub branching: usize,
    /// Splits from the root to a word, 1..=8. Default 3: a thousand words, for the descriptors of tens of frames. DBoW2's
    /// million words are [`VocabularyConfig::paper`].
    pub depth: usize,
    /// Most rounds of clustering a split, 1..=1,000. Default 10: few members move after that.
    pub iterations: usize,
}

impl Default for VocabularyConfig {
    fn default() -> Self {
        Self {
            branching: 10,
            depth: 3,
            iterations: 10,
        }
    }
}

/// Most splits from the root to a word.
const MOST_DEPTH: usize = 8;

/// Why there is no vocabulary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum VocabularyError {
    /// A parameter outside its range.
    #[error("{name} is {value}, but must be in {min}..={max}")]
    Config {
        /// Field of [`VocabularyConfig`].
        name: &'static str,
        /// What was given.
        value: usize,
        /// Least allowed value.
        min: usize,
        /// Greatest allowed value.
        max: usize,
    },
    /// Nothing to learn from.
    #[error("none of the {images} images has a descriptor: give images with features")]
    NoDescriptors {
        /// How many images were given.
        images: usize,
    },
}

impl VocabularyConfig {
    /// DBoW2's published size: ten children, six splits. Needs millions of descriptors to fill.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            depth: 6,
            ..Self::default()
        }
    }

    /// Errs at the first field outside its range.
    ///
    /// # Errors
    /// [`VocabularyError::Config`] with the field's name and range.
    pub fn validate(&self) -> Result<(), VocabularyError> {
        let fields = [
            ("branching", self.branching, 2, 64),
            ("depth", self.depth, 1, MOST_DEPTH),
            ("iterations", self.iterations, 1, 1_000),
        ];
        for (name, value, min, max) in fields {
            if !(min..=max).contains(&value) {
                return Err(VocabularyError::Config {
                    name,
                    value,
                    min,
                    max,
                });
            }
        }
        Ok(())
    }
}

/// A tree of clusters of descriptors, whose leaves are words.
///
/// ```
/// use edge_slam::feature::{Descriptor, Vocabulary, VocabularyConfig};
/// use rand::SeedableRng;
/// let door = [Descriptor([0; 4]), Descriptor([1; 4])];
/// let shelf = [Descriptor([u64::MAX; 4])];
/// let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
/// let images = [&door[..], &shelf[..]];
/// let vocabulary = Vocabulary::train(&images, &VocabularyConfig::default(), rng)?;
/// let [door, shelf] = images.map(|descriptors| vocabulary.bag_of_words(descriptors));
/// assert_eq!((door.similarity(&door), door.similarity(&shelf)), (1.0, 0.0));
/// # Ok::<(), edge_slam::feature::VocabularyError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Vocabulary {
    /// The root first; the children of a node are neighbours.
    nodes: Vec<Node>,
    /// By word.
    weights: Vec<f64>,
}

#[derive(Debug, Clone, PartialEq)]
struct Node {
    centre: Descriptor,
    below: Below,
}

#[derive(Debug, Clone, PartialEq)]
enum Below {
    Children(core::ops::Range<usize>),
    Word(usize),
}

impl Vocabulary {
    /// Learns words from the descriptors of each image. The same seed gives the same tree.
    ///
    /// With one image no word tells images apart: the tree serves [`super::match_by_node`], and all similarities are 0.
    ///
    /// # Errors
    /// [`VocabularyError`] when a parameter is outside its range or no image has a descriptor.
    pub fn train(
        images: &[&[Descriptor]],
        config: &VocabularyConfig,
        rng: &mut impl Rng,
    ) -> Result<Self, VocabularyError> {
        config.validate()?;
        let all = images.concat();
        if all.is_empty() {
            let images = images.len();
            return Err(VocabularyError::NoDescriptors { images });
        }
        let mut vocabulary = Self {
            nodes: Vec::new(),
            weights: Vec::new(),
        };
        vocabulary.grow(&all, config, rng);
        vocabulary.weigh(images);
        Ok(vocabulary)
    }

    /// Splits node after node, level by level.
    fn grow(&mut self, all: &[Descriptor], config: &VocabularyConfig, rng: &mut impl Rng) {
        let leaf = |centre| Node {
            centre,
            below: Below::Word(0),
        };
        self.nodes.push(leaf(Descriptor::default()));
        let mut members = vec![(0..all.len()).collect::<Vec<usize>>()];
        let mut level = 0..1;
        for _ in 0..config.depth {
            let next = self.nodes.len();
            for node in level {
                let own = core::mem::take(&mut members[node]);
                let clusters = k_majority(all, &own, config.branching, config.iterations, rng);
                if clusters.len() < 2 {
                    continue;
                }
                let children = self.nodes.len()..self.nodes.len() + clusters.len();
                self.nodes[node].below = Below::Children(children);
                for cluster in clusters {
                    self.nodes.push(leaf(cluster.centre));
                    members.push(cluster.members);
                }
            }
            level = next..self.nodes.len();
        }
    }

    /// Numbers the words and weighs each by how few images show it.
    #[expect(clippy::cast_precision_loss, reason = "a count of images")]
    fn weigh(&mut self, images: &[&[Descriptor]]) {
        let words = self
            .nodes
            .iter_mut()
            .filter_map(|node| match &mut node.below {
                Below::Word(word) => Some(word),
                Below::Children(_) => None,
            });
        let mut count = 0;
        for word in words {
            *word = count;
            count += 1;
        }
        let mut shown = vec![0_usize; count];
        let mut last = vec![usize::MAX; count];
        for (image, descriptors) in images.iter().enumerate() {
            for descriptor in *descriptors {
                let word = self.word(descriptor);
                if core::mem::replace(&mut last[word], image) != image {
                    shown[word] += 1;
                }
            }
        }
        // A majority may draw no descriptor to itself once all have moved; such a word weighs nothing.
        let weight = |&shown: &usize| match shown {
            0 => 0.0,
            _ => (images.len() as f64 / shown as f64).ln(),
        };
        self.weights = shown.iter().map(weight).collect();
    }

    /// How many words there are.
    #[must_use]
    pub fn words(&self) -> usize {
        self.weights.len()
    }

    /// The word of a descriptor, below [`Self::words`].
    #[must_use]
    pub fn word(&self, descriptor: &Descriptor) -> usize {
        let mut node = 0;
        loop {
            match &self.nodes[node].below {
                Below::Word(word) => return *word,
                Below::Children(_) => node = self.child(node, descriptor),
            }
        }
    }

    /// What an image shows, as weighted words. Empty when all its words weigh nothing, or without descriptors.
    #[must_use]
    pub fn bag_of_words(&self, descriptors: &[Descriptor]) -> BagOfWords {
        let words = descriptors.iter().map(|descriptor| self.word(descriptor));
        BagOfWords::new(words, &self.weights)
    }

    /// An image's descriptors by the node at `level` below the root through which each goes; a word above that level counts
    /// as one. Level 0 puts all together; the greater the level, the fewer share a node.
    #[must_use]
    pub fn direct_index(&self, descriptors: &[Descriptor], level: usize) -> DirectIndex {
        // No tree is deeper, and a word is its own child.
        let level = level.min(MOST_DEPTH);
        let node = |descriptor| (0..level).fold(0, |node, _| self.child(node, descriptor));
        DirectIndex::new(descriptors, descriptors.iter().map(node))
    }

    /// The child that the descriptor is nearest to; a leaf itself.
    fn child(&self, node: usize, descriptor: &Descriptor) -> usize {
        match &self.nodes[node].below {
            Below::Word(_) => node,
            Below::Children(children) => {
                let centres = self.nodes[children.clone()]
                    .iter()
                    .map(|child| &child.centre);
                children.start + nearest_centre(descriptor, centres)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature::{MatchConfig, match_by_node, match_descriptors};
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    fn descriptors(max: usize) -> impl Strategy<Value = Vec<Descriptor>> {
        prop::collection::vec(any::<[u64; 4]>().prop_map(Descriptor), 0..max)
    }

    fn trained(
        images: &[&[Descriptor]],
        config: &VocabularyConfig,
        seed: u64,
    ) -> Option<Vocabulary> {
        Vocabulary::train(images, config, &mut Pcg64::seed_from_u64(seed)).ok()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn any_descriptors_make_a_vocabulary(
            a in descriptors(60), b in descriptors(60), other in descriptors(20), branching in 2_usize..6, depth in 1_usize..5, seed in any::<u64>(),
        ) {
            let config = VocabularyConfig { branching, depth, iterations: 4 };
            let images = [&a[..], &b[..]];
            let Some(vocabulary) = trained(&images, &config, seed) else {
                prop_assert!(a.is_empty() && b.is_empty());
                return Ok(());
            };
            let again = trained(&images, &config, seed);
            prop_assert_eq!(Some(&vocabulary), again.as_ref());
            prop_assert!(vocabulary.words() <= branching.pow(depth as u32).min(a.len() + b.len()));
            prop_assert!(other.iter().all(|d| vocabulary.word(d) < vocabulary.words()));
            let [a, b] = images.map(|i| vocabulary.bag_of_words(i));
            let (there, back) = (a.similarity(&b), b.similarity(&a));
            prop_assert!((there - back).abs() < 1e-12 && (0.0..=1.0).contains(&there));
            if !a.is_empty() {
                prop_assert!((a.similarity(&a) - 1.0).abs() < 1e-12);
            }
        }

        #[test]
        fn the_root_alone_is_plain_matching(a in descriptors(30), b in descriptors(30), seed in any::<u64>(), mutual in any::<bool>()) {
            let Some(vocabulary) = trained(&[&a, &b], &VocabularyConfig::default(), seed) else { return Ok(()) };
            let config = MatchConfig { max_distance: 128, ratio: 0.99, mutual };
            let [first, second] = [&a, &b].map(|d| vocabulary.direct_index(d, 0));
            prop_assert_eq!(match_by_node(&first, &second, &config), match_descriptors(&a, &b, &config));
        }

        #[test]
        fn equal_descriptors_are_found_at_every_level(a in descriptors(40), seed in any::<u64>(), level in 0_usize..5) {
            let Some(vocabulary) = trained(&[&a], &VocabularyConfig::default(), seed) else { return Ok(()) };
            let index = vocabulary.direct_index(&a, level);
            prop_assert_eq!(vocabulary.direct_index(&a, usize::MAX), vocabulary.direct_index(&a, 3));
            let config = MatchConfig { max_distance: 0, ratio: 1.0, mutual: true };
            prop_assert_eq!(match_by_node(&index, &index, &config), match_descriptors(&a, &a, &config));
        }
    }

    /// Places that share no look: a picture of one is most like another picture of the same.
    #[test]
    fn finds_the_place_again() {
        let rng = &mut Pcg64::seed_from_u64(3);
        let places: Vec<Vec<Descriptor>> = (0..12)
            .map(|_| (0..40).map(|_| Descriptor(rng.random())).collect())
            .collect();
        let mut seen_again = |place: &[Descriptor]| -> Vec<Descriptor> {
            let turn = |d: &Descriptor| {
                let mut bits = d.0;
                for _ in 0..20 {
                    bits[rng.random_range(0..4)] ^= 1 << rng.random_range(0..64);
                }
                Descriptor(bits)
            };
            place.iter().map(turn).collect()
        };
        let later: Vec<Vec<Descriptor>> = places.iter().map(|place| seen_again(place)).collect();
        let images: Vec<&[Descriptor]> = places.iter().map(Vec::as_slice).collect();
        let vocabulary = trained(&images, &VocabularyConfig::default(), 1).unwrap();
        let known: Vec<BagOfWords> = images.iter().map(|i| vocabulary.bag_of_words(i)).collect();
        for (place, picture) in later.iter().enumerate() {
            let bag = vocabulary.bag_of_words(picture);
            let score = |&k: &usize| bag.similarity(&known[k]);
            let best = (0..known.len()).max_by(|a, b| score(a).total_cmp(&score(b)));
            assert_eq!(best, Some(place));
        }
    }

    #[test]
    fn bad_input_is_refused() {
        let one = [Descriptor::default()];
        let config = VocabularyConfig {
            branching: 1,
            ..Default::default()
        };
        assert!(trained(&[&one], &config, 1).is_none());
        let rng = &mut Pcg64::seed_from_u64(1);
        let nothing = Vocabulary::train(&[&[], &[]], &VocabularyConfig::paper(), rng);
        assert_eq!(nothing, Err(VocabularyError::NoDescriptors { images: 2 }));
        assert_eq!(
            trained(&[&one, &one], &VocabularyConfig::default(), 1)
                .unwrap()
                .words(),
            1
        );
    }
}
