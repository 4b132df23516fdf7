//! Disjoint sets with union by size and path halving.

/// A partition of 0..n that only coarsens.
pub(crate) struct DisjointSets {
    parent: Vec<u32>,
    size: Vec<u32>,
}

impl DisjointSets {
    /// Every element alone.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            parent: (0..n as u32).collect(),
            size: vec![1; n],
        }
    }

    /// The representative of `v`'s set.
    pub(crate) fn root(&mut self, v: usize) -> usize {
        let mut at = v;
        while self.parent[at] as usize != at {
            let above = self.parent[at] as usize;
            self.parent[at] = self.parent[above];
            at = self.parent[at] as usize;
        }
        at
    }

    /// Puts the sets of `a` and `b` together.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return;
        }
        let (large, small) = if self.size[a] >= self.size[b] {
            (a, b)
        } else {
            (b, a)
        };
        self.parent[small] = large as u32;
        self.size[large] += self.size[small];
    }

    /// How many elements `v`'s set has.
    pub(crate) fn size(&mut self, v: usize) -> usize {
        let root = self.root(v);
        self.size[root] as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joins_accumulate_sizes() {
        let mut sets = DisjointSets::new(6);
        sets.join(0, 1);
        sets.join(2, 3);
        sets.join(1, 3);
        sets.join(3, 0);
        assert_eq!(sets.size(2), 4);
        assert_eq!(sets.size(5), 1);
        assert_eq!(sets.root(0), sets.root(3));
    }
}
