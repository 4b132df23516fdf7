//! A subset of 0..n as a dense bitset with ascending iteration.

/// A subset of the ground set 0..n.
///
/// ```
/// use submodular_minimax::Subset;
/// let mut set = Subset::empty(5);
/// assert!(set.insert(3) && !set.insert(3));
/// assert_eq!(set.iter().collect::<Vec<_>>(), [3]);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Subset {
    words: Vec<u64>,
    ground: usize,
    len: usize,
}

impl Subset {
    /// No element of 0..`ground`.
    #[must_use]
    pub fn empty(ground: usize) -> Self {
        Self {
            words: vec![0; ground.div_ceil(64)],
            ground,
            len: 0,
        }
    }

    /// Every element of 0..`ground`.
    #[must_use]
    pub fn full(ground: usize) -> Self {
        Self::from_indices(ground, 0..ground)
    }

    /// The given elements; those outside 0..`ground` are ignored.
    #[must_use]
    pub fn from_indices(ground: usize, elements: impl IntoIterator<Item = usize>) -> Self {
        let mut set = Self::empty(ground);
        for element in elements {
            set.insert(element);
        }
        set
    }

    /// The subset whose membership bits are those of `mask`, for enumeration; `ground` ≤ 64.
    #[must_use]
    pub fn from_mask(ground: usize, mask: u64) -> Self {
        Self::from_indices(ground, (0..ground.min(64)).filter(|&e| mask >> e & 1 == 1))
    }

    /// Adds an element; false if it was in already or is outside the ground set.
    pub fn insert(&mut self, element: usize) -> bool {
        let new = element < self.ground && !self.contains(element);
        if new {
            self.words[element / 64] |= 1 << (element % 64);
            self.len += 1;
        }
        new
    }

    /// Takes an element out; false if it was not in.
    pub fn remove(&mut self, element: usize) -> bool {
        let present = self.contains(element);
        if present {
            self.words[element / 64] &= !(1 << (element % 64));
            self.len -= 1;
        }
        present
    }

    /// Whether the element is in.
    #[must_use]
    pub fn contains(&self, element: usize) -> bool {
        element < self.ground && self.words[element / 64] >> (element % 64) & 1 == 1
    }

    /// How many elements are in.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether no element is in.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// n, the size of the ground set.
    #[must_use]
    pub fn ground_size(&self) -> usize {
        self.ground
    }

    /// The elements, ascending.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.words.iter().enumerate().flat_map(|(at, &word)| Bits {
            word,
            base: at * 64,
        })
    }

    /// The elements of either set. The ground set is this one's.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let mut both = self.clone();
        for element in other.iter() {
            both.insert(element);
        }
        both
    }

    /// Whether every element is also in `other`.
    #[must_use]
    pub fn is_subset(&self, other: &Self) -> bool {
        self.iter().all(|element| other.contains(element))
    }
}

struct Bits {
    word: u64,
    base: usize,
}

impl Iterator for Bits {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        if self.word == 0 {
            return None;
        }
        let bit = self.word.trailing_zeros() as usize;
        self.word &= self.word - 1;
        Some(self.base + bit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn set_algebra_over_word_borders() {
        let a = Subset::from_indices(130, [0, 63, 64, 129, 500]);
        let b = Subset::from_indices(130, [1, 64]);
        assert_eq!(a.iter().collect::<Vec<_>>(), [0, 63, 64, 129]);
        assert_eq!(a.union(&b).len(), 5);
        assert!(!b.is_subset(&a));
        let mut c = a.clone();
        assert!(c.remove(63) && !c.remove(63));
        assert!(c.is_subset(&a));
        assert_eq!(Subset::full(70).len(), 70);
        assert_eq!(
            Subset::from_mask(4, 0b1010).iter().collect::<Vec<_>>(),
            [1, 3]
        );
    }
}
