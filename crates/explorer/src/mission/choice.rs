//! Which place to fly to next: through an exit, nearer to one, to a place that no scan saw, or home.

use nalgebra::Point3;
use sparse_to_obstacles::VoxelState;

use super::context::Context;
use super::event::Goal;
use super::fly::Arrival;
use crate::atlas::PortalState;
use crate::reach::Reach;
use crate::scene::Scene;

/// How much farther from its goal a place may be that sees it, metres.
const DETOUR_M: f64 = 1.0;
/// Lines of sight that are checked for one goal at most.
const MOST_VIEWS: usize = 100;

/// A scan is taken to show unseen places within this distance, metres.
const UNSEEN_RANGE_M: f64 = 1.5;
/// Flights of this length count half as much as short ones, metres.
const WORTHWHILE_WAY_M: f64 = 2.0;
/// Places compared for the next scan at most.
const MOST_CANDIDATES: usize = 400;

/// Where to fly next.
pub(super) struct Choice {
    /// Index of a reached place.
    pub(super) place: usize,
    pub(super) goal: Goal,
    pub(super) arrival: Arrival,
}

/// What to do next: the exit that is most surely open and nearest, else a place that no site has seen, else nothing.
pub(super) fn next_choice(
    context: &mut Context<'_>,
    scene: &Scene,
    reach: &Reach,
) -> Option<Choice> {
    let here = reach.position(0)?;
    let mut best: Option<(usize, f64, Choice)> = None;
    for portal in context.atlas.unvisited() {
        let Some(choice) = portal_choice(context, scene, reach, portal) else {
            block(context, portal);
            continue;
        };
        let through = context
            .atlas
            .portals()
            .get(portal)
            .map_or(here, |entry| entry.through);
        let class = match choice.goal {
            Goal::Through => 0,
            _ if scene.free.state(through.into()) == VoxelState::Free => 1,
            _ => 2,
        };
        let distance = reach
            .position(choice.place)
            .map_or(f64::INFINITY, |place| (place - here).norm());
        if best
            .as_ref()
            .is_none_or(|(c, d, _)| (class, distance) < (*c, *d))
        {
            best = Some((class, distance, choice));
        }
    }
    best.map(|(_, _, choice)| choice)
        .or_else(|| unseen_choice(context, scene, reach))
        .or_else(|| far_choice(context, scene, reach))
}

/// How to get through a portal or nearer to it; `None` when there is no way and no progress.
fn portal_choice(
    context: &Context<'_>,
    scene: &Scene,
    reach: &Reach,
    portal: usize,
) -> Option<Choice> {
    let exploration = &context.config.exploration;
    let entry = context.atlas.portals().get(portal)?;
    if entry.failures >= exploration.failures + entry.approaches {
        return None;
    }
    let (place, left) = nearest_view(scene, reach, &entry.through)?;
    if left < scene.units(exploration.arrival_m) {
        return Some(Choice {
            place,
            goal: Goal::Through,
            arrival: Arrival::Site(Some(portal)),
        });
    }
    let progress = entry.closest - left;
    if entry.approaches >= exploration.approaches
        || progress < scene.units(exploration.least_progress_m)
    {
        return None;
    }
    let newest = entry.site + 1 == context.atlas.sites().len();
    let goal = if newest { Goal::Approach } else { Goal::Return };
    Some(Choice {
        place,
        goal,
        arrival: Arrival::Look { portal, left },
    })
}

/// The reachable place nearest to `target` from which the straight line to it is proven free, and that distance; the nearest place
/// of all where no such place is at most [`DETOUR_M`] farther. In front of an opening the drone sees through it, beside it the wall.
fn nearest_view(scene: &Scene, reach: &Reach, target: &Point3<f64>) -> Option<(usize, f64)> {
    let (nearest, least) = reach.best(|position| (position - target).norm())?;
    let limit = least + scene.units(DETOUR_M);
    let mut near: Vec<(usize, f64)> = reach
        .positions()
        .enumerate()
        .map(|(place, position)| (place, (position - target).norm()))
        .filter(|&(_, distance)| distance <= limit)
        .collect();
    near.sort_by(|a, b| a.1.total_cmp(&b.1));
    let stride = near.len().div_ceil(MOST_VIEWS).max(1);
    let sees = |place: usize| {
        reach
            .position(place)
            .is_some_and(|p| scene.free.motion_is_free(p.into(), (*target).into(), 0.0))
    };
    let view = near
        .iter()
        .step_by(stride)
        .copied()
        .find(|&(place, _)| sees(place));
    Some(view.unwrap_or((nearest, least)))
}

/// The reachable place from which a scan would show most that no site saw, for the way there. Each becomes a site of its own, at a
/// distance from all others, and each is tried once, so there are finitely many.
fn unseen_choice(context: &Context<'_>, scene: &Scene, reach: &Reach) -> Option<Choice> {
    let exploration = &context.config.exploration;
    let shrink = scene.units(exploration.known_shrink_m);
    let atlas = &context.atlas;
    // One height is enough to tell places apart, and one place in so many to tell areas apart.
    let start = reach.position(0)?;
    let level = 0.5 * scene.free.resolution();
    let unseen: Vec<(usize, Point3<f64>)> = reach
        .positions()
        .enumerate()
        .filter(|(_, position)| (position - start).dot(&context.knowledge.up()).abs() < level)
        .filter(|(_, position)| !atlas.is_known(position, shrink))
        .collect();
    let apart = scene.units(exploration.site_distance_m);
    let is_new = |position: &Point3<f64>| {
        let near_site = atlas
            .sites()
            .iter()
            .any(|site| (site.position - position).norm() < apart);
        let near_tried = context
            .tried
            .iter()
            .any(|place| (place - position).norm() < 0.5 * apart);
        !near_site && !near_tried
    };
    let range = scene.units(UNSEEN_RANGE_M);
    let cell = scene.free.resolution() * scene.meters_per_unit;
    let stride = unseen.len().div_ceil(MOST_CANDIDATES).max(1);
    let mut best: Option<(usize, f64)> = None;
    for &(place, position) in unseen
        .iter()
        .step_by(stride)
        .filter(|(_, position)| is_new(position))
    {
        let near = unseen
            .iter()
            .filter(|(_, other)| (other - position).norm() < range)
            .count();
        let area = near as f64 * cell * cell;
        let way = (position - start).norm() * scene.meters_per_unit;
        let worth = area / (way + WORTHWHILE_WAY_M);
        if area >= exploration.least_unseen_m2 && best.is_none_or(|(_, most)| worth > most) {
            best = Some((place, worth));
        }
    }
    best.map(|(place, _)| Choice {
        place,
        goal: Goal::Unseen,
        arrival: Arrival::Site(None),
    })
}

/// A reachable place far from every site: doors that a site saw at a slant, or whose frames were blank, show from another side.
/// Each becomes a site, so there are finitely many.
fn far_choice(context: &Context<'_>, scene: &Scene, reach: &Reach) -> Option<Choice> {
    let far = scene.units(context.config.exploration.far_distance_m);
    let start = reach.position(0)?;
    let (place, cost) = reach.best(|position| {
        let sites = context.atlas.sites().iter().map(|site| site.position);
        let nearest = sites
            .chain(context.tried.iter().copied())
            .map(|site| (site - position).norm())
            .fold(f64::INFINITY, f64::min);
        let way = (position - start).norm() + scene.units(WORTHWHILE_WAY_M);
        if nearest < far {
            f64::INFINITY
        } else {
            -nearest.min(2.0 * far) / way
        }
    })?;
    cost.is_finite().then_some(Choice {
        place,
        goal: Goal::Unseen,
        arrival: Arrival::Site(None),
    })
}

fn block(context: &mut Context<'_>, portal: usize) {
    if let Some(portal) = context.atlas.portal_mut(portal) {
        portal.state = PortalState::Blocked;
    }
}

/// The reached place nearest to where the drone took off, if that is near enough to land there.
pub(super) fn home_choice(
    context: &Context<'_>,
    scene: &Scene,
    reach: &Reach,
    home: &Point3<f64>,
) -> Option<Choice> {
    let (place, left) = reach.best(|position| (position - home).norm())?;
    let near = left < scene.units(context.config.exploration.arrival_m);
    near.then_some(Choice {
        place,
        goal: Goal::Home,
        arrival: Arrival::Home,
    })
}
