//! Does a point lie at the depth of what is seen next to it?
//!
//! A wrong triangulation moves a point along its viewing ray, where it leaves the surface that its
//! image neighbours lie on. For a point v and a camera c: the points that c sees nearest to v in
//! direction and |ln(|cv| / |cu|)| for each. Of all of these one of the middle counts, so that one
//! side of a depth edge may disagree; of the nearest twelve the third smallest, so that v need only
//! be one of a few. Of the first, the middle and the last observer, the median or the largest of the former counts,
//! and the least of the latter.
//! Cost: three searches a point, O(log) each.

use super::cues::{AmongCameras, ImageNeighbours};
use super::sight::Sight;
use crate::neighbours::RangeTree;
use crate::points::{Cloud, median};

/// Of so many nearest image neighbours, the rank of the disagreement that counts.
const NEAR: (usize, usize) = (12, 3);
/// A camera that sees fewer points tells nothing.
const FEWEST: usize = 50;

/// Log ratios of depths, at least 0, one a point; the median where no camera can tell.
pub(super) struct DepthDisagreement {
    /// With the wider image neighbourhood.
    pub(super) wide: Vec<f64>,
    /// With the nearest image neighbours.
    pub(super) near: Vec<f64>,
    /// The disagreement in `near` that one point in ten exceeds; `None` where no camera can tell.
    pub(super) dirt: Option<f64>,
}

impl DepthDisagreement {
    /// Without `wide` only the nearest image neighbours are asked, and the wide disagreement tells nothing.
    pub(super) fn new(cloud: &Cloud, sight: &Sight<'_>, wide: Option<ImageNeighbours>) -> Self {
        let mut seen = vec![Seen::default(); cloud.len()];
        for camera in 0..sight.cameras.len() {
            compare_in_camera(cloud, sight, camera, wide, &mut seen);
        }
        let among = wide.map_or(AmongCameras::Median, |wide| wide.cameras);
        let mut near: Vec<f64> = seen.iter().map(|seen| seen.near).collect();
        let mut wide: Vec<f64> = seen.into_iter().map(|seen| seen.wide(among)).collect();
        fill_unknown(&mut wide);
        let dirt = fill_unknown(&mut near).map(|mut known| {
            let at = known.len() * 9 / 10;
            *known.select_nth_unstable_by(at, f64::total_cmp).1
        });
        Self { wide, near, dirt }
    }
}

/// What up to three cameras say of a point.
#[derive(Clone)]
struct Seen {
    near: f64,
    wide: [f64; 3],
    cameras: usize,
}

impl Default for Seen {
    fn default() -> Self {
        Self {
            near: f64::INFINITY,
            wide: [f64::INFINITY; 3],
            cameras: 0,
        }
    }
}

impl Seen {
    fn add(&mut self, wide: f64) {
        if let Some(place) = self.wide.get_mut(self.cameras) {
            *place = wide;
            self.cameras += 1;
        }
    }

    /// Infinite where no camera can tell.
    fn wide(mut self, among: AmongCameras) -> f64 {
        let known = &mut self.wide[..self.cameras];
        match (known.is_empty(), among) {
            (true, _) => f64::INFINITY,
            (false, AmongCameras::Median) => median(known),
            (false, AmongCameras::Largest) => known.iter().copied().fold(0.0, f64::max),
        }
    }
}

/// Gives what is not known the median of what is, which is returned.
fn fill_unknown(values: &mut [f64]) -> Option<Vec<f64>> {
    let mut known: Vec<f64> = values.iter().copied().filter(|d| d.is_finite()).collect();
    let typical = median(&mut known);
    for value in values.iter_mut().filter(|value| !value.is_finite()) {
        *value = typical;
    }
    (!known.is_empty()).then_some(known)
}

fn compare_in_camera(
    cloud: &Cloud,
    sight: &Sight<'_>,
    camera: usize,
    wide: Option<ImageNeighbours>,
    compared: &mut [Seen],
) {
    let seen = &sight.seen[camera];
    if seen.len() < FEWEST {
        return;
    }
    let (directions, log_depth): (Vec<[f64; 3]>, Vec<f64>) = (seen.iter())
        .map(|&v| sight.bearing(cloud, camera, v as usize))
        .map(|(direction, depth)| (direction, depth.ln()))
        .unzip();
    let neighbours = wide.map_or(NEAR.0, |wide| wide.count);
    let tree = RangeTree::new(&directions, &[]);
    let (mut found, mut disagreements) = (Vec::new(), Vec::new());
    for (position, &at) in tree.order().iter().enumerate() {
        let v = seen[at as usize] as usize;
        if !asked(sight.views.row(v), camera) {
            continue;
        }
        tree.nearest(position, neighbours, f64::INFINITY, &mut found);
        let own = log_depth[at as usize];
        disagreements.clear();
        disagreements.extend((found.iter()).map(|n| disagreement(own, log_depth[n.1 as usize])));
        compared[v].near = (compared[v].near).min(smallest(&mut disagreements[..NEAR.0], NEAR.1));
        if let Some(wide) = wide {
            let rank = wide.rank.min(disagreements.len());
            compared[v].add(smallest(&mut disagreements, rank));
        }
    }
}

/// The `rank`th smallest, counted from 1.
fn smallest(values: &mut [f64], rank: usize) -> f64 {
    *values.select_nth_unstable_by(rank - 1, f64::total_cmp).1
}

/// Whether the camera is the first, the middle or the last observer.
fn asked(observers: &[u32], camera: usize) -> bool {
    let is = |at: usize| observers.get(at).is_some_and(|&c| c as usize == camera);
    is(0) || is(observers.len() / 2) || is(observers.len().saturating_sub(1))
}

/// Of two logarithms of depths; that of a point at the camera is infinite, and disagrees with all.
fn disagreement(a: f64, b: f64) -> f64 {
    let difference = (a - b).abs();
    if difference.is_finite() {
        difference
    } else {
        f64::MAX
    }
}
