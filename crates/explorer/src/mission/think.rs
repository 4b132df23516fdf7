//! Between two flights: look at the map, find exits, choose a goal, plan a path to it.

use std::sync::Arc;

use nalgebra::Vector3;

use super::choice::{Choice, home_choice, next_choice};
use super::context::Context;
use super::event::{Event, Goal};
use super::fly::{Arrival, Fly, arrive};
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::record::Cycle;
use super::recover::Recover;
use super::scan::Scan;
use super::survey::SIGHT_M;
use crate::exit_search::ExitSearch;
use crate::heading::LevelPose;
use crate::reach::{Reach, ReachLimits};
use crate::route::{Route, RouteRadii};
use crate::scene::{Presence, Scene};
use crate::stage::{Stage, staged};

/// Places that a flood may reach: a large flat at 0.1 m.
const MOST_PLACES: usize = 200_000;
/// Flights shorter than this are looks from where the drone is, metres.
const SHORTEST_FLIGHT_M: f64 = 0.25;
/// The mission does not end this far from every scan without another one, metres.
const UNSCANNED_M: f64 = 0.5;
/// Scans without which no mission ends: another one in the same place still finds new points.
const LEAST_SCANS: usize = 3;
/// Flights home at most: the battery's reserve holds no more.
const MOST_HOME_FLIGHTS: usize = 6;
/// Perceptions that fail in a row before the mission gives up: each follows a new scan.
const MOST_FAILURES: usize = 3;

#[derive(Debug)]
pub(super) struct Think {
    /// A full turn was just made here, so exits can be looked for.
    site: bool,
}

impl Think {
    pub(super) fn after_scan() -> Self {
        Self { site: true }
    }

    pub(super) fn again() -> Self {
        Self { site: false }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        if context.scans.len() >= context.config.scan_budget && context.homing.is_none() {
            context.homing = Some(Outcome::OutOfScans);
        }
        let Some(pose) = context.knowledge.pose() else {
            return Step::Become(Phase::Recover(Recover::new(context.retreat.take())));
        };
        if context.epoch != Some(context.knowledge.epoch()) {
            // SLAM began a new map: its scale and its plane are unknown until a scan has been flown in it.
            return Step::Become(Phase::Scan(Scan::full()));
        }
        let Some(map) = context.map.take() else {
            return Step::NeedMap;
        };
        context.follow_map(&map);
        let Some(scene) = look(context, &map, &pose) else {
            return self.failed(context);
        };
        let exits = self.site.then(|| {
            let sight = scene.units(SIGHT_M);
            let graph = context.shared.explored.graph();
            let closed = graph.virtual_points(pose.position.into(), sight);
            let report = staged(context.stages, Stage::Exits, || {
                scene.exits(&map, &pose, &closed, &context.shared.config)
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
        Step::Become(Phase::Scan(Scan::full()))
    }

    fn decide(
        &self,
        context: &mut Context<'_>,
        pose: &LevelPose,
        scene: Scene,
        exits: Option<ExitSearch>,
    ) -> Step {
        let (exits, cloud) = exits.map_or((None, Vec::new()), |found| {
            (Some(found.report), found.cloud)
        });
        if let Some(report) = &exits {
            register(context, &scene, report);
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
            cloud,
            exits,
            raw_path: Vec::new(),
            path: Vec::new(),
            goal: None,
        };
        let scene = Arc::new(scene);
        context.scene = Some(Arc::clone(&scene));
        let step = self.choose(context, pose, &scene, &mut cycle);
        context.cycles.push(cycle);
        step
    }

    fn choose(
        &self,
        context: &mut Context<'_>,
        pose: &LevelPose,
        scene: &Scene,
        cycle: &mut Cycle,
    ) -> Step {
        let radii = RouteRadii {
            least: scene.units(context.config.planning_radius_m()),
            comfortable: scene.units(context.config.comfortable_radius_m()),
        };
        let reach = flood(context, pose, scene, radii);
        if context.homing.is_none() {
            match self.explore(context, pose, scene, &reach, radii, cycle) {
                Some(step) => return step,
                // Before giving up, one more look around from wherever the drone has come to.
                None if context.scans.len() < LEAST_SCANS || is_unscanned(context, scene, pose) => {
                    context.explored.note_tried(pose.position);
                    return Step::Become(Phase::Scan(Scan::full()));
                }
                None => context.homing = Some(Outcome::Explored),
            }
        }
        go_home(context, pose, scene, &reach, radii, cycle)
    }

    /// The next exploring step; `None` when nothing is left to explore.
    fn explore(
        &self,
        context: &mut Context<'_>,
        pose: &LevelPose,
        scene: &Scene,
        reach: &Reach,
        radii: RouteRadii,
        cycle: &mut Cycle,
    ) -> Option<Step> {
        loop {
            let choice = choose(context, scene, reach, pose)?;
            if distance(reach, choice.place, pose) < scene.units(SHORTEST_FLIGHT_M) {
                // The drone is there already.
                note_attempt(context, reach, &choice);
                match arrive(context, pose, choice.arrival) {
                    Some(step) => return Some(step),
                    None => continue,
                }
            }
            match plan(context, scene, reach, radii, &choice) {
                Some(route) => return Some(set_out(context, scene, &route, &choice, cycle)),
                None => note_attempt(context, reach, &choice),
            }
        }
    }
}

/// Whether no scan was made or tried near here.
fn is_unscanned(context: &Context<'_>, scene: &Scene, pose: &LevelPose) -> bool {
    let near = scene.units(UNSCANNED_M);
    let explored = &context.explored;
    let mut known = explored.sites().chain(explored.tried());
    !known.any(|place| (place - pose.position).norm() < near)
}

/// Flies back to where the drone took off: the one place whose ground is known to be clear. Lands right here after too many
/// attempts, or without any way.
fn go_home(
    context: &mut Context<'_>,
    pose: &LevelPose,
    scene: &Scene,
    reach: &Reach,
    radii: RouteRadii,
    cycle: &mut Cycle,
) -> Step {
    context.home_flights += 1;
    let outcome = context.homing.clone().unwrap_or(Outcome::Explored);
    if context.home_flights > MOST_HOME_FLIGHTS {
        return context.land(outcome);
    }
    let Some(home) = context.home() else {
        return context.land(outcome);
    };
    if (home - pose.position).norm() < scene.units(context.config.exploration.arrival_m) {
        return context.land(outcome);
    }
    let planned = home_choice(context, scene, reach, &home)
        .and_then(|choice| Some((plan(context, scene, reach, radii, &choice)?, choice)));
    let (route, choice) = match planned {
        Some(planned) => planned,
        // No way was found through proven-free space, but there is the way that the drone came.
        None => (
            way_came(context, scene),
            Choice {
                place: 0,
                goal: Goal::Home,
                arrival: Arrival::Home,
            },
        ),
    };
    set_out(context, scene, &route, &choice, cycle)
}

/// The flown path backwards, its loops cut where the shortcut is free.
fn way_came(context: &Context<'_>, scene: &Scene) -> Route {
    let radius = scene.units(context.config.flying_radius_m(0.2));
    Route::along(scene, context.way_came(scene), radius)
}

fn set_out(
    context: &mut Context<'_>,
    scene: &Scene,
    route: &Route,
    choice: &Choice,
    cycle: &mut Cycle,
) -> Step {
    context.log(Event::Heading {
        meters: route.length() * scene.meters_per_unit,
        goal: choice.goal,
    });
    cycle.raw_path.clone_from(&route.raw);
    cycle.path.clone_from(&route.path);
    cycle.goal = Some(choice.goal);
    Step::Become(Phase::Fly(Fly::along(route, choice.arrival)))
}

/// What to do next, as a stage of its own.
fn choose(
    context: &mut Context<'_>,
    scene: &Scene,
    reach: &Reach,
    pose: &LevelPose,
) -> Option<Choice> {
    context.stages.begin(Stage::Choose);
    let choice = next_choice(context, scene, reach, pose);
    context.stages.end(Stage::Choose);
    choice
}

/// Plans a path and counts the flight as failed until it arrives.
fn plan(
    context: &mut Context<'_>,
    scene: &Scene,
    reach: &Reach,
    radii: RouteRadii,
    choice: &Choice,
) -> Option<Route> {
    let shared = &mut *context.shared;
    let exploration = &shared.config.exploration;
    let route = Route::plan(
        scene,
        reach,
        choice.place,
        radii,
        exploration,
        &mut shared.rng,
        context.stages,
    )?;
    note_attempt(context, reach, choice);
    Some(route)
}

/// Counts a flight that has not arrived yet: one that arrives changes its portal's state or distance, or becomes a site.
fn note_attempt(context: &mut Context<'_>, reach: &Reach, choice: &Choice) {
    match choice.arrival {
        Arrival::Site(Some(portal)) | Arrival::Look { portal, .. } => {
            context.explored.note_failure(portal);
        }
        Arrival::Site(None) => {
            if let Some(place) = reach.position(choice.place) {
                context.explored.note_tried(place);
            }
        }
        Arrival::Home => {}
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
        .poses()
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
    // The bubble reaches from the height of the first pose to that of the first scan.
    let scanned = context.first_scan().map(Into::into);
    for center in [places.first().map(|first| first.center), scanned] {
        places.extend(center.map(|center| Presence {
            center,
            radius: config.start_bubble_m / meters_per_unit,
        }));
    }
    places.push(Presence {
        center: pose.position.into(),
        radius,
    });
    places
}

fn register(context: &mut Context<'_>, scene: &Scene, report: &exit_finder::ExitReport) {
    let shared = &mut *context.shared;
    let epoch = shared.knowledge.epoch();
    let frames = shared.knowledge.trail().poses().iter();
    let trail: Vec<[f64; 3]> = frames
        .filter(|frame| frame.epoch == epoch)
        .map(|frame| frame.world_from_camera.translation.vector.into())
        .collect();
    let exploration = &shared.config.exploration;
    // What is refused was made in another epoch: the next scan will be in this one.
    let _refused = shared
        .explored
        .register(report, &trail, exploration, scene.meters_per_unit);
}

/// The places that the drone can reach, in a band about the height of the first scan.
fn flood(context: &mut Context<'_>, pose: &LevelPose, scene: &Scene, radii: RouteRadii) -> Reach {
    let band = scene.units(context.config.exploration.height_band_m);
    let raised = context
        .first_scan()
        .map_or(0.0, |first| pose.up.dot(&(pose.position - first)));
    let limits = ReachLimits {
        step: scene.free.resolution(),
        below: (band + raised).max(0.0),
        above: (band - raised).max(0.0),
        least: radii.least,
        comfortable: radii.comfortable,
        max_places: MOST_PLACES,
    };
    staged(context.stages, Stage::Choose, || {
        Reach::flood(pose, &limits, scene)
    })
}

fn distance(reach: &Reach, place: usize, pose: &LevelPose) -> f64 {
    reach
        .position(place)
        .map_or(f64::INFINITY, |position| (position - pose.position).norm())
}
