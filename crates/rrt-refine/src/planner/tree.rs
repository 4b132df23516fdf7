//! A search tree in flat arrays: node points, parents, and the structure that finds the nearest node.

use crate::nearest::KdTree;

/// Parent of a root.
const NONE: usize = usize::MAX;

#[derive(Clone, Debug)]
pub(crate) struct Tree<const D: usize> {
    points: Vec<[f64; D]>,
    parents: Vec<usize>,
    nearest: KdTree<D>,
}

impl<const D: usize> Tree<D> {
    /// A tree, or a forest, of roots only.
    pub(crate) fn with_roots(roots: &[[f64; D]]) -> Self {
        let mut tree = Self {
            points: Vec::new(),
            parents: Vec::new(),
            nearest: KdTree::new(),
        };
        for root in roots {
            tree.push(*root, NONE);
        }
        tree
    }

    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    pub(crate) fn point(&self, node: usize) -> &[f64; D] {
        &self.points[node]
    }

    /// Adds a node under `parent` and gives its index.
    pub(crate) fn push(&mut self, point: [f64; D], parent: usize) -> usize {
        self.points.push(point);
        self.parents.push(parent);
        self.nearest.insert(point);
        self.points.len() - 1
    }

    /// The node nearest to the point; a tree has at least one root.
    pub(crate) fn nearest(&self, point: &[f64; D]) -> usize {
        self.nearest.nearest(point).map_or(0, |(node, _)| node)
    }

    /// Indices from `node` up to its root, both included.
    pub(crate) fn ancestry(&self, node: usize) -> Vec<usize> {
        let mut chain = vec![node];
        let mut at = node;
        while self.parents[at] != NONE {
            at = self.parents[at];
            chain.push(at);
        }
        chain
    }
}
