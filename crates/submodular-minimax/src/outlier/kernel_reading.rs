//! Readings D, F, G and H: truncated linear kernels, support, components, ray violations.
//!
//! K(u, v) = (1 − d/h)₊ with h = reach · spacing; support(u) = Σ K(u, ·); w(u) = min(1, support / need),
//! zero where u's component has too few points; θ(v) = (1 + β) λ, plus the cost of violating rays.
//! In the adaptive reading a point that would go but lies on a plane of points that stay is as far from the plane's best supported
//! point as from the plane itself.

use super::config::{OutlierConfig, Reading};
use super::passing_rays::passing_rays;
use super::planes::Planes;
use super::problem::{Problem, Score};
use super::sight::Sight;
use crate::disjoint_sets::DisjointSets;
use crate::neighbours::{Neighbour, NeighbourGraph, RangeTree};
use crate::points::{Cloud, extent, median};

/// The threshold of the strict pass.
const STRICT: f64 = 0.5;
/// How much shorter or longer than configured links may become. In clean clouds the suspects are true
/// points of thin texture, which lie closer together than outliers do.
const SHORTEST: f64 = 6.0 / 7.0;
const LONGEST: f64 = 2.0;
/// How long links may be in a small cloud, in R / n^(1/3) and in reaches; chosen on apartments and rooms of seeds 41 to 56.
const MOST_APART: f64 = 2.2;
const LEAST_PART: f64 = 0.6;
/// Violating rays that count at most.
const MOST_VIOLATIONS: u32 = 5;

/// The problem of the cloud; `None` when it has no spacing (n < 5, or most points identical).
pub(super) fn problem(
    cloud: &Cloud,
    tree: &RangeTree,
    sight: Option<&Sight<'_>>,
    config: &OutlierConfig,
) -> Option<Problem> {
    let n = cloud.len();
    let mut graph = NeighbourGraph::new(tree, config.neighbours, f64::INFINITY);
    let spacing = spacing(&graph)?;
    let beta = config.beta.value(n);
    let mut settings = Settings {
        reach: config.reach * spacing,
        threshold: (1.0 + beta) * config.lambda,
        support: config.support,
        min_component: config.min_component as f64,
    };
    if config.adaptive {
        settings.reach = shortened(settings.reach, cloud);
        graph.truncate(settings.reach * settings.reach);
        settings = settings.adapted(&graph, config.reading, cloud);
    }
    graph.truncate(settings.reach * settings.reach);
    let score = settings.score(&graph, config.reading);
    let mut threshold = vec![settings.threshold; n];
    if let Some(sight) = sight.filter(|_| config.reading == Reading::Rays) {
        let rays = passing_rays(cloud, sight, &config.rays, false);
        for (threshold, rays) in threshold.iter_mut().zip(rays) {
            let count = rays.violating.min(MOST_VIOLATIONS);
            *threshold += config.rays.violation_cost * f64::from(count);
        }
    }
    let mut problem = Problem {
        graph,
        score,
        threshold,
        beta,
    };
    if config.adaptive {
        let links = links_along_planes(cloud, &problem);
        for (v, neighbour) in links {
            problem.graph.link(v, neighbour);
        }
    }
    Some(problem)
}

/// Which points that would go lie on a plane of those that stay: each with the plane's best supported point, and the square of
/// its distance from the plane.
fn links_along_planes(cloud: &Cloud, problem: &Problem) -> Vec<(usize, Neighbour)> {
    let Score::Kernel { weight, .. } = &problem.score else {
        return Vec::new();
    };
    let stays = |v: usize| problem.best(v) > problem.threshold[v];
    let (kept, suspects): (Vec<usize>, Vec<usize>) = (0..cloud.len()).partition(|&v| stays(v));
    if suspects.is_empty() {
        return Vec::new();
    }
    let places: Vec<[f64; 3]> = kept.iter().map(|&v| cloud.points[v]).collect();
    let planes = Planes::new(&places);
    let heavier = |a: &usize, b: &usize| weight[*a].total_cmp(&weight[*b]);
    let supported = |members: &[usize]| members.iter().map(|&at| kept[at]).max_by(heavier);
    let supported: Vec<Option<usize>> = planes.members().map(supported).collect();
    let link = |&v: &usize| {
        let (distance, plane) = planes.nearest(cloud.points[v])?;
        let (u, squared) = (supported[plane]?, distance * distance);
        (problem.score.of(u, squared) > problem.best(v)).then_some((v, (squared, u as u32)))
    };
    suspects.iter().filter_map(link).collect()
}

/// The numbers of one pass, in scaled units.
#[derive(Clone, Copy)]
struct Settings {
    reach: f64,
    threshold: f64,
    support: f64,
    min_component: f64,
}

impl Settings {
    /// Settings for the dirt there is: a strict pass (threshold 0.5) tells which points are suspect.
    ///
    /// Links are as long as the suspects' distances allow, see [`reach_among`]. Up to 12 % every point
    /// counts as an inlier sooner; up to 26 % representatives need more and more support. From 10,000 to
    /// 50,000 points the threshold falls by a quarter, since larger clouds are denser at their core and
    /// not at their fringe. Below 5,000 points true patches are as small as clumps of outliers: the nearest point says more
    /// than how many there are, so smaller components may represent, less support is enough, and the threshold rises. The
    /// numbers were chosen on generated clouds of other seeds than those that docs/measurements.md reports.
    fn adapted(self, graph: &NeighbourGraph, reading: Reading, cloud: &Cloud) -> Self {
        let n = graph.len();
        let score = self.score(graph, reading);
        let threshold = vec![STRICT; n];
        let strict: Problem<&NeighbourGraph> = Problem {
            graph,
            score,
            threshold,
            beta: 1.0,
        };
        let suspects: Vec<[f64; 3]> = (0..n)
            .filter(|&v| strict.best(v) <= STRICT)
            .map(|v| cloud.points[v])
            .collect();
        self.gated(n, suspects.len() as f64 / n as f64, reach_among(&suspects))
    }

    /// What [`Settings::adapted`] says, from the number of points, the share of suspects and the reach among these.
    fn gated(self, n: usize, suspects: f64, reach: Option<f64>) -> Self {
        let dirt = ((suspects - 0.12) / 0.14).clamp(0.0, 1.0);
        let small = (n as f64 / 5e3).clamp(0.1, 1.0);
        let size = ((n as f64 / 1e4).ln() / 5.0_f64.ln()).clamp(0.0, 1.0);
        let reach = reach.unwrap_or(self.reach);
        Self {
            reach: reach.clamp(SHORTEST * self.reach, LONGEST * self.reach),
            threshold: self.threshold * (2.0 + dirt) / 3.0 * (1.0 - size / 4.0) / small.powf(0.2),
            support: self.support * (1.0 + dirt) * small.sqrt(),
            min_component: self.min_component * (1.0 + dirt / 5.0) * small,
        }
    }

    /// Support and components as the reading wants them.
    fn score(&self, graph: &NeighbourGraph, reading: Reading) -> Score {
        let reach = self.reach;
        let mut weight = vec![1.0; graph.len()];
        let kernel = |squared: f64| (1.0 - squared.sqrt() / reach).max(0.0);
        if reading != Reading::Nearest {
            for (u, weight) in weight.iter_mut().enumerate() {
                let support: f64 = graph.row(u).iter().map(|n| kernel(n.0)).sum();
                *weight = (support / self.support).min(1.0);
            }
        }
        if !matches!(reading, Reading::Nearest | Reading::Supported) {
            // In a cloud of a few points the half of them is a component like any other.
            let least = self.min_component.min(graph.len() as f64 / 2.0);
            silence_small_components(graph, least, &mut weight);
        }
        Score::Kernel { reach, weight }
    }
}

/// The reach, unless it is as long as outliers are apart.
///
/// Surfaces get sparser with the root of the number of points, what is spread in space with the cube root only: in small clouds
/// links of some spacings reach from outlier to outlier. They are no longer than [`MOST_APART`] times R / n^(1/3), with R the median
/// distance from the middle, and no shorter than [`LEAST_PART`] of the reach.
fn shortened(reach: f64, cloud: &Cloud) -> f64 {
    let apart = extent(&cloud.points).1 / (cloud.len() as f64).cbrt();
    reach.min((MOST_APART * apart).max(LEAST_PART * reach))
}

/// How long links may be so that half a suspect is to be expected within reach of a suspect.
///
/// Outliers fill the space, so that their number within h grows with h³, and they must not vouch for each
/// other: (h / d)³ = 0.5 / 8, where d is the median distance to the eighth nearest suspect; a clump
/// hardly holds as many. `None` for fewer suspects.
fn reach_among(suspects: &[[f64; 3]]) -> Option<f64> {
    const NEIGHBOUR: usize = 8;
    const EXPECTED: f64 = 0.5;
    let graph = NeighbourGraph::new(&RangeTree::new(suspects, &[]), NEIGHBOUR, f64::INFINITY);
    let last = |v: usize| graph.row(v).get(NEIGHBOUR - 1).map(|n| n.0.sqrt());
    let mut distances: Vec<f64> = (0..graph.len()).filter_map(last).collect();
    let apart = (!distances.is_empty()).then(|| median(&mut distances))?;
    Some(apart * (EXPECTED / NEIGHBOUR as f64).cbrt())
}

/// The median distance to the fourth neighbour; `None` if there is no such, or if it is zero.
fn spacing(graph: &NeighbourGraph) -> Option<f64> {
    let fourth = |v: usize| graph.row(v).get(3).map(|n| n.0.sqrt());
    let mut distances: Vec<f64> = (0..graph.len()).filter_map(fourth).collect();
    let spacing = median(&mut distances);
    (spacing > 0.0).then_some(spacing)
}

fn silence_small_components(graph: &NeighbourGraph, min_component: f64, weight: &mut [f64]) {
    let mut components = DisjointSets::new(graph.len());
    for v in 0..graph.len() {
        for &(_, u) in graph.row(v) {
            components.join(v, u as usize);
        }
    }
    for (u, weight) in weight.iter_mut().enumerate() {
        if (components.size(u) as f64) < min_component {
            *weight = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_reach_2_2_times_as_far_as_points_spread_in_space_are_apart_or_six_tenths_as_far_as_told()
     {
        // A thousand points at distance 1 from the middle: R / n^(1/3) is a tenth.
        let side = |i: usize| [1.0, -1.0][i % 2];
        let at = |i: usize| [0, 1, 2].map(|axis| if i / 2 % 3 == axis { side(i) } else { 0.0 });
        let cloud = Cloud::new(&(0..1_000).map(at).collect::<Vec<_>>())
            .ok()
            .unwrap();
        for (told, wanted) in [(0.1, 0.1), (0.22, 0.22), (0.3, 0.22), (0.9, 0.54)] {
            let found = shortened(told / cloud.unit, &cloud) * cloud.unit;
            assert!((found - wanted).abs() < 1e-12, "{found} for {told}");
        }
    }

    #[test]
    fn gates_open_with_dirt_and_size() {
        let base = Settings {
            reach: 7.0,
            threshold: 0.3,
            support: 2.0,
            min_component: 15.0,
        };
        let check = |n, suspects, reach, wanted: [f64; 4]| {
            let found = base.gated(n, suspects, reach);
            let found = [
                found.reach,
                found.threshold,
                found.support,
                found.min_component,
            ];
            for (found, wanted) in found.into_iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-12, "{found} for {wanted}");
            }
        };
        check(10_000, 0.05, None, [7.0, 0.2, 2.0, 15.0]);
        check(10_000, 0.19, Some(9.0), [9.0, 0.25, 3.0, 16.5]);
        check(10_000, 0.40, Some(1.0), [6.0, 0.3, 4.0, 18.0]);
        check(50_000, 0.05, Some(99.0), [14.0, 0.15, 2.0, 15.0]);
        check(1_000_000, 0.26, None, [7.0, 0.225, 4.0, 18.0]);
        check(
            2_500,
            0.0,
            None,
            [7.0, 0.2 * 2.0_f64.powf(0.2), 2.0_f64.sqrt(), 7.5],
        );
        check(
            500,
            0.0,
            None,
            [7.0, 0.2 * 10.0_f64.powf(0.2), 0.4_f64.sqrt(), 1.5],
        );
        check(
            100,
            0.0,
            None,
            [7.0, 0.2 * 10.0_f64.powf(0.2), 0.4_f64.sqrt(), 1.5],
        );
    }
}
