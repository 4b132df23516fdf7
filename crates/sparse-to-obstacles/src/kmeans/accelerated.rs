//! The same assignment as Lloyd's, with most points proved unchanged by distance bounds.
//!
//! Each point keeps an upper bound of the distance to its centroid and a lower bound of the distance to
//! every other one. When the centroids move, the bounds widen: the upper one by the movement of the point's centroid, the lower one by
//! the largest movement among that centroid's neighbours, since those farther away cannot matter. While upper < lower the label
//! cannot change, nor while the point is nearer to its centroid than half the way to the next one. The other points search the
//! neighbours of their centroid for the two nearest; where these do not reach far enough, a k-d tree of all centroids.
//! Bounds are kept a little slack, so that rounding can only cause a search, never a wrong label: the
//! labels equal Lloyd's bit for bit, ties included.
//!
//! References: Hamerly, "Making k-means even faster", SDM 2010; Rysavy and Hamerly, "Geometric methods to accelerate k-means algorithms",
//! SDM 2016 (movement of the neighbours only).

use super::iterate::Assignment;
use super::neighbours::{Drift, Neighbours, at_least, at_most};
use super::tree::CentroidTree;
use crate::vector::{Vec3, distance};
use std::sync::OnceLock;

pub(super) struct Accelerated {
    bounds: Vec<Bounds>,
    neighbours: Option<Neighbours>,
    /// How the centroids moved since the bounds were updated; empty if they did not.
    drifts: Vec<Drift>,
}

#[derive(Clone, Copy)]
struct Bounds {
    upper: f64,
    lower: f64,
}

impl Bounds {
    const UNKNOWN: Bounds = Bounds {
        upper: f64::INFINITY,
        lower: 0.0,
    };

    fn widen(&mut self, drift: Drift) {
        self.upper = at_most(self.upper + drift.own);
        let listed = self.lower - drift.listed;
        self.lower = at_least(listed.min(drift.reach - self.upper));
    }
}

/// What all points share during one assignment.
struct Pass<'a> {
    centroids: &'a [Vec3],
    neighbours: &'a Neighbours,
    drifts: &'a [Drift],
    /// Of the centroids, made when it is first needed.
    tree: &'a OnceLock<CentroidTree>,
}

impl Pass<'_> {
    #[inline]
    fn assign(&self, point: Vec3, bounds: &mut Bounds, label: &mut usize) {
        if let Some(&drift) = self.drifts.get(*label) {
            bounds.widen(drift);
            if bounds.upper < bounds.lower {
                return;
            }
        }
        bounds.upper = at_most(distance(point, self.centroids[*label]));
        let apart = at_least(self.neighbours.nearest_gap(*label) - bounds.upper);
        bounds.lower = bounds.lower.max(apart);
        if bounds.upper < bounds.lower {
            return;
        }
        let near = self.neighbours.nearest_two(self.centroids, point, *label);
        let nearest = near.unwrap_or_else(|| tree(self.tree, self.centroids).nearest_two(point));
        *label = nearest.index;
        bounds.upper = at_most(nearest.squared.sqrt());
        bounds.lower = at_least(nearest.second_squared.sqrt());
    }
}

fn tree<'a>(made: &'a OnceLock<CentroidTree>, centroids: &[Vec3]) -> &'a CentroidTree {
    made.get_or_init(|| CentroidTree::new(centroids))
}

impl Accelerated {
    pub(super) fn new(points: usize) -> Self {
        Accelerated {
            bounds: vec![Bounds::UNKNOWN; points],
            neighbours: None,
            drifts: Vec::new(),
        }
    }
}

impl Assignment for Accelerated {
    fn assign(&mut self, points: &[Vec3], centroids: &[Vec3], labels: &mut [usize]) {
        let made = OnceLock::new();
        let neighbours = match self.neighbours.take() {
            None => Neighbours::new(centroids, tree(&made, centroids)),
            Some(mut neighbours) => {
                neighbours.refresh(centroids, || tree(&made, centroids));
                neighbours
            }
        };
        let pass = Pass {
            centroids,
            neighbours: &neighbours,
            drifts: &self.drifts,
            tree: &made,
        };
        assign_all(&pass, points, &mut self.bounds, labels);
        self.neighbours = Some(neighbours);
    }

    fn moved(&mut self, before: &[Vec3], after: &[Vec3]) {
        if let Some(neighbours) = &mut self.neighbours {
            self.drifts = neighbours.moved(before, after);
        }
    }

    fn relabelled(&mut self, point: usize) {
        self.bounds[point] = Bounds::UNKNOWN;
    }
}

#[cfg(not(feature = "rayon"))]
fn assign_all(pass: &Pass<'_>, points: &[Vec3], bounds: &mut [Bounds], labels: &mut [usize]) {
    for ((point, label), bounds) in points.iter().zip(labels).zip(bounds) {
        pass.assign(*point, bounds, label);
    }
}

#[cfg(feature = "rayon")]
fn assign_all(pass: &Pass<'_>, points: &[Vec3], bounds: &mut [Bounds], labels: &mut [usize]) {
    use rayon::prelude::*;
    points
        .par_iter()
        .zip(labels.par_iter_mut())
        .zip(bounds.par_iter_mut())
        .with_min_len(1024)
        .for_each(|((point, label), bounds)| pass.assign(*point, bounds, label));
}
