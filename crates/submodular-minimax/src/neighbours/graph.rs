//! The k nearest neighbours of every point, in two flat arrays.

use super::tree::{Neighbour, RangeTree};

/// Row v holds up to `width` neighbours of point v, nearest first.
pub(crate) struct NeighbourGraph {
    width: usize,
    count: Vec<u32>,
    entries: Vec<Neighbour>,
}

impl NeighbourGraph {
    /// At most `width` neighbours within squared (normalised) distance `limit` of each point.
    ///
    /// Time O(n log n) expected, memory 16 n `width` bytes. The rows are the same bits on any
    /// number of threads, since each is computed alone.
    pub(crate) fn new(tree: &RangeTree, width: usize, limit: f64) -> Self {
        let n = tree.order().len();
        let width = width.min(n.saturating_sub(1));
        let rows = rows_in_leaf_order(tree, width, limit);
        let mut graph = Self {
            width,
            count: vec![0; n],
            entries: vec![(f64::INFINITY, 0); n * width],
        };
        let mut at = 0;
        for (&v, &count) in tree.order().iter().zip(&rows.count) {
            let (v, length) = (v as usize, count as usize);
            graph.count[v] = count;
            graph.entries[v * width..v * width + length]
                .copy_from_slice(&rows.entries[at..at + length]);
            at += length;
        }
        graph
    }

    /// The neighbours of `v` as (squared distance, index), nearest first.
    pub(crate) fn row(&self, v: usize) -> &[Neighbour] {
        let start = v * self.width;
        &self.entries[start..start + self.count[v] as usize]
    }

    /// Shows the neighbours within squared distance `limit` only, all that were found if it is large.
    pub(crate) fn truncate(&mut self, limit: f64) {
        let limit = limit.min(f64::MAX);
        for (row, count) in self.entries.chunks(self.width.max(1)).zip(&mut self.count) {
            *count = row.partition_point(|n| n.0 <= limit) as u32;
        }
    }

    /// Makes a point a neighbour of `v`, at this squared distance if it is nearer than before. If the row is full its farthest goes.
    pub(crate) fn link(&mut self, v: usize, neighbour: Neighbour) {
        let row = &mut self.entries[v * self.width..(v + 1) * self.width];
        let count = self.count[v] as usize;
        let known = row[..count].iter().position(|n| n.1 == neighbour.1);
        let at = known.unwrap_or(count.min(self.width - 1));
        if known.is_none_or(|at| neighbour.0 < row[at].0) {
            row[at] = neighbour;
        }
        self.count[v] = count.max(at + 1) as u32;
        row[..=at].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }

    /// The mean distance of the up to four nearest neighbours that were found, shown or not; infinite if there are none.
    pub(crate) fn isolation(&self, v: usize) -> f64 {
        let found = &self.entries[v * self.width..][..self.width.min(4)];
        match found.len() {
            0 => f64::INFINITY,
            count => found.iter().map(|n| n.0.sqrt()).sum::<f64>() / count as f64,
        }
    }

    /// How many points there are.
    pub(crate) fn len(&self) -> usize {
        self.count.len()
    }
}

#[derive(Default)]
struct Rows {
    count: Vec<u32>,
    entries: Vec<Neighbour>,
}

fn chunk_rows(tree: &RangeTree, width: usize, limit: f64, from: usize, to: usize) -> Rows {
    let mut rows = Rows::default();
    let mut found = Vec::with_capacity(width + 1);
    for position in from..to {
        tree.nearest(position, width, limit, &mut found);
        rows.count.push(found.len() as u32);
        rows.entries.extend_from_slice(&found);
    }
    rows
}

#[cfg(not(feature = "rayon"))]
fn rows_in_leaf_order(tree: &RangeTree, width: usize, limit: f64) -> Rows {
    chunk_rows(tree, width, limit, 0, tree.order().len())
}

#[cfg(feature = "rayon")]
fn rows_in_leaf_order(tree: &RangeTree, width: usize, limit: f64) -> Rows {
    use rayon::prelude::*;
    const CHUNK: usize = 1024;
    let n = tree.order().len();
    let starts: Vec<usize> = (0..n).step_by(CHUNK).collect();
    let parts: Vec<Rows> = starts
        .par_iter()
        .map(|&from| chunk_rows(tree, width, limit, from, (from + CHUNK).min(n)))
        .collect();
    let mut all = Rows::default();
    for part in parts {
        all.count.extend(part.count);
        all.entries.extend(part.entries);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::squared_distance;
    use proptest::prelude::*;

    fn brute_force(points: &[[f64; 3]], ranges: &[f64], v: usize, k: usize) -> Vec<Neighbour> {
        let range = |i: usize| ranges.get(i).copied().unwrap_or(1.0);
        let mut all: Vec<Neighbour> = (0..points.len())
            .filter(|&u| u != v)
            .map(|u| {
                let scale = (1.0 / range(v)) / range(u);
                (squared_distance(points[v], points[u]) * scale, u as u32)
            })
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        all.truncate(k);
        all
    }

    proptest! {
        #[test]
        fn rows_equal_brute_force(
            cells in prop::collection::vec((0..6i8, 0..6i8, 0..3i8, 1..9u8), 0..120),
            k in 0..12usize,
            normalised in any::<bool>(),
        ) {
            let points: Vec<[f64; 3]> =
                cells.iter().map(|c| [f64::from(c.0), f64::from(c.1), f64::from(c.2)]).collect();
            let ranges: Vec<f64> = if normalised {
                cells.iter().map(|c| f64::from(c.3)).collect()
            } else {
                Vec::new()
            };
            let tree = RangeTree::new(&points, &ranges);
            let graph = NeighbourGraph::new(&tree, k, f64::INFINITY);
            prop_assert_eq!(graph.len(), points.len());
            for v in 0..points.len() {
                prop_assert_eq!(graph.row(v), &brute_force(&points, &ranges, v, k)[..]);
            }
        }
    }

    #[test]
    fn limit_drops_farther_neighbours() {
        let points: Vec<[f64; 3]> = (0..50).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        let graph = NeighbourGraph::new(&RangeTree::new(&points, &[]), 10, 4.0);
        assert_eq!(graph.row(0), &[(1.0, 1), (4.0, 2)]);
        assert_eq!(graph.row(10).len(), 4);
    }

    #[test]
    fn a_thousand_identical_points_are_no_trouble() {
        let points = vec![[0.25; 3]; 1000];
        let graph = NeighbourGraph::new(&RangeTree::new(&points, &[]), 4, f64::INFINITY);
        assert_eq!(
            graph.row(7).iter().map(|n| n.1).collect::<Vec<_>>(),
            [0, 1, 2, 3]
        );
    }
}
