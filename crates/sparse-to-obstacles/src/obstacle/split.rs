//! Clusters that span a gap are split: too long ones, and those whose hull the camera has seen through.
//!
//! Method: a cluster longer than allowed is cut at the largest gap between its points along its longest
//! principal axis. A hull that more rays cross than may be wrong is cut the same way, and the rays
//! that crossed it are tested again on both parts.

use super::bvh::{Aabb, Bvh, Motion};
use super::config::ObstacleConfig;
use crate::free_space::Ray;
use crate::hull::{Hull, longest_axis, separation};
use crate::vector::{Vec3, dot, lerp};

/// A cluster that may yet be split, and the rays that crossed the hull it came from.
struct Part {
    members: Vec<usize>,
    rays: Vec<u32>,
}

/// The hulls of all clusters after splitting, in the order of the clusters. `hull_of` must not be
/// called with an empty list, and is not.
pub(super) fn hulls(
    points: &[Vec3],
    clusters: Vec<Vec<usize>>,
    rays: &[Ray],
    config: &ObstacleConfig,
    hull_of: impl Fn(Vec<usize>) -> Hull,
) -> Vec<Hull> {
    let clusters: Vec<Vec<usize>> = clusters
        .into_iter()
        .flat_map(|members| shortened(points, members, config))
        .collect();
    let mut whole: Vec<Hull> = clusters.into_iter().map(&hull_of).collect();
    if rays.is_empty() {
        return whole;
    }
    let lines: Vec<(Vec3, Vec3)> = rays
        .iter()
        .map(|ray| {
            (
                ray.origin,
                lerp(ray.origin, ray.end, 1.0 - config.ray_margin),
            )
        })
        .collect();
    let crossing = crossing_rays(&whole, &lines);
    let mut parts = Vec::with_capacity(whole.len());
    for (hull, rays) in whole.drain(..).zip(crossing) {
        pierced_apart(points, hull, rays, &lines, config, &hull_of, &mut parts);
    }
    parts
}

/// Cuts a cluster until every part is short enough.
fn shortened(points: &[Vec3], members: Vec<usize>, config: &ObstacleConfig) -> Vec<Vec<usize>> {
    let mut done = Vec::new();
    let mut open = vec![members];
    while let Some(members) = open.pop() {
        let own: Vec<Vec3> = members.iter().map(|&index| points[index]).collect();
        let (axis, extent) = longest_axis(&own);
        if extent <= config.max_diameter || members.len() < 2 {
            done.push(members);
            continue;
        }
        let (near, far) = cut(points, members, axis);
        open.extend([far, near]);
    }
    done
}

/// Cuts a hull until few enough rays cross every part.
fn pierced_apart(
    points: &[Vec3],
    hull: Hull,
    rays: Vec<u32>,
    lines: &[(Vec3, Vec3)],
    config: &ObstacleConfig,
    hull_of: &impl Fn(Vec<usize>) -> Hull,
    done: &mut Vec<Hull>,
) {
    let mut open = vec![(hull, rays)];
    while let Some((hull, rays)) = open.pop() {
        if rays.len() <= config.max_piercing_rays
            || hull.point_indices.len() < config.min_split_points
        {
            done.push(hull);
            continue;
        }
        let own: Vec<Vec3> = hull
            .point_indices
            .iter()
            .map(|&index| points[index])
            .collect();
        let (axis, extent) = longest_axis(&own);
        if extent <= 0.0 {
            done.push(hull);
            continue;
        }
        let (near, far) = cut(points, hull.point_indices, axis);
        for members in [far, near] {
            let part = Part {
                members,
                rays: rays.clone(),
            };
            open.push(narrowed(part, lines, hull_of));
        }
    }
}

/// The hull of a part with those of its rays that still cross it.
fn narrowed(
    part: Part,
    lines: &[(Vec3, Vec3)],
    hull_of: &impl Fn(Vec<usize>) -> Hull,
) -> (Hull, Vec<u32>) {
    let hull = hull_of(part.members);
    let mut rays = part.rays;
    rays.retain(|&ray| crosses(&hull, lines[ray as usize]));
    (hull, rays)
}

fn crosses(hull: &Hull, (from, to): (Vec3, Vec3)) -> bool {
    separation(&hull.vertices, from, to, 0.0).lower <= 0.0
}

/// For each hull, the rays that cross it, ascending.
fn crossing_rays(hulls: &[Hull], lines: &[(Vec3, Vec3)]) -> Vec<Vec<u32>> {
    let bvh = Bvh::new(hulls.iter().map(|hull| Aabb::of(&hull.vertices)).collect());
    let mut crossing = vec![Vec::new(); hulls.len()];
    for (&line, ray) in lines.iter().zip(0..) {
        bvh.any_near(&Motion::new(line.0, line.1), 0.0, |hull| {
            if crosses(&hulls[hull], line) {
                crossing[hull].push(ray);
            }
            false
        });
    }
    crossing
}

/// Cuts a cluster of at least two distinct points at the largest gap along an axis; of equal gaps, at
/// the one nearest to the middle of the list.
fn cut(points: &[Vec3], members: Vec<usize>, axis: Vec3) -> (Vec<usize>, Vec<usize>) {
    let mut order: Vec<(f64, usize)> = members
        .into_iter()
        .map(|index| (dot(points[index], axis), index))
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let middle = order.len() / 2;
    let gap = |at: usize| order[at].0 - order[at - 1].0;
    let best = (1..order.len()).max_by(|&a, &b| {
        gap(a)
            .total_cmp(&gap(b))
            .then(b.abs_diff(middle).cmp(&a.abs_diff(middle)))
    });
    let far = order.split_off(best.unwrap_or(middle));
    let sorted = |part: Vec<(f64, usize)>| {
        let mut indices: Vec<usize> = part.into_iter().map(|(_, index)| index).collect();
        indices.sort_unstable();
        indices
    };
    (sorted(order), sorted(far))
}
