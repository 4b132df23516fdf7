//! Which place to fly to next: through an exit, nearer to one, to a place that no scan saw, to the edge of what is proven, or home.

use exit_finder::sites::PortalId;
use nalgebra::Point3;
use sparse_to_obstacles::VoxelState;

use super::context::Context;
use super::event::Goal;
use super::fly::Arrival;
use super::survey::Survey;
use crate::heading::LevelPose;
use crate::reach::Reach;
use crate::scene::Scene;

/// How much farther from its goal a place may be that sees it, metres.
const DETOUR_M: f64 = 1.0;
/// Lines of sight that are checked for one goal at most.
const MOST_VIEWS: usize = 100;

/// Speed over ground with all turns and looks, metres per second.
const PROGRESS_M_PER_S: f64 = 0.35;
/// What a scan takes, seconds.
const SCAN_S: f64 = 15.0;
/// Floor area that an open exit promises, square metres: a small room.
const OPEN_EXIT_M2: f64 = 8.0;
/// The same for an exit that was seen through but not proven yet, and for one that was not seen through.
const SEEN_EXIT_M2: f64 = 5.0;
const UNSEEN_EXIT_M2: f64 = 2.5;

/// How far behind an exit a scan is made, metres, the best first.
const DEPTHS_M: [f64; 3] = [0.7, 0.35, 0.0];
/// A scan this near to a site in plain view would show nothing new, metres.
const NEAR_SITE_M: f64 = 0.8;

/// Where to fly next.
pub(super) struct Choice {
    /// Index of a reached place.
    pub(super) place: usize,
    pub(super) goal: Goal,
    pub(super) arrival: Arrival,
}

/// What to do next: whatever promises most new floor for its time among exits and places that no site has seen; then the edges of
/// what is proven, then places far from every site; else nothing.
pub(super) fn next_choice(
    context: &mut Context<'_>,
    scene: &Scene,
    reach: &Reach,
    pose: &LevelPose,
) -> Option<Choice> {
    let mut best: Option<(f64, Choice)> = None;
    let mut blocked = Vec::new();
    let survey = Survey::new(context.shared, scene, reach, pose);
    let open: Vec<PortalId> = context
        .explored
        .graph()
        .unvisited()
        .map(|portal| portal.id)
        .collect();
    for portal in open {
        match portal_choice(context, scene, reach, portal) {
            Some(choice) => {
                let gain = portal_gain(context, scene, &survey, (portal, &choice, reach));
                keep_better(&mut best, worth(scene, reach, choice.place, gain), choice);
            }
            None => blocked.push(portal),
        }
    }
    if let Some((area, place)) = survey.unseen() {
        let choice = Choice {
            place,
            goal: Goal::Unseen,
            arrival: Arrival::Site(None),
        };
        keep_better(
            &mut best,
            worth(scene, reach, place, area.min(OPEN_EXIT_M2)),
            choice,
        );
    }
    let choice = best.map(|(_, choice)| choice).or_else(|| survey.edges());
    for portal in blocked {
        context.explored.block(portal);
    }
    choice.or_else(|| far_choice(context, scene, reach))
}

fn keep_better(best: &mut Option<(f64, Choice)>, worth: f64, choice: Choice) {
    if best.as_ref().is_none_or(|(most, _)| worth > *most) {
        *best = Some((worth, choice));
    }
}

/// Square metres a second.
fn worth(scene: &Scene, reach: &Reach, place: usize, gain: f64) -> f64 {
    let way = reach.place(place).map_or(f64::INFINITY, |place| place.way);
    gain / (way * scene.meters_per_unit / PROGRESS_M_PER_S + SCAN_S)
}

/// Square metres that an exit promises: what is proven behind it and no scan saw, and what may lie beyond.
fn portal_gain(
    context: &Context<'_>,
    scene: &Scene,
    survey: &Survey<'_>,
    (portal, choice, reach): (PortalId, &Choice, &Reach),
) -> f64 {
    let portal = context.explored.portal(portal);
    let seen = portal.is_some_and(|portal| scene.free.state(portal.exit) == VoxelState::Free);
    if choice.goal == Goal::Through {
        let behind = reach.position(choice.place);
        let area = behind.map_or(0.0, |place| survey.unseen_near(&place));
        return (UNSEEN_EXIT_M2 + area).min(OPEN_EXIT_M2);
    }
    if seen { SEEN_EXIT_M2 } else { UNSEEN_EXIT_M2 }
}

/// How to get through a portal or nearer to it; `None` when there is no way and no progress.
fn portal_choice(
    context: &Context<'_>,
    scene: &Scene,
    reach: &Reach,
    portal: PortalId,
) -> Option<Choice> {
    let exploration = &context.config.exploration;
    let (entry, attempts) = (
        context.explored.portal(portal)?,
        context.explored.attempts(portal),
    );
    if attempts.failures >= exploration.failures + attempts.approaches {
        return None;
    }
    let (place, left) = nearest_view(scene, reach, &entry.exit.into())?;
    if left < scene.units(exploration.arrival_m) {
        let place = behind(context, scene, reach, portal).unwrap_or(place);
        return is_fresh(context, scene, reach, place).then_some(Choice {
            place,
            goal: Goal::Through,
            arrival: Arrival::Site(Some(portal)),
        });
    }
    let progress = attempts.closest - left;
    if attempts.approaches >= exploration.approaches
        || progress < scene.units(exploration.least_progress_m)
    {
        return None;
    }
    let goal = if context.explored.is_newest(entry) {
        Goal::Approach
    } else {
        Goal::Return
    };
    Some(Choice {
        place,
        goal,
        arrival: Arrival::Look { portal, left },
    })
}

/// Whether a scan here would show something: no site is near in plain view.
fn is_fresh(context: &Context<'_>, scene: &Scene, reach: &Reach, place: usize) -> bool {
    let near = scene.units(NEAR_SITE_M);
    let Some(place) = reach.position(place) else {
        return false;
    };
    let mut sites = context.explored.sites();
    !sites.any(|site| (site - place).norm() < near && scene.sees(&site, &place))
}

/// The roomiest reached place some way behind a portal, or else at it: from a doorway a scan shows less than from the room.
fn behind(context: &Context<'_>, scene: &Scene, reach: &Reach, portal: PortalId) -> Option<usize> {
    let through = Point3::from(context.explored.portal(portal)?.exit);
    let site = Point3::from(context.explored.finder_of(portal)?.position);
    let ahead = (through - site).try_normalize(f64::EPSILON)?;
    let arrival = context.config.exploration.arrival_m;
    DEPTHS_M.into_iter().find_map(|depth| {
        let target = through + ahead * scene.units(depth);
        roomiest(scene, reach, &target, arrival)
    })
}

/// The reached place within `meters` of `target` that has most room around it: scans are made there.
fn roomiest(scene: &Scene, reach: &Reach, target: &Point3<f64>, meters: f64) -> Option<usize> {
    let (place, cost) = reach.best(|place| {
        if (place.position - target).norm() < scene.units(meters) {
            -place.clearance
        } else {
            f64::INFINITY
        }
    })?;
    cost.is_finite().then_some(place)
}

/// The reachable place nearest to `target` from which the straight line to it is proven free, and that distance; the nearest place
/// of all where no such place is at most [`DETOUR_M`] farther. In front of an opening the drone sees through it, beside it the wall.
fn nearest_view(scene: &Scene, reach: &Reach, target: &Point3<f64>) -> Option<(usize, f64)> {
    let (nearest, least) = reach.best(|place| (place.position - target).norm())?;
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
            .is_some_and(|position| scene.sees(&position, target))
    };
    let view = near
        .iter()
        .step_by(stride)
        .copied()
        .find(|&(place, _)| sees(place));
    Some(view.unwrap_or((nearest, least)))
}

/// A reachable place far from every site: doors that a site saw at a slant, or whose frames were blank, show from another side. What
/// counts as far grows with the number of scans. Each becomes a site, so there are finitely many.
fn far_choice(context: &Context<'_>, scene: &Scene, reach: &Reach) -> Option<Choice> {
    let shares = [(4, 0.25), (8, 0.5)];
    let share = shares
        .into_iter()
        .find(|&(scans, _)| context.scans.len() < scans)
        .map_or(1.0, |(_, share)| share);
    let far = scene.units(share * context.config.exploration.far_distance_m);
    let (place, cost) = reach.best(|place| {
        let nearest = context
            .explored
            .sites()
            .chain(context.explored.tried())
            .map(|site| (site - place.position).norm())
            .fold(f64::INFINITY, f64::min);
        if nearest < far {
            f64::INFINITY
        } else {
            -(nearest.min(2.0 * far) + place.clearance) / (place.way + scene.units(2.0))
        }
    })?;
    cost.is_finite().then_some(Choice {
        place,
        goal: Goal::Unseen,
        arrival: Arrival::Site(None),
    })
}

/// The reached place nearest to where the drone took off, if that is near enough to land there.
pub(super) fn home_choice(
    context: &Context<'_>,
    scene: &Scene,
    reach: &Reach,
    home: &Point3<f64>,
) -> Option<Choice> {
    let (place, left) = reach.best(|place| (place.position - home).norm())?;
    let near = left < scene.units(context.config.exploration.arrival_m);
    near.then_some(Choice {
        place,
        goal: Goal::Home,
        arrival: Arrival::Home,
    })
}

#[cfg(test)]
mod tests {
    use super::super::drawn::Drawn;
    use super::*;
    use exit_finder::sites::PortalState;

    /// A room with a door towards +x. Rows of `?` make the room behind it proven or not.
    fn plan(behind: &str) -> Vec<String> {
        let rows = [
            "########################",
            "#..........#???????????#",
            "#..........#???????????#",
            "#..........#???????????#",
            "#..........????????????#",
            "#..........????????????#",
            "#....a.....?????????b??#",
            "#..........????????????#",
            "#..........????????????#",
            "#..........#???????????#",
            "#..........#???????????#",
            "#..........#???????????#",
            "########################",
        ];
        rows.iter().map(|row| row.replace('?', behind)).collect()
    }

    fn drawn(behind: &str) -> Drawn {
        let rows = plan(behind);
        Drawn::new(&rows.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// The next choice, and where it leads.
    fn choose(drawn: &mut Drawn) -> Option<(Choice, Point3<f64>)> {
        let (reach, pose) = (drawn.reach(), drawn.pose());
        let choice =
            drawn.with_context(|context, scene| next_choice(context, scene, &reach, &pose))?;
        let place = reach.position(choice.place).unwrap();
        Some((choice, place))
    }

    #[test]
    fn a_proven_way_leads_through_the_exit_to_a_scan_behind_it() {
        let mut drawn = drawn(".");
        let start = drawn.place('a');
        let portals = drawn.scan(start);
        assert_eq!(portals.len(), 1, "one door");
        let (choice, place) = choose(&mut drawn).unwrap();
        assert_eq!(choice.goal, Goal::Through);
        assert_eq!(choice.arrival, Arrival::Site(Some(portals[0])));
        assert!(place.x > 2.2, "{place} is not behind the door");
    }

    #[test]
    fn an_exit_behind_which_nothing_is_proven_is_approached_and_then_blocked() {
        let mut drawn = drawn(" ");
        let start = drawn.place('a');
        let portal = drawn.scan(start)[0];
        let (choice, place) = choose(&mut drawn).unwrap();
        assert_eq!(choice.goal, Goal::Approach);
        let Arrival::Look { portal: at, left } = choice.arrival else {
            panic!("{:?}", choice.arrival);
        };
        assert!(at == portal && place.x > start.x && left > 0.0);
        // A look from there that proves nothing more: no progress is left, so there is no way.
        drawn.mission.shared.explored.note_approach(portal, left);
        let next = choose(&mut drawn);
        assert!(
            next.is_none_or(|(choice, _)| !matches!(choice.goal, Goal::Approach | Goal::Through))
        );
        let state = drawn.mission.shared.explored.portal(portal).unwrap().state;
        assert_eq!(state, PortalState::Blocked);
    }

    #[test]
    fn an_exit_that_no_flight_came_to_is_given_up() {
        let mut drawn = drawn(".");
        let start = drawn.place('a');
        let portal = drawn.scan(start)[0];
        let failures = drawn.mission.shared.config.exploration.failures;
        for _ in 0..failures {
            let (choice, _) = choose(&mut drawn).unwrap();
            assert_eq!(choice.arrival, Arrival::Site(Some(portal)));
            drawn.mission.shared.explored.note_failure(portal);
        }
        // The room behind is still there to be seen, but no longer as an exit.
        let (choice, _) = choose(&mut drawn).unwrap();
        assert_eq!(choice.goal, Goal::Unseen);
    }

    #[test]
    fn a_closed_room_that_was_seen_leaves_nothing_after_a_few_more_looks() {
        let rows = plan("#");
        let rows: Vec<&str> = rows.iter().map(|row| &row[..12]).collect();
        let mut drawn = Drawn::new(&rows);
        let start = drawn.place('a');
        assert!(drawn.scan(start).is_empty());
        let mut looks = 0;
        while let Some((choice, place)) = choose(&mut drawn) {
            assert_eq!(choice.goal, Goal::Unseen);
            drawn.mission.shared.explored.note_tried(place);
            looks += 1;
            assert!(looks < 20, "it never ends");
        }
    }

    #[test]
    fn home_is_a_goal_only_where_it_can_be_reached() {
        let mut drawn = drawn(".");
        let reach = drawn.reach();
        let inside = drawn.place('b');
        let outside = Point3::new(9.0, 0.0, 9.0);
        let [found, lost] = [inside, outside].map(|home| {
            drawn.with_context(|context, scene| home_choice(context, scene, &reach, &home))
        });
        assert_eq!(found.unwrap().goal, Goal::Home);
        assert!(lost.is_none());
    }
}
