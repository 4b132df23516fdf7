//! An image as weighted words, and how alike two of them are (Sivic & Zisserman 2003; L1 score of Nistér & Stewénius 2006).

/// Words of an image with the share of its weight that each has, ascending by word; the shares sum to 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BagOfWords {
    shares: Vec<(usize, f64)>,
}

impl BagOfWords {
    /// How often each word occurs, times its weight; words without weight or past the end of the weights are left out.
    pub(super) fn new(words: impl Iterator<Item = usize>, weights: &[f64]) -> Self {
        let weight = |word: usize| weights.get(word).copied().unwrap_or(0.0);
        let mut words: Vec<usize> = words.filter(|&word| weight(word) > 0.0).collect();
        words.sort_unstable();
        let total: f64 = words.iter().map(|&word| weight(word)).sum();
        let groups = words.chunk_by(|a, b| a == b);
        #[expect(clippy::cast_precision_loss, reason = "a count of descriptors")]
        let share = |group: &[usize]| (group[0], group.len() as f64 * weight(group[0]) / total);
        Self {
            shares: groups.map(share).collect(),
        }
    }

    /// Whether nothing is known about the image: it is like no other, nor like itself.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.shares.is_empty()
    }

    /// 1 - |a - b|₁ / 2: 1 for the same shares of the same words, 0 without a common word. Cost: O(words of both).
    #[must_use]
    pub fn similarity(&self, other: &Self) -> f64 {
        // Shares sum to 1 on both sides, so that the distance is what the common words do not share.
        let mut rest = other.shares.iter().peekable();
        let mut common = 0.0;
        for &(word, share) in &self.shares {
            while rest.next_if(|next| next.0 < word).is_some() {}
            if let Some(&(_, theirs)) = rest.next_if(|next| next.0 == word) {
                common += share.min(theirs);
            }
        }
        common.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn similarity_is_the_l1_score(a in prop::collection::vec(0_usize..9, 1..30), b in prop::collection::vec(0_usize..9, 1..30)) {
            let weights = [0.5, 1.0, 0.1, 0.7, 2.0, 0.3, 0.0, 1.5, 0.9];
            let dense = |words: &[usize]| {
                let mut shares = [0.0; 9];
                words.iter().for_each(|&w| shares[w] += weights[w]);
                let total: f64 = shares.iter().sum();
                if total > 0.0 { shares.map(|s| s / total) } else { shares }
            };
            let bag = |words: &[usize]| BagOfWords::new(words.iter().copied(), &weights);
            let (x, y) = (bag(&a), bag(&b));
            if !x.is_empty() && !y.is_empty() {
                let distance: f64 = dense(&a).iter().zip(dense(&b)).map(|(p, q)| (p - q).abs()).sum();
                prop_assert!((x.similarity(&y) - (1.0 - 0.5 * distance)).abs() < 1e-12);
            } else {
                prop_assert_eq!(x.similarity(&y), 0.0);
            }
        }
    }
}
