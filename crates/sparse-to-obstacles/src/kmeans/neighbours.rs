//! Which centroids lie near which: the few that a point can prefer to the one it belongs to.
//!
//! Each centroid a has a list of its nearest others c, nearest first. For a point x no farther than u from a, the triangle
//! inequality says |x − c| ≥ |a − c| − u. So the list is read until |a − c| > u + (distance to the second nearest so far), which is after
//! some ten of hundreds; where the list ends before that, the caller has to search by other means.
//! When the centroids move, the distances on the lists are computed anew, and what is on no list is as near as before less the two
//! movements; a list is made again when that has become much nearer.
//! Cost: K lists of `LISTED` entries by a k-d tree, O(K log K); O(K) per movement of all centroids.
//!
//! References: Newling and Fleuret, "Fast k-means with accurate bounds", ICML 2016 (Exponion), from which it departs by short lists.

use super::tree::{CentroidTree, NearestTwo};
use crate::vector::{Vec3, distance, distance_squared};

/// Relative slack of the bounds: far above the rounding of the few operations between refreshes.
pub(super) const SLACK: f64 = 1e-9;
/// Absolute slack: squares of shorter distances have lost digits.
pub(super) const LEAST: f64 = 1e-150;

/// Entries of a list. Points on surfaces need about ten, those at the rim of a large cluster twice as many.
const LISTED: usize = 16;
/// A list is made again when what is not on it may be this much nearer than when it was made.
const WORN: f64 = 0.65;

/// At most this distance, for what was computed in floating point.
#[inline]
pub(super) fn at_most(computed: f64) -> f64 {
    computed * (1.0 + SLACK) + LEAST
}

/// At least this distance, for what was computed in floating point.
#[inline]
pub(super) fn at_least(computed: f64) -> f64 {
    computed * (1.0 - SLACK) - LEAST
}

pub(super) struct Neighbours {
    lists: Vec<List>,
}

struct List {
    /// Lower bounds of the distances, with the centroids that are so far away; ascending.
    entries: Vec<(f64, u32)>,
    /// No centroid without an entry is nearer; infinite where all have one.
    reach: f64,
    /// What `reach` was when the list was made.
    made_with: f64,
}

/// What a movement of all centroids does to the points of one.
#[derive(Clone, Copy)]
pub(super) struct Drift {
    /// Largest movement of the centroid itself.
    pub(super) own: f64,
    /// Largest movement of those on its list.
    pub(super) listed: f64,
    /// How near it those without an entry are at least, after the movement.
    pub(super) reach: f64,
}

impl Neighbours {
    pub(super) fn new(centroids: &[Vec3], tree: &CentroidTree) -> Self {
        let lists = (0..centroids.len()).map(|own| List::new(own, centroids, tree));
        Neighbours {
            lists: lists.collect(),
        }
    }

    /// The centroids moved. Lists keep their entries until [`refresh`](Self::refresh).
    pub(super) fn moved(&mut self, before: &[Vec3], after: &[Vec3]) -> Vec<Drift> {
        let moves: Vec<f64> = before
            .iter()
            .zip(after)
            .map(|(a, b)| at_most(distance(*a, *b)))
            .collect();
        let largest = moves.iter().copied().fold(0.0, f64::max);
        let lists = self.lists.iter_mut().zip(&moves);
        lists
            .map(|(list, &own)| {
                list.reach = at_least(list.reach - at_most(own + largest));
                let listed = list.entries.iter().map(|entry| moves[entry.1 as usize]);
                Drift {
                    own,
                    listed: listed.fold(0.0, f64::max),
                    reach: list.reach,
                }
            })
            .collect()
    }

    /// Brings the lists up to where the centroids are now.
    pub(super) fn refresh<'a>(&mut self, centroids: &[Vec3], tree: impl Fn() -> &'a CentroidTree) {
        for (own, list) in self.lists.iter_mut().enumerate() {
            if list.reach < WORN * list.made_with {
                *list = List::new(own, centroids, tree());
            } else {
                list.measure(own, centroids);
            }
        }
    }

    /// Every other centroid is at least so far from this one.
    #[inline]
    pub(super) fn nearest_gap(&self, own: usize) -> f64 {
        let list = &self.lists[own];
        list.entries
            .first()
            .map_or(list.reach, |nearest| nearest.0.min(list.reach))
    }

    /// The two centroids nearest to a point that lies near `own`, or `None` where a list is too short to tell.
    #[inline]
    pub(super) fn nearest_two(
        &self,
        centroids: &[Vec3],
        point: Vec3,
        own: usize,
    ) -> Option<NearestTwo> {
        let mut best = NearestTwo::NONE;
        let squared = distance_squared(point, centroids[own]);
        best.offer(own, squared);
        let to_own = at_most(squared.sqrt());
        let mut limit = f64::INFINITY;
        let mut second = f64::INFINITY;
        let list = &self.lists[own];
        for &(gap, other) in &list.entries {
            if gap > limit {
                break;
            }
            best.offer(
                other as usize,
                distance_squared(point, centroids[other as usize]),
            );
            if best.second_squared < second {
                second = best.second_squared;
                limit = at_most(to_own + at_most(second.sqrt()));
            }
        }
        (list.reach > limit).then_some(best)
    }
}

impl List {
    fn new(own: usize, centroids: &[Vec3], tree: &CentroidTree) -> Self {
        let mut nearest = tree.nearest_others(centroids[own], own, LISTED + 1);
        // The last one is not on the list, it says how far the others are.
        let reach = if nearest.len() > LISTED {
            nearest
                .pop()
                .map_or(f64::INFINITY, |last| at_least(last.0.sqrt()))
        } else {
            f64::INFINITY
        };
        for entry in &mut nearest {
            entry.0 = at_least(entry.0.sqrt());
        }
        List {
            entries: nearest,
            reach,
            made_with: reach,
        }
    }

    fn measure(&mut self, own: usize, centroids: &[Vec3]) {
        for at in 0..self.entries.len() {
            let other = self.entries[at].1;
            let gap = at_least(distance(centroids[own], centroids[other as usize]));
            let mut to = at;
            while to > 0 && self.entries[to - 1].0 > gap {
                self.entries[to] = self.entries[to - 1];
                to -= 1;
            }
            self.entries[to] = (gap, other);
        }
    }
}
