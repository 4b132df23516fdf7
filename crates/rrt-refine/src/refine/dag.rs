//! The shortest path in the visibility graph of a path's own vertices: the paper's sub-path replacement done optimally.
//!
//! Method: the vertices p₀ … pₙ₋₁ are the nodes; i → j for i < j is an edge when the straight motion is free, and the
//! path's own segments always are. A* with the straight distance to the end as its bound takes nodes in order; an edge is checked
//! only when it is the next one that could matter, so the answer is that of checking all n(n−1)/2 motions.
//! Equal lengths: the earlier edge wins. The search is repeated on its own result (without new checks) until nothing changes.
//!
//! Paper: Tukan et al. 2023, path refinement: "replace the sub-path A..B by the segment AB where it is free". Done one by
//! one, as printed, the outcome depends on the order.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap};

use super::Refined;
use crate::euclid::distance;
use crate::motion::MotionValidator;
use crate::path::Path;

/// A shorter length counts as shorter from this share on; below it is rounding.
const SHORTER: f64 = 1e-12;

/// Shortest path over a subset of the vertices of `path`, its two ends always among them.
///
/// Never longer than the input, idempotent, and valid wherever the segments of the input are: those are trusted, every
/// other motion is checked, at most n(n−1)/2 in all. O(n² log n) besides the checks.
///
/// ```
/// use rrt_refine::{Path, refine};
/// let zigzag = Path::new(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0], [4.0, 0.0]])?;
/// let refined = refine::dag(&zigzag, &|_: &[f64; 2], _: &[f64; 2]| true);
/// assert_eq!(refined.path.points(), [[0.0, 0.0], [4.0, 0.0]]);
/// assert_eq!(refined.checks, 1);
/// # Ok::<(), rrt_refine::PathError>(())
/// ```
pub fn dag<const D: usize>(path: &Path<D>, motion_is_free: &impl MotionValidator<D>) -> Refined<D> {
    let mut graph = VisibilityGraph::new(path.points(), motion_is_free);
    let mut chosen: Vec<usize> = (0..path.points().len()).collect();
    loop {
        let shorter = graph.shortest(&chosen);
        let (before, after) = (graph.length(&chosen), graph.length(&shorter));
        let fewer = shorter.len() < chosen.len() && after <= before;
        if !(fewer || after < before * (1.0 - SHORTER)) {
            break;
        }
        chosen = shorter;
    }
    Refined {
        path: Path::from_vertices(chosen.iter().map(|&v| path.points()[v]).collect()),
        checks: graph.checks,
        length_before: path.length(),
    }
}

/// The vertices of a path, and what is known about the motions between them.
struct VisibilityGraph<'a, const D: usize, M> {
    points: &'a [[f64; D]],
    motion: &'a M,
    /// Whether the motion from i to j is free, for every pair that was asked.
    known: BTreeMap<(usize, usize), bool>,
    checks: usize,
}

impl<'a, const D: usize, M: MotionValidator<D>> VisibilityGraph<'a, D, M> {
    fn new(points: &'a [[f64; D]], motion: &'a M) -> Self {
        let known = (1..points.len()).map(|j| ((j - 1, j), true)).collect();
        Self {
            points,
            motion,
            known,
            checks: 0,
        }
    }

    fn is_free(&mut self, i: usize, j: usize) -> bool {
        if let Some(&free) = self.known.get(&(i, j)) {
            return free;
        }
        self.checks += 1;
        let free = self.motion.is_free(&self.points[i], &self.points[j]);
        self.known.insert((i, j), free);
        free
    }

    fn gap(&self, i: usize, j: usize) -> f64 {
        distance(&self.points[i], &self.points[j])
    }

    fn length(&self, chosen: &[usize]) -> f64 {
        chosen
            .windows(2)
            .map(|pair| self.gap(pair[0], pair[1]))
            .sum()
    }

    /// Lazy A* over the vertices in `among`, whose neighbours are known to see each other.
    fn shortest(&mut self, among: &[usize]) -> Vec<usize> {
        let last = among.len() - 1;
        let to_end: Vec<f64> = among.iter().map(|&v| self.gap(v, among[last])).collect();
        let mut parent: Vec<Option<usize>> = vec![None; among.len()];
        let mut open = BinaryHeap::from([Edge {
            bound: to_end[0],
            reached: 0.0,
            from: 0,
            to: 0,
        }]);
        while let Some(edge) = open.pop() {
            let (from, to) = (edge.from, edge.to);
            if parent[to].is_some() || (from != to && !self.is_free(among[from], among[to])) {
                continue;
            }
            parent[to] = Some(from);
            if to == last {
                break;
            }
            for next in to + 1..among.len() {
                if parent[next].is_none() {
                    let reached = edge.reached + self.gap(among[to], among[next]);
                    open.push(Edge {
                        bound: reached + to_end[next],
                        reached,
                        from: to,
                        to: next,
                    });
                }
            }
        }
        let mut chain = vec![last];
        while let Some(at) = chain.last().copied().filter(|&at| at != 0) {
            chain.push(parent[at].unwrap_or(at - 1));
        }
        chain.reverse();
        chain.into_iter().map(|place| among[place]).collect()
    }
}

/// An edge that may lie on the shortest path; ordered so that the heap gives the least bound first.
struct Edge {
    /// Length of the shortest path through this edge, from below.
    bound: f64,
    /// Length from the start to the end of this edge.
    reached: f64,
    from: usize,
    to: usize,
}

impl Ord for Edge {
    fn cmp(&self, other: &Self) -> Ordering {
        // Greater is popped first: the least bound, then the farthest vertex, then the earliest origin.
        other
            .bound
            .total_cmp(&self.bound)
            .then(self.to.cmp(&other.to))
            .then(other.from.cmp(&self.from))
    }
}

impl PartialOrd for Edge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Edge {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Edge {}
