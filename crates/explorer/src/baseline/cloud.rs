//! Finite points with exact nearest neighbours from an R*-tree.
//!
//! The tree holds each place once, with the points that lie there, so that thousands of equal points cost
//! no more than others. Neighbours come nearest first, ties by index: the order of the input changes nothing.
//! Cost: O(n log n) to build, O(log n + k) expected a query.

use rstar::RTree;
use rstar::primitives::GeomWithData;
use submodular_minimax::PointLike;

use super::error::BaselineError;

/// Points scaled by a power of two into [-1, 1], so that no squared distance overflows and none is rounded otherwise.
pub(super) struct Cloud {
    points: Vec<[f64; 3]>,
    /// Caller's units per scaled unit, a power of two.
    pub(super) unit: f64,
    tree: RTree<GeomWithData<[f64; 3], usize>>,
    /// The points of each place, ascending.
    stacks: Vec<Vec<usize>>,
}

/// Squared scaled distance and index.
pub(super) type Neighbour = (f64, usize);

impl Cloud {
    /// Checks and scales the points.
    pub(super) fn new<P: PointLike>(points: &[P]) -> Result<Self, BaselineError> {
        let points: Vec<[f64; 3]> = points.iter().map(|&point| point.into()).collect();
        let infinite = |point: &[f64; 3]| !point.iter().all(|x| x.is_finite());
        if let Some(index) = points.iter().position(infinite) {
            return Err(BaselineError::NonFinite { index });
        }
        let unit = power_of_two_above(points.iter().flatten().fold(0.0, |a, x| a.max(x.abs())));
        // Adding zero turns -0 into 0, so that equal places compare as equal.
        let points: Vec<_> = points.iter().map(|p| p.map(|x| x / unit + 0.0)).collect();
        let (places, stacks) = stacked(&points);
        let places = places.into_iter().enumerate();
        let places = places.map(|(place, at)| GeomWithData::new(at, place));
        Ok(Self {
            tree: RTree::bulk_load(places.collect()),
            points,
            unit,
            stacks,
        })
    }

    /// How many points there are.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// The points of each place, ascending.
    pub(super) fn stacks(&self) -> &[Vec<usize>] {
        &self.stacks
    }

    /// The up to `k` nearest others of point `v`, its duplicates among them.
    pub(super) fn nearest(&self, v: usize, k: usize) -> Vec<Neighbour> {
        let mut found: Vec<Neighbour> = Vec::with_capacity(k.min(self.len()) + 1);
        for (place, squared) in (self.tree).nearest_neighbor_iter_with_distance_2(self.points[v]) {
            if found.len() >= k && found.last().is_some_and(|last| squared > last.0) {
                break;
            }
            let others = self.stacks[place.data].iter().filter(|&&u| u != v);
            found.extend(others.take(k).map(|&u| (squared, u)));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(k);
        found
    }

    /// The places within squared scaled distance `limit` of a place, itself included, with their distances.
    pub(super) fn places_within(
        &self,
        place: usize,
        limit: f64,
    ) -> impl Iterator<Item = Neighbour> + '_ {
        let center = self.points[self.stacks[place][0]];
        (self.tree.locate_within_distance(center, limit))
            .map(move |other| (squared_distance(center, *other.geom()), other.data))
    }

    /// The scaled distance from each point to its `k`-th neighbour, infinite where there is none.
    pub(super) fn distances_to_neighbour(&self, k: usize) -> Vec<f64> {
        let distance = |v| {
            let found = self.nearest(v, k);
            found.get(k - 1).map_or(f64::INFINITY, |n| n.0.sqrt())
        };
        (0..self.len()).map(distance).collect()
    }
}

/// The different places and the points at each, in the order of their first points.
fn stacked(points: &[[f64; 3]]) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let compare = |a: &[f64; 3], b: &[f64; 3]| {
        (a[0].total_cmp(&b[0]))
            .then(a[1].total_cmp(&b[1]))
            .then(a[2].total_cmp(&b[2]))
    };
    order.sort_by(|&a, &b| compare(&points[a], &points[b]).then(a.cmp(&b)));
    let mut stacks: Vec<Vec<usize>> = (order.chunk_by(|&a, &b| points[a] == points[b]))
        .map(<[usize]>::to_vec)
        .collect();
    stacks.sort_by_key(|stack| stack[0]);
    (
        stacks.iter().map(|stack| points[stack[0]]).collect(),
        stacks,
    )
}

fn squared_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (x, y, z) = (a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    x * x + y * y + z * z
}

/// The smallest normal power of two not below `value`; 1 for zero.
fn power_of_two_above(value: f64) -> f64 {
    if value == 0.0 {
        return 1.0;
    }
    let exponent = value.log2().ceil().clamp(-1022.0, 1023.0);
    2.0_f64.powi(exponent as i32)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn neighbours_equal_brute_force(
            cells in prop::collection::vec((0..5i8, 0..5i8, 0..2i8), 0..90), k in 1..12usize,
        ) {
            let points: Vec<[f64; 3]> =
                cells.iter().map(|c| [f64::from(c.0), f64::from(c.1), f64::from(c.2)]).collect();
            let cloud = Cloud::new(&points).map_err(|e| TestCaseError::fail(e.to_string()))?;
            for v in 0..points.len() {
                let mut all: Vec<Neighbour> = (0..points.len()).filter(|&u| u != v)
                    .map(|u| (squared_distance(cloud.points[v], cloud.points[u]), u)).collect();
                all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                all.truncate(k);
                prop_assert_eq!(cloud.nearest(v, k), all);
            }
        }
    }
}
