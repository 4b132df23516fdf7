//! s(u, v): how well point u represents point v.
//!
//! Row v lists the points that may represent v. K(u, v) = (1 − d/h)₊, h = reach · spacing, support(u)
//! = Σ K(u, ·), w(u) = min(1, support(u) / need), zero where u's component has too few points.

use super::config::{OutlierConfig, Reading};
use crate::disjoint_sets::DisjointSets;
use crate::neighbours::{NeighbourGraph, RangeTree};
use crate::points::{Cloud, median};

/// Neighbour rows with the weight of every representative.
pub(super) struct Affinity {
    graph: NeighbourGraph,
    reach: f64,
    weight: Vec<f64>,
}

impl Affinity {
    /// Builds the rows; `None` when the cloud has no spacing to measure by (all points equal, n < 5).
    pub(super) fn new(cloud: &Cloud, config: &OutlierConfig) -> Option<Self> {
        let tree = RangeTree::new(&cloud.points, &[]);
        let spacing = spacing(&tree)?;
        let reach = config.reach * spacing;
        let graph = NeighbourGraph::new(&tree, config.neighbours, reach * reach);
        let mut affinity = Self {
            graph,
            reach,
            weight: vec![1.0; cloud.len()],
        };
        if config.reading != Reading::Nearest {
            affinity.weigh_by_support(config.support);
        }
        if config.reading == Reading::Connected {
            affinity.silence_small_components(config.min_component);
        }
        Some(affinity)
    }

    /// How well the best representative represents `v`: max over u of w(u) K(u, v).
    pub(super) fn best(&self, v: usize) -> f64 {
        self.row(v).map(|(_, s)| s).fold(0.0, f64::max)
    }

    /// (u, s(u, v)) for every u that may represent v.
    pub(super) fn row(&self, v: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.graph.row(v).iter().map(|&(d, u)| {
            let u = u as usize;
            (u, self.weight[u] * self.kernel(d))
        })
    }

    fn kernel(&self, squared: f64) -> f64 {
        (1.0 - squared.sqrt() / self.reach).max(0.0)
    }

    fn weigh_by_support(&mut self, need: f64) {
        for u in 0..self.graph.len() {
            let support: f64 = self.graph.row(u).iter().map(|n| self.kernel(n.0)).sum();
            self.weight[u] = (support / need).min(1.0);
        }
    }

    fn silence_small_components(&mut self, min_component: usize) {
        let n = self.graph.len();
        let mut components = DisjointSets::new(n);
        for v in 0..n {
            for &(_, u) in self.graph.row(v) {
                components.join(v, u as usize);
            }
        }
        for u in 0..n {
            if components.size(u) < min_component {
                self.weight[u] = 0.0;
            }
        }
    }
}

/// The median distance to the fourth neighbour; `None` if there is no such, or if it is zero.
fn spacing(tree: &RangeTree) -> Option<f64> {
    let graph = NeighbourGraph::new(tree, 4, f64::INFINITY);
    let fourth = |v: usize| graph.row(v).get(3).map(|n| n.0.sqrt());
    let mut distances: Vec<f64> = (0..graph.len()).filter_map(fourth).collect();
    let spacing = median(&mut distances);
    (spacing > 0.0).then_some(spacing)
}
