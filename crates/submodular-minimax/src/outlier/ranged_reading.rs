//! The ranged reading: distances divided by viewing ranges, costs from what the cameras saw.
//!
//! ```text
//! d(u, v)    = ‖u − v‖ / (r(u) r(v))^(e/2), r the median range from the observing cameras
//! D(u)       = mean of d to the 20 nearest neighbours
//! s(u, v)    = 1 / (1 + (D(u) + d(u, v)) / unit), u ≠ v
//! cue(v)     = Π of what the observations say, each to its power
//! θ(v)       = 1 / (1 + T σ / (cue(v) unit)), σ = median over v of cue(v) min over u of D(u) + d(u, v)
//!
//!              e    wide   near   1 + violations   r / median r   parallax   coarseness   1 + hiding   T
//! triangulated 1    1      0.5    0.6              0              0          0            0            10
//! measured     0.8  0      0.2    0.2              0.1            0.3        0.5          0.1          exp(2 s^0.7)
//! one position 0.8  0.25   0.15   0.1              0              0          0            0            exp(0.08 / q)
//! ```
//!
//! Wide and near are disagreements in depth with image neighbours, plus 0.02, q the near one that one point in ten
//! exceeds; parallax has 0.005 added; coarseness is the largest distance from which the point's feature can be
//! recognised, over r; s is ln(ninth decile / median) of cue(v) min over u of D(u) + d(u, v).
//! So v stays if some other point in a dense neighbourhood is near, as seen from where it was seen; a
//! point that disagrees with its image neighbours' depth or stands in free space must be nearer. Any
//! s ≥ 0 and any λ ≥ 0 are legal, hence so are these. Which row holds, the observations tell: see
//! [`DepthSource`].

use super::config::{OutlierConfig, RayConfig};
use super::cues::{Cues, DepthSource, Tolerance, told};
use super::depth_agreement::DepthDisagreement;
use super::passing_rays::passing_rays;
use super::problem::{Problem, Score};
use super::sight::Sight;
use crate::neighbours::{NeighbourGraph, RangeTree};
use crate::points::{Cloud, median};

/// The problem of the cloud; `None` when it has no spacing (n < 5, or most points identical).
pub(super) fn problem(cloud: &Cloud, sight: &Sight<'_>, config: &OutlierConfig) -> Option<Problem> {
    if cloud.len() < 5 {
        return None;
    }
    let weights = weights(sight, config);
    let ranges = ranges(cloud, sight)?;
    let powered: Vec<f64> = (ranges.iter())
        .map(|r| r.powf(weights.range_exponent))
        .collect();
    let tree = RangeTree::new(&cloud.points, &powered);
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
    let wide = (weights.depth_exponent > 0.0).then_some(weights.depth_neighbours);
    let depth = DepthDisagreement::new(cloud, sight, wide);
    let mut cues = depth_cues(&depth, weights);
    sight_cues(cloud, sight, &ranges, (weights, &config.rays), &mut cues);
    let unit = median(&mut badness.clone());
    let mut judged: Vec<f64> = badness.iter().zip(&cues).map(|(b, c)| b * c).collect();
    let allowed = tolerance(weights, &depth, &mut judged) * median(&mut judged);
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

/// The weights that hold for the map.
fn weights<'a>(sight: &Sight<'_>, config: &'a OutlierConfig) -> &'a Cues {
    let rays = &config.rays;
    let source = match rays.source {
        DepthSource::Observed => told(sight),
        known => Some(known),
    };
    match source {
        None => &rays.one_position,
        Some(DepthSource::Measured) => &rays.measured,
        Some(_) => &rays.triangulated,
    }
}

/// What image neighbours say against each point, above 0; 1 is neutral only by comparison.
fn depth_cues(depth: &DepthDisagreement, weights: &Cues) -> Vec<f64> {
    let raised = |disagreement: f64, exponent| (disagreement + DEPTH_FLOOR).min(1e6).powf(exponent);
    let both = depth.wide.iter().zip(&depth.near);
    both.map(|(&wide, &near)| {
        raised(wide, weights.depth_exponent) * raised(near, weights.near_depth_exponent)
    })
    .collect()
}

/// Multiplies in what range, parallax and violations say.
fn sight_cues(
    cloud: &Cloud,
    sight: &Sight<'_>,
    ranges: &[f64],
    (weights, rays): (&Cues, &RayConfig),
    cues: &mut [f64],
) {
    if weights.far_exponent > 0.0 {
        let typical = median(&mut ranges.to_vec());
        for (cue, range) in cues.iter_mut().zip(ranges) {
            *cue *= (range / typical).powf(weights.far_exponent);
        }
    }
    if weights.parallax_exponent > 0.0 {
        for (v, cue) in cues.iter_mut().enumerate() {
            let parallax = sight.parallax(cloud, v);
            *cue *= (parallax + PARALLAX_FLOOR).powf(weights.parallax_exponent);
        }
    }
    if weights.coarseness_exponent > 0.0 {
        for (cue, coarseness) in cues.iter_mut().zip(coarseness(cloud, sight, ranges)) {
            *cue *= coarseness.powf(weights.coarseness_exponent);
        }
    }
    let (violating, hiding) = (weights.violation_exponent, weights.hidden_exponent);
    if violating > 0.0 || hiding > 0.0 {
        let rays = passing_rays(cloud, sight, rays, hiding > 0.0);
        for (cue, rays) in cues.iter_mut().zip(rays) {
            *cue *= (1.0 + f64::from(rays.violating)).powf(violating);
            *cue *= (1.0 + f64::from(rays.hiding)).powf(hiding);
        }
    }
}

/// The largest distance from which each feature can be recognised, in ranges; the median where unknown, 1 if all are.
fn coarseness(cloud: &Cloud, sight: &Sight<'_>, ranges: &[f64]) -> Vec<f64> {
    let times = |v: usize| {
        let distance = sight.views.max_distance(v)? / cloud.unit;
        Some((distance / ranges[v]).clamp(1.0 / MOST_COARSE, MOST_COARSE))
    };
    let all: Vec<Option<f64>> = (0..cloud.len()).map(times).collect();
    let mut known: Vec<f64> = all.iter().copied().flatten().collect();
    let typical = if known.is_empty() {
        1.0
    } else {
        median(&mut known)
    };
    all.into_iter().map(|c| c.unwrap_or(typical)).collect()
}

/// How many times the median badness is kept.
fn tolerance(weights: &Cues, depth: &DepthDisagreement, judged: &mut [f64]) -> f64 {
    match (weights.tolerance, depth.dirt) {
        (Tolerance::Fixed(times), _) => times,
        (Tolerance::BySpread(times), _) => {
            let typical = median(judged);
            let at = judged.len() * 9 / 10;
            let high = *judged.select_nth_unstable_by(at, f64::total_cmp).1;
            let (least, most) = LOG_SPREAD_TOLERANCE;
            let spread = (high / typical).ln().powf(SPREAD_EXPONENT);
            (times * spread).clamp(least, most).exp()
        }
        (Tolerance::ByDirt { least }, dirt) => {
            let (untold, most) = LOG_TOLERANCE;
            let told = dirt.map_or(untold, |dirt| TOLERATED_DIRT / dirt);
            told.min(most).exp().max(least)
        }
    }
}

/// The log tolerance without any camera that can tell, and the largest.
const LOG_TOLERANCE: (f64, f64) = (1.3, 2.2);
/// The spread is shrunk towards the usual one, which is a little below 1.
const SPREAD_EXPONENT: f64 = 0.7;
/// The least and the largest log tolerance that the spread can lead to.
const LOG_SPREAD_TOLERANCE: (f64, f64) = (1.0, 3.0);
/// The log tolerance times the near disagreement that one point in ten exceeds.
const TOLERATED_DIRT: f64 = 0.08;
/// Disagreements below this log ratio (2 %) are noise.
const DEPTH_FLOOR: f64 = 0.02;
/// Features are at most this many times as coarse, or as fine, as their range.
const MOST_COARSE: f64 = 1e6;
/// Parallax below this many radians is noise.
const PARALLAX_FLOOR: f64 = 0.005;
/// Ranges count as at least this part of the median range.
const NEAREST_RANGE: f64 = 1e-3;
