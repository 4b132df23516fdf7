//! Between two flights: look at the map, find exits, choose a goal, plan a path to it.

use nalgebra::{Point3, Vector3};

use super::context::Context;
use super::event::{Event, Goal};
use super::fly::{Arrival, Fly};
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::record::Cycle;
use super::recover::Recover;
use super::scan::Scan;
use crate::atlas::{KnownLimits, Portal, PortalState};
use crate::heading::LevelPose;
use crate::reach::{Reach, ReachLimits};
use crate::route::Route;
use crate::scene::{Presence, Scene};
use crate::stage::{Stage, staged};

/// Places that a flood may reach: a large flat at 0.1 m.
const MOST_PLACES: usize = 200_000;
/// Perceptions that fail in a row before the mission gives up: each follows a new scan.
const MOST_FAILURES: usize = 3;

#[derive(Debug)]
pub(super) struct Think {
    /// A full turn was just made here, so exits can be looked for.
    site: bool,
}

/// The best thing to do about one portal.
struct Choice {
    portal: usize,
    place: usize,
    goal: Goal,
    /// Distance left to the point behind the portal, map units.
    left: f64,
}

impl Think {
    pub(super) fn after_scan() -> Self {
        Self { site: true }
    }

    pub(super) fn again() -> Self {
        Self { site: false }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        if context.scans.len() > context.config.scan_budget {
            return context.land(Outcome::OutOfScans);
        }
        let Some(pose) = context.knowledge.pose() else {
            return Step::Become(Phase::Recover(Recover::in_place()));
        };
        if context.epoch != Some(context.knowledge.epoch()) {
            // SLAM began a new map: its scale and its plane are unknown until a scan has been flown in it.
            return Step::Become(Phase::Scan(Scan::full(context)));
        }
        let Some(map) = context.map.take() else {
            return Step::NeedMap;
        };
        let Some(scene) = look(context, &map, &pose) else {
            return self.failed(context);
        };
        let exits = self.site.then(|| {
            let report = staged(context.stages, Stage::Exits, || {
                scene.exits(&map, &pose, &context.shared.config)
            });
            report.ok()
        });
        self.decide(context, &pose, scene, exits.flatten())
    }

    fn failed(&self, context: &mut Context<'_>) -> Step {
        context.failures += 1;
        if context.failures >= MOST_FAILURES {
            return context.land(Outcome::TrackingLost);
        }
        Step::Become(Phase::Scan(Scan::full(context)))
    }

    fn decide(
        &self,
        context: &mut Context<'_>,
        pose: &LevelPose,
        scene: Scene,
        exits: Option<exit_finder::ExitReport>,
    ) -> Step {
        if let Some(report) = &exits {
            register(context, pose, &scene, report);
        }
        context.log(Event::Perceived {
            points: scene.points.len(),
            kept: scene.kept.len(),
            exits: exits.as_ref().map_or(0, |report| report.exits.len()),
        });
        let mut cycle = Cycle {
            time: context.knowledge.now(),
            position: pose.position,
            points: scene.points.len(),
            kept: scene.kept.len(),
            exits,
            raw_path: Vec::new(),
            path: Vec::new(),
            goal: None,
        };
        let step = self.choose(context, pose, &scene, &mut cycle);
        context.cycles.push(cycle);
        context.scene = Some(scene);
        step
    }

    fn choose(
        &self,
        context: &mut Context<'_>,
        pose: &LevelPose,
        scene: &Scene,
        cycle: &mut Cycle,
    ) -> Step {
        let radius = scene.radius_at(
            &pose.position,
            scene.units(context.config.planning_radius_m()),
            scene.units(context.config.drone_radius_m),
        );
        let reach = staged(context.stages, Stage::Choose, || {
            flood(&context.shared.config.exploration, pose, scene, radius)
        });
        loop {
            let Some(choice) = next_choice(context, scene, &reach) else {
                return context.land(Outcome::Explored);
            };
            let here =
                choice.place == 0 || distance(&reach, choice.place, pose) < scene.units(0.25);
            if here && choice.goal != Goal::Through {
                // Nowhere nearer to fly to: a look from here may prove more space free, once.
                if let Some(step) = look_from_here(context, pose, &choice) {
                    return step;
                }
                continue;
            }
            let planned = Route::plan(
                scene,
                &reach,
                choice.place,
                radius,
                &context.shared.config.exploration,
                &mut context.shared.rng,
                context.stages,
            );
            let Some(route) = planned else {
                block(context, choice.portal);
                continue;
            };
            context.log(Event::Heading {
                meters: route.length() * scene.meters_per_unit,
                goal: choice.goal,
            });
            cycle.raw_path.clone_from(&route.raw);
            cycle.path.clone_from(&route.path);
            cycle.goal = Some(choice.goal);
            return Step::Become(Phase::Fly(fly(context, &route, &choice)));
        }
    }
}

/// Cleans the map, carves free space, builds obstacles.
fn look(context: &mut Context<'_>, map: &slam_bridge::Map, pose: &LevelPose) -> Option<Scene> {
    let meters_per_unit = context.knowledge.meters_per_unit()?;
    let presence = presence(context, pose, meters_per_unit);
    let shared = &mut *context.shared;
    Scene::new(
        map,
        meters_per_unit,
        &presence,
        &shared.config,
        &mut shared.rng,
        context.stages,
    )
    .ok()
}

/// Where the drone has been, it fits; around the start the operator keeps a bubble clear.
fn presence(context: &Context<'_>, pose: &LevelPose, meters_per_unit: f64) -> Vec<Presence> {
    let config = &context.config;
    let radius = config.planning_radius_m() / meters_per_unit;
    let epoch = context.knowledge.epoch();
    let mut places: Vec<Presence> = Vec::new();
    for frame in context
        .knowledge
        .trail()
        .iter()
        .filter(|frame| frame.epoch == epoch)
    {
        let center: Vector3<f64> = frame.world_from_camera.translation.vector;
        let near = places
            .last()
            .is_some_and(|last| (Vector3::from(last.center) - center).norm() < radius / 4.0);
        if !near {
            places.push(Presence {
                center: center.into(),
                radius,
            });
        }
    }
    if let Some(first) = places.first().map(|first| first.center) {
        places.push(Presence {
            center: first,
            radius: config.start_bubble_m / meters_per_unit,
        });
    }
    places.push(Presence {
        center: pose.position.into(),
        radius,
    });
    places
}

fn register(
    context: &mut Context<'_>,
    pose: &LevelPose,
    scene: &Scene,
    report: &exit_finder::ExitReport,
) {
    let exploration = &context.shared.config.exploration;
    let limits = KnownLimits {
        path: scene.units(exploration.known_distance_m),
        shrink: scene.units(exploration.known_shrink_m),
    };
    let epoch = context.shared.knowledge.epoch();
    let trail = context
        .shared
        .knowledge
        .trail()
        .iter()
        .filter(|frame| frame.epoch == epoch)
        .map(|frame| Point3::from(frame.world_from_camera.translation.vector));
    context
        .shared
        .atlas
        .add_site(pose.position, report, trail, &limits);
}

fn flood(
    config: &crate::config::ExplorationConfig,
    pose: &LevelPose,
    scene: &Scene,
    radius: f64,
) -> Reach {
    let band = scene.units(config.height_band_m);
    let limits = ReachLimits {
        step: scene.free.resolution(),
        below: band,
        above: band,
        max_places: MOST_PLACES,
    };
    Reach::flood(pose, &limits, |a, b| scene.motion_is_free(a, b, radius))
}

/// The first portal, best first, that can be passed or approached; portals that can be neither are blocked.
fn next_choice(context: &mut Context<'_>, scene: &Scene, reach: &Reach) -> Option<Choice> {
    let exploration = context.config.exploration.clone();
    for portal in context.atlas.unvisited() {
        let Some(entry) = context.atlas.portals().get(portal) else {
            continue;
        };
        let through = entry.through;
        let Some((place, left)) = reach.best(|position| (position - through).norm()) else {
            continue;
        };
        let progress = entry.closest - left;
        if left < scene.units(exploration.arrival_m) {
            return Some(Choice {
                portal,
                place,
                goal: Goal::Through,
                left,
            });
        }
        if entry.approaches < exploration.approaches
            && progress > scene.units(exploration.least_progress_m)
        {
            let newest = entry.site + 1 == context.atlas.sites().len();
            let goal = if newest { Goal::Approach } else { Goal::Return };
            return Some(Choice {
                portal,
                place,
                goal,
                left,
            });
        }
        block(context, portal);
    }
    None
}

fn block(context: &mut Context<'_>, portal: usize) {
    if let Some(portal) = context.atlas.portal_mut(portal) {
        portal.state = PortalState::Blocked;
    }
}

fn note_approach(portal: &mut Portal, left: f64) {
    portal.approaches += 1;
    portal.closest = portal.closest.min(left);
}

fn look_from_here(context: &mut Context<'_>, pose: &LevelPose, choice: &Choice) -> Option<Step> {
    let portal = context.atlas.portal_mut(choice.portal)?;
    note_approach(portal, choice.left);
    let towards = pose.turn_to(&portal.through);
    Some(Step::Become(Phase::Scan(Scan::look(context, towards))))
}

fn fly(context: &mut Context<'_>, route: &Route, choice: &Choice) -> Fly {
    let through = context
        .atlas
        .portals()
        .get(choice.portal)
        .map(|portal| portal.through);
    let arrival = match (choice.goal, through) {
        (Goal::Through, _) | (_, None) => Arrival::Site,
        (Goal::Approach | Goal::Return, Some(target)) => Arrival::LookAt(target),
    };
    if let Some(portal) = context.atlas.portal_mut(choice.portal) {
        if choice.goal == Goal::Through {
            portal.state = PortalState::Traversed;
        } else {
            note_approach(portal, choice.left);
        }
    }
    Fly::along(route, arrival)
}

fn distance(reach: &Reach, place: usize, pose: &LevelPose) -> f64 {
    reach
        .position(place)
        .map_or(f64::INFINITY, |position| (position - pose.position).norm())
}
