//! The ranged reading: distances divided by viewing ranges, costs from what the cameras saw.
//!
//! ```text
//! d(u, v)    = ‖u − v‖ / (r(u) r(v))^0.4, r the median range from the observing cameras
//! D(u)       = mean of d to the 20 nearest neighbours
//! s(u, v)    = 1 / (1 + (D(u) + d(u, v)) / unit), u ≠ v
//! cue(v)     = (wide depth disagreement + 0.02)^0.25 (near one + 0.02)^0.15 (1 + violations)^0.1
//! θ(v)       = 1 / (1 + T σ / (cue(v) unit)), σ = median over v of cue(v) min over u of D(u) + d(u, v)
//! ln T       = 0.08 / q, 0.9 to 2.2, q = the near disagreement that one point in ten exceeds
//! ```
//!
//! So v stays if some other point in a dense neighbourhood is near, as seen from where it was seen; a
//! point that disagrees with its image neighbours' depth or stands in free space must be nearer. Any
//! s ≥ 0 and any λ ≥ 0 are legal, hence so are these. How much is tolerated, T, follows from how many
//! points have no image neighbour at their depth: a map of a single camera with 10 % of outliers and
//! one of a depth camera with 1 % differ in that, and not in how their distances are distributed.

use super::config::{OutlierConfig, Tolerance};
use super::depth_agreement::DepthDisagreement;
use super::problem::{Problem, Score};
use super::sight::Sight;
use super::violations::violations;
use crate::neighbours::{NeighbourGraph, RangeTree};
use crate::points::{Cloud, median};

/// The problem of the cloud; `None` when it has no spacing (n < 5, or most points identical).
pub(super) fn problem(cloud: &Cloud, sight: &Sight<'_>, config: &OutlierConfig) -> Option<Problem> {
    if cloud.len() < 5 {
        return None;
    }
    let powered = |r: f64| r.powf(config.rays.range_exponent);
    let ranges: Vec<f64> = ranges(cloud, sight)?.into_iter().map(powered).collect();
    let tree = RangeTree::new(&cloud.points, &ranges);
    let graph = NeighbourGraph::new(&tree, config.rays.neighbours, f64::INFINITY);
    let mean =
        |v: usize| graph.row(v).iter().map(|n| n.0.sqrt()).sum::<f64>() / graph.row(v).len() as f64;
    let density: Vec<f64> = (0..cloud.len()).map(mean).collect();
    let nearest = |v: usize| {
        let through = graph
            .row(v)
            .iter()
            .map(|&(d, u)| density[u as usize] + d.sqrt());
        through.fold(f64::INFINITY, f64::min)
    };
    let badness: Vec<f64> = (0..cloud.len()).map(nearest).collect();
    let depth = DepthDisagreement::new(cloud, sight);
    let cues = cues(cloud, sight, &depth, config);
    let unit = median(&mut badness.clone());
    let mut judged: Vec<f64> = badness.iter().zip(&cues).map(|(b, c)| b * c).collect();
    let allowed = tolerance(config, &depth) * median(&mut judged);
    if !(unit > 0.0 && allowed > 0.0) {
        return None;
    }
    let threshold = cues
        .iter()
        .map(|cue| 1.0 / (1.0 + allowed / (cue * unit)))
        .collect();
    let beta = config.beta.value(cloud.len());
    Some(Problem {
        graph,
        score: Score::Density { density, unit },
        threshold,
        beta,
    })
}

/// The median range of every point, that of the nearest observed point where nothing observes it.
fn ranges(cloud: &Cloud, sight: &Sight<'_>) -> Option<Vec<f64>> {
    let mut ranges: Vec<f64> = (0..cloud.len()).map(|v| sight.range(cloud, v)).collect();
    let observed: Vec<usize> = (0..cloud.len()).filter(|&v| !ranges[v].is_nan()).collect();
    let typical = median(&mut observed.iter().map(|&v| ranges[v]).collect::<Vec<_>>());
    if typical <= 0.0 {
        return None;
    }
    if observed.len() < cloud.len() {
        let known: Vec<[f64; 3]> = observed.iter().map(|&v| cloud.points[v]).collect();
        let tree = RangeTree::new(&known, &[]);
        for v in 0..cloud.len() {
            if ranges[v].is_nan() {
                let near = tree.nearest_to(cloud.points[v]);
                ranges[v] = near.map_or(typical, |at| ranges[observed[at as usize]]);
            }
        }
    }
    let least = NEAREST_RANGE * typical;
    Some(ranges.into_iter().map(|r| r.max(least)).collect())
}

/// What the observations say against each point, above 0; 1 is neutral only by comparison.
fn cues(
    cloud: &Cloud,
    sight: &Sight<'_>,
    depth: &DepthDisagreement,
    config: &OutlierConfig,
) -> Vec<f64> {
    let rays = &config.rays;
    let mut cues = vec![1.0; cloud.len()];
    for (disagreement, exponent) in [
        (&depth.wide, rays.depth_exponent),
        (&depth.near, rays.near_depth_exponent),
    ] {
        for (cue, disagreement) in cues.iter_mut().zip(disagreement) {
            *cue *= (disagreement + DEPTH_FLOOR).min(1e6).powf(exponent);
        }
    }
    if rays.violation_exponent > 0.0 {
        for (cue, count) in cues.iter_mut().zip(violations(cloud, sight, rays)) {
            *cue *= (1.0 + f64::from(count)).powf(rays.violation_exponent);
        }
    }
    cues
}

/// How many times the median badness is kept.
fn tolerance(config: &OutlierConfig, depth: &DepthDisagreement) -> f64 {
    match (config.rays.tolerance, depth.dirt) {
        (Tolerance::Fixed(times), _) => times,
        (Tolerance::Measured, None) => LOG_TOLERANCE.1.exp(),
        (Tolerance::Measured, Some(dirt)) => {
            let (least, _, most) = LOG_TOLERANCE;
            (TOLERATED_DIRT / dirt).clamp(least, most).exp()
        }
    }
}

/// The least log tolerance, that without any camera that can tell, the largest.
const LOG_TOLERANCE: (f64, f64, f64) = (0.9, 1.3, 2.2);
/// The log tolerance times the near disagreement that one point in ten exceeds.
const TOLERATED_DIRT: f64 = 0.08;
/// Disagreements below this log ratio (2 %) are noise.
const DEPTH_FLOOR: f64 = 0.02;
/// Ranges count as at least this part of the median range.
const NEAREST_RANGE: f64 = 1e-3;
