//! The least planner that can use a space: RRT-Connect and greedy shortcuts.

use crate::scene::{Vec3, distance, lerp};
use rand::{Rng, RngExt};

const STEP: f64 = 0.6;
const ITERATIONS: usize = 10_000;

/// A path from start to goal over motions that `is_free` allows.
pub(crate) fn plan(
    (start, goal): (Vec3, Vec3),
    (low, high): (Vec3, Vec3),
    is_free: impl Fn(Vec3, Vec3) -> bool,
    rng: &mut impl Rng,
) -> Option<Vec<Vec3>> {
    if !is_free(start, start) || !is_free(goal, goal) {
        return None;
    }
    let mut trees = [Tree::new(start), Tree::new(goal)];
    for iteration in 0..ITERATIONS {
        let (growing, other) = (iteration % 2, (iteration + 1) % 2);
        let sample = [0, 1, 2].map(|i| low[i] + (high[i] - low[i]) * rng.random::<f64>());
        let Some(new) = trees[growing].extend(sample, &is_free) else {
            continue;
        };
        let target = trees[growing].nodes[new].0;
        while let Some(reached) = trees[other].extend(target, &is_free) {
            if trees[other].nodes[reached].0 == target {
                let mut path = trees[0].trace([new, reached][growing]);
                path.reverse();
                path.extend(trees[1].trace([reached, new][growing]).into_iter().skip(1));
                return Some(shortcut(path, &is_free));
            }
        }
    }
    None
}

struct Tree {
    nodes: Vec<(Vec3, usize)>,
}

impl Tree {
    fn new(root: Vec3) -> Self {
        Tree {
            nodes: vec![(root, usize::MAX)],
        }
    }

    fn extend(&mut self, target: Vec3, is_free: &impl Fn(Vec3, Vec3) -> bool) -> Option<usize> {
        let gap = |node: usize| distance(self.nodes[node].0, target);
        let nearest = (0..self.nodes.len())
            .min_by(|&a, &b| gap(a).total_cmp(&gap(b)))
            .unwrap_or(0);
        let from = self.nodes[nearest].0;
        let to = if gap(nearest) <= STEP {
            target
        } else {
            lerp(from, target, STEP / gap(nearest))
        };
        if from == to || !is_free(from, to) {
            return None;
        }
        self.nodes.push((to, nearest));
        Some(self.nodes.len() - 1)
    }

    /// From a node back to the root.
    fn trace(&self, mut node: usize) -> Vec<Vec3> {
        let mut path = Vec::new();
        while let Some(&(place, parent)) = self.nodes.get(node) {
            path.push(place);
            node = parent;
        }
        path
    }
}

/// From each corner on to the farthest one that can be reached directly.
fn shortcut(path: Vec<Vec3>, is_free: &impl Fn(Vec3, Vec3) -> bool) -> Vec<Vec3> {
    let mut short = vec![path[0]];
    let mut at = 0;
    while at + 1 < path.len() {
        let reach = (at + 1..path.len())
            .rev()
            .find(|&next| is_free(path[at], path[next]));
        at = reach.unwrap_or(at + 1);
        short.push(path[at]);
    }
    short
}
