//! Shortest path over some vertices of a path, with few validity checks.
//!
//! Nodes are the vertices p₀ … pₙ₋₁, edges i → j for i < j whose straight motion is free. Method: for j = 1 … n−1 the
//! edges into j are taken in the order of Dᵢ + |pᵢ pⱼ|; the first that is free gives Dⱼ, all others stay unchecked. An edge is
//! left out when even the straight way on to the end would make the whole longer than a way that is known: the bound given, or
//! Dᵢ and the rest of the old path. In clutter some 60 % of all pairs remain to be checked; a search that spares no thought (lazy A*, or
//! following the optimistic shortest path) needs 50 % and takes longer.
//!
//! Equal sums: the earliest origin, so the fewest of collinear vertices. Sums run from the first vertex, as those of
//! [`Path::length`](crate::Path::length) do: a result is never longer than its input, to the last bit.

use std::cmp::Ordering;

use crate::euclid::distance;
use crate::motion::MotionValidator;

/// What is known before the search.
#[derive(Clone, Copy)]
pub(super) enum Known {
    /// The segments between neighbours are free.
    SegmentsFree,
    /// Nothing but that only a way cheaper than this is of use.
    Bound(f64),
}

/// The cheapest way, and what was spent on it.
pub(super) struct Way {
    /// Indices of its vertices, ascending; `None` where every way is blocked or too dear.
    pub(super) vertices: Option<Vec<usize>>,
    /// Sum of the costs of its edges.
    pub(super) cost: f64,
    pub(super) checks: usize,
}

/// Rounding errors of the sums that are compared, as a share.
const ROUNDING: f64 = 1e-12;

/// Finds the cheapest way from the first to the last of `points` (at least one).
///
/// `cost` of a motion counts as its length where it is less, or NaN. Edges that are not checked when `max_checks` are spent count
/// as blocked.
pub(super) fn cheapest_way<const D: usize>(
    points: &[[f64; D]],
    motion_is_free: &impl MotionValidator<D>,
    known: Known,
    max_checks: usize,
    cost: &impl Fn(&[f64; D], &[f64; D]) -> f64,
) -> Way {
    let last = points.len() - 1;
    let rest = rest_of_way(points, known, cost);
    let mut search = Search {
        points,
        known,
        limit: match known {
            Known::SegmentsFree => rest[0],
            Known::Bound(bound) => bound,
        },
        reached: vec![f64::INFINITY; points.len()],
        before: vec![0; points.len()],
        straight: None,
        checks: 0,
        max_checks,
    };
    search.reached[0] = 0.0;
    if !search.try_straight(motion_is_free, cost) {
        let mut edges = Edges::default();
        for (to, rest) in rest.iter().enumerate().skip(1) {
            search.reach(to, &mut edges, motion_is_free, cost);
            search.limit = search.limit.min(search.reached[to] + rest);
        }
    }
    Way {
        vertices: search.way(),
        cost: search.reached[last],
        checks: search.checks,
    }
}

/// Cost from each vertex to the last along the old path; infinite where that is not known to be free.
fn rest_of_way<const D: usize>(
    points: &[[f64; D]],
    known: Known,
    cost: &impl Fn(&[f64; D], &[f64; D]) -> f64,
) -> Vec<f64> {
    let mut rest = vec![f64::INFINITY; points.len()];
    rest[points.len() - 1] = 0.0;
    if matches!(known, Known::SegmentsFree) {
        for vertex in (1..points.len()).rev() {
            rest[vertex - 1] = rest[vertex] + weigh(&points[vertex - 1], &points[vertex], cost);
        }
    }
    rest
}

/// The cost, or the length where the cost is less or NaN.
fn weigh<const D: usize>(
    from: &[f64; D],
    to: &[f64; D],
    cost: &impl Fn(&[f64; D], &[f64; D]) -> f64,
) -> f64 {
    cost(from, to).max(distance(from, to))
}

struct Search<'a, const D: usize> {
    points: &'a [[f64; D]],
    known: Known,
    /// No way dearer than this is of use.
    limit: f64,
    /// Least cost of a way to each vertex.
    reached: Vec<f64>,
    /// The vertex before it on that way.
    before: Vec<usize>,
    /// Whether the motion from the first vertex to the last is free, once that was asked.
    straight: Option<bool>,
    checks: usize,
    max_checks: usize,
}

impl<const D: usize> Search<'_, D> {
    /// Checks the motion from the first vertex to the last, which no search can do without; true when it is the answer.
    fn try_straight(
        &mut self,
        motion_is_free: &impl MotionValidator<D>,
        cost: &impl Fn(&[f64; D], &[f64; D]) -> f64,
    ) -> bool {
        let last = self.points.len() - 1;
        let length = distance(&self.points[0], &self.points[last]);
        let sum = weigh(&self.points[0], &self.points[last], cost);
        if last < 2 || sum > self.limit {
            return false;
        }
        let free = self.is_free(0, last, motion_is_free);
        self.straight = Some(free);
        if !free {
            return false;
        }
        self.limit = sum;
        self.reached[last] = sum;
        sum <= length
    }

    /// Finds the best way to the vertex `to`.
    fn reach(
        &mut self,
        to: usize,
        edges: &mut Edges,
        motion_is_free: &impl MotionValidator<D>,
        cost: &impl Fn(&[f64; D], &[f64; D]) -> f64,
    ) {
        let end = &self.points[to];
        let last = &self.points[self.points.len() - 1];
        let most = self.limit * (1.0 + ROUNDING) - distance(end, last);
        edges.fill((0..to).filter_map(|from| {
            let before = self.reached[from];
            let near = before <= most;
            let sum = near.then(|| before + distance(&self.points[from], end));
            sum.filter(|sum| *sum <= most).map(|sum| Edge { sum, from })
        }));
        while let Some((edge, weighed)) = edges.pop() {
            let Edge { sum, from } = edge;
            if !weighed {
                let sum = self.reached[from] + weigh(&self.points[from], end, cost);
                if sum > edge.sum {
                    edges.push_weighed(Edge { sum, from });
                    continue;
                }
            }
            if self.is_free(from, to, motion_is_free) {
                (self.reached[to], self.before[to]) = (sum, from);
                return;
            }
        }
    }

    fn is_free(
        &mut self,
        from: usize,
        to: usize,
        motion_is_free: &impl MotionValidator<D>,
    ) -> bool {
        if from + 1 == to && matches!(self.known, Known::SegmentsFree) {
            return true;
        }
        if let (Some(free), true) = (self.straight, from == 0 && to + 1 == self.points.len()) {
            return free;
        }
        if self.checks == self.max_checks {
            return false;
        }
        self.checks += 1;
        motion_is_free.is_free(&self.points[from], &self.points[to])
    }

    fn way(&self) -> Option<Vec<usize>> {
        let mut vertex = self.points.len() - 1;
        if !self.reached[vertex].is_finite() {
            return None;
        }
        let mut way = vec![vertex];
        while vertex != 0 {
            vertex = self.before[vertex];
            way.push(vertex);
        }
        way.reverse();
        Some(way)
    }
}

/// An edge into the vertex at hand, and the cost of the way through it: from below while it is not weighed.
#[derive(Clone, Copy)]
struct Edge {
    sum: f64,
    from: usize,
}

/// Edges into one vertex, cheapest first. Weighing rarely changes the order, so one sorted list and few insertions will do.
#[derive(Default)]
struct Edges {
    /// Not weighed, the cheapest at the end.
    sorted: Vec<Edge>,
    /// Weighed and found dearer, the cheapest at the end.
    weighed: Vec<Edge>,
}

impl Edges {
    /// Starts anew with edges that are not weighed.
    fn fill(&mut self, edges: impl Iterator<Item = Edge>) {
        self.weighed.clear();
        self.sorted.clear();
        self.sorted.extend(edges);
        self.sorted.sort_unstable_by(dearest_first);
    }

    fn push_weighed(&mut self, edge: Edge) {
        let place = self
            .weighed
            .partition_point(|other| dearest_first(other, &edge).is_lt());
        self.weighed.insert(place, edge);
    }

    /// The cheapest edge, and whether it is weighed.
    fn pop(&mut self) -> Option<(Edge, bool)> {
        let weighed = match (self.sorted.last(), self.weighed.last()) {
            (Some(sorted), Some(weighed)) => dearest_first(sorted, weighed).is_lt(),
            (sorted, _) => sorted.is_none(),
        };
        let list = if weighed {
            &mut self.weighed
        } else {
            &mut self.sorted
        };
        list.pop().map(|edge| (edge, weighed))
    }
}

/// Of equal sums the earliest origin is popped first.
fn dearest_first(a: &Edge, b: &Edge) -> Ordering {
    b.sum.total_cmp(&a.sum).then(b.from.cmp(&a.from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;
    use std::cell::RefCell;

    /// The least cost of a way to each vertex, all edges weighed and asked.
    fn least_costs(points: &[[f64; 2]], free: &[Vec<bool>]) -> Vec<f64> {
        let mut least = vec![f64::INFINITY; points.len()];
        least[0] = 0.0;
        for to in 1..points.len() {
            for from in (0..to).filter(|&from| free[from][to]) {
                least[to] = least[to].min(least[from] + distance(&points[from], &points[to]));
            }
        }
        least
    }

    /// Asks for ways cheaper than the bound: the answer is the best of them, and no motion is asked for that leads past it.
    fn check(points: &[[f64; 2]], free: &[Vec<bool>], bound: f64) -> usize {
        let asked = RefCell::new(Vec::new());
        let index = |p: &[f64; 2]| points.iter().position(|q| q == p).unwrap_or_default();
        let is_free = |a: &[f64; 2], b: &[f64; 2]| {
            asked.borrow_mut().push((index(a), index(b)));
            free[index(a)][index(b)]
        };
        let known = Known::Bound(bound);
        let way = cheapest_way(points, &is_free, known, usize::MAX, &distance);
        let (least, last) = (least_costs(points, free), points.len() - 1);
        if least[last] < bound {
            assert!((way.cost - least[last]).abs() < 1e-9);
        } else {
            assert_eq!(way.vertices, None);
        }
        let asked = asked.into_inner();
        assert_eq!(asked.len(), way.checks);
        for &(from, to) in &asked {
            let ahead = distance(&points[to], &points[last]);
            let straight_on = least[from] + distance(&points[from], &points[to]) + ahead;
            assert!(straight_on <= bound * (1.0 + 1e-9), "{from} -> {to}");
        }
        asked.len()
    }

    #[test]
    fn nothing_is_asked_that_leads_past_the_bound() {
        let mut rng = Pcg64::seed_from_u64(1);
        let mut asked = [0; 3];
        for _ in 0..300 {
            let n = rng.random_range(3..12);
            let mut place = || [rng.random::<f64>(), rng.random::<f64>()];
            let points: Vec<[f64; 2]> = (0..n).map(|_| place()).collect();
            let mut row = || (0..n).map(|_| rng.random_bool(0.3)).collect();
            let free: Vec<Vec<bool>> = (0..n).map(|_| row()).collect();
            let straight = distance(&points[0], &points[n - 1]);
            for (asked, share) in asked.iter_mut().zip([0.99, 1.2, 2.0]) {
                *asked += check(&points, &free, share * straight);
            }
        }
        assert!(asked[0] == 0 && asked[1] > 0 && 2 * asked[1] < asked[2]);
    }

    #[test]
    fn a_dear_straight_way_still_bounds_the_search() {
        // The straight way costs half more than its length; any other is longer.
        let points = [[0.0, 0.0], [0.0, 3.0], [3.0, 3.0], [3.0, 1.0], [1.0, 0.0]];
        let dear = |a: &[f64; 2], b: &[f64; 2]| 1.5 * distance(a, b);
        let free = |_: &[f64; 2], _: &[f64; 2]| true;
        let way = cheapest_way(&points, &free, Known::SegmentsFree, usize::MAX, &dear);
        assert_eq!((way.vertices, way.checks), (Some(vec![0, 4]), 1));
        assert!((way.cost - 1.5).abs() < 1e-12);
    }
}
