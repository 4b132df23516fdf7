//! A search tree whose nodes know the length of the way from the root and may change their parent.

use crate::euclid::distance;
use crate::nearest::KdTree;

/// No node: the parent of the root, the end of a list of children.
const NONE: usize = usize::MAX;

#[derive(Clone, Debug)]
pub(crate) struct CostTree<const D: usize> {
    points: Vec<[f64; D]>,
    costs: Vec<f64>,
    parents: Vec<usize>,
    first_child: Vec<usize>,
    next_sibling: Vec<usize>,
    nearest: KdTree<D>,
}

impl<const D: usize> CostTree<D> {
    pub(crate) fn with_root(root: [f64; D]) -> Self {
        let mut nearest = KdTree::new();
        nearest.insert(root);
        Self {
            points: vec![root],
            costs: vec![0.0],
            parents: vec![NONE],
            first_child: vec![NONE],
            next_sibling: vec![NONE],
            nearest,
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    pub(crate) fn point(&self, node: usize) -> &[f64; D] {
        &self.points[node]
    }

    /// Length of the way from the root to the node.
    pub(crate) fn cost(&self, node: usize) -> f64 {
        self.costs[node]
    }

    pub(crate) fn parent(&self, node: usize) -> Option<usize> {
        Some(self.parents[node]).filter(|&parent| parent != NONE)
    }

    pub(crate) fn nearest(&self, point: &[f64; D]) -> usize {
        self.nearest.nearest(point).map_or(0, |(node, _)| node)
    }

    /// The `k` nodes nearest to the point, each with its distance, nearest first.
    pub(crate) fn nearest_k(&self, point: &[f64; D], k: usize) -> Vec<(usize, f64)> {
        let mut found = self.nearest.nearest_k(point, k);
        for entry in &mut found {
            entry.1 = entry.1.sqrt();
        }
        found
    }

    /// Adds a node under `parent` and gives its index.
    pub(crate) fn push(&mut self, point: [f64; D], parent: usize) -> usize {
        let node = self.points.len();
        self.costs
            .push(self.costs[parent] + distance(&self.points[parent], &point));
        self.points.push(point);
        self.parents.push(NONE);
        self.first_child.push(NONE);
        self.next_sibling.push(NONE);
        self.nearest.insert(point);
        self.attach(node, parent);
        node
    }

    /// Hangs `node` under `parent` and updates the costs of everything below it.
    pub(crate) fn set_parent(&mut self, node: usize, parent: usize) {
        self.detach(node);
        self.attach(node, parent);
        let mut open = vec![node];
        while let Some(at) = open.pop() {
            let above = self.parents[at];
            self.costs[at] = self.costs[above] + distance(&self.points[above], &self.points[at]);
            let mut child = self.first_child[at];
            while child != NONE {
                open.push(child);
                child = self.next_sibling[child];
            }
        }
    }

    /// Points from the root to `node`.
    pub(crate) fn way_to(&self, node: usize) -> Vec<[f64; D]> {
        let mut way = vec![self.points[node]];
        let mut at = node;
        while let Some(parent) = self.parent(at) {
            way.push(self.points[parent]);
            at = parent;
        }
        way.reverse();
        way
    }

    fn attach(&mut self, node: usize, parent: usize) {
        self.parents[node] = parent;
        self.next_sibling[node] = self.first_child[parent];
        self.first_child[parent] = node;
    }

    fn detach(&mut self, node: usize) {
        let parent = self.parents[node];
        if self.first_child[parent] == node {
            self.first_child[parent] = self.next_sibling[node];
            return;
        }
        let mut at = self.first_child[parent];
        while self.next_sibling[at] != node {
            at = self.next_sibling[at];
        }
        self.next_sibling[at] = self.next_sibling[node];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_parent_changes_the_costs_of_the_whole_branch() {
        let mut tree = CostTree::with_root([0.0, 0.0]);
        let detour = tree.push([0.0, 3.0], 0);
        let middle = tree.push([4.0, 3.0], detour);
        let sibling = tree.push([0.0, 4.0], detour);
        let leaf = tree.push([4.0, 4.0], middle);
        assert_eq!(tree.cost(leaf), 8.0);
        tree.set_parent(middle, 0);
        assert_eq!((tree.cost(middle), tree.cost(leaf)), (5.0, 6.0));
        assert_eq!(tree.cost(sibling), 4.0);
        assert_eq!(tree.way_to(leaf), [[0.0, 0.0], [4.0, 3.0], [4.0, 4.0]]);
        tree.set_parent(sibling, 0);
        assert_eq!(tree.first_child[detour], NONE);
    }
}
