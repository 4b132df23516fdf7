//! Fly a path leg by leg: turn, fly forward, look where the drone really is, go on from there.

use core::f64::consts::PI;

use exit_finder::sites::PortalId;
use nalgebra::{Point3, Rotation3, Unit, Vector3};
use tello_sdk::{Command, Distance, Speed, Waypoint};

use super::context::Context;
use super::facing::{COMFORTABLE, Facing};
use super::maneuver::turn;
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::recover::Recover;
use super::scan::Scan;
use super::think::Think;
use crate::heading::LevelPose;
use crate::route::Route;
use crate::scene::Scene;

/// The drone cannot move by less.
const SHORTEST_MOVE_M: f64 = 0.20;
/// Turns below this are not worth their two seconds, radians: legs are short and checked along the real heading.
const HEADING_TOLERANCE: f64 = 8.0 * PI / 180.0;
/// The same where a leg is free only along its exact heading.
const EXACT_HEADING: f64 = 2.0 * PI / 180.0;
/// A waypoint counts as reached within this distance, metres: under the shortest move.
const REACHED_M: f64 = 0.15;
/// Moves on one path at most; more means that the drone makes no headway.
const MOST_MOVES: usize = 60;
/// Speed of slanted legs, centimetres per second.
const GO_SPEED_CM_S: i64 = 40;

/// Steps in which a look is turned less far.
const LOOK_SHARES: u32 = 8;
/// Room that a leg keeps beyond what its errors need, metres, and the shares of the leg that are tried with it, the whole first: rather
/// a shorter leg than a narrow one.
const LEG_CHOICES: [(f64, &[f64]); 5] = [
    (0.10, &[1.0, 0.66]),
    (0.06, &[1.0, 0.66]),
    (0.10, &[0.4]),
    (0.06, &[0.4]),
    (0.02, &[1.0, 0.66, 0.4, 0.2]),
];
/// Legs out of a tight place, metres.
const ESCAPES_M: [f64; 3] = [0.2, 0.3, 0.4];
/// What such a leg must win in room, metres.
const LEAST_ESCAPE_M: f64 = 0.02;

/// What to do at the end of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Arrival {
    /// Land.
    Home,
    /// Turn on the spot: a new site. The portal that was flown through, if any.
    Site(Option<PortalId>),
    /// Look at the place behind this portal, which then is this many map units away.
    Look {
        /// The portal.
        portal: PortalId,
        /// Distance left, map units.
        left: f64,
    },
}

#[derive(Debug)]
pub(super) struct Fly {
    waypoints: Vec<Point3<f64>>,
    next: usize,
    moves: usize,
    /// Whether the present leg needs an exact heading.
    exact: bool,
    /// How the present leg is flown, once the turn for it was made.
    facing: Option<Facing>,
    arrival: Arrival,
}

impl Fly {
    pub(super) fn along(route: &Route, arrival: Arrival) -> Self {
        let waypoints = route
            .path
            .iter()
            .skip(1)
            .map(|&point| point.into())
            .collect();
        Self {
            waypoints,
            next: 0,
            moves: 0,
            exact: false,
            facing: None,
            arrival,
        }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        let Some(pose) = context.knowledge.pose() else {
            return if context.knowledge.untracked_for() < context.config.lost_patience {
                Step::Wait
            } else {
                Step::Become(Phase::Recover(Recover::turning_back(
                    context.retreat.take(),
                )))
            };
        };
        let Some(meters_per_unit) = context.knowledge.meters_per_unit() else {
            return Step::Become(Phase::Think(Think::again()));
        };
        while let Some(&target) = self.waypoints.get(self.next) {
            let delta = pose.body_displacement(&target) * meters_per_unit;
            if delta.norm() < REACHED_M || !is_flyable(&delta) {
                self.next += 1;
                self.facing = None;
                continue;
            }
            return self.toward(context, &pose, &delta);
        }
        arrive(context, &pose, self.arrival)
            .unwrap_or_else(|| Step::Become(Phase::Think(Think::again())))
    }

    /// One turn or one straight move towards a waypoint `delta` metres (forward, left, up) away.
    fn toward(&mut self, context: &Context<'_>, pose: &LevelPose, delta: &Vector3<f64>) -> Step {
        self.moves += 1;
        let Some(scene) = context.scene.as_ref().filter(|_| self.moves <= MOST_MOVES) else {
            return Step::Become(Phase::Think(Think::again()));
        };
        let level = delta.xy().norm();
        let angle = delta.y.atan2(delta.x);
        let longest = context.config.longest_leg_m;
        let facing = match self.facing {
            Some(facing) => facing,
            None => Facing::choose(scene, pose, angle, scene.units(level.min(longest))),
        };
        let error = wrap(angle - facing.bearing());
        let tolerance = if self.exact {
            EXACT_HEADING
        } else {
            HEADING_TOLERANCE
        };
        if self.facing.is_none() && level >= SHORTEST_MOVE_M && error.abs() > tolerance {
            self.facing = Some(facing);
            if let Some(command) = turn(error) {
                return Step::Send(command);
            }
        }
        match longest_free_leg(context, scene, pose, delta, facing) {
            Some(command) => {
                self.facing = None;
                self.exact = false;
                Step::Send(command)
            }
            // The same leg may be free when the drone heads straight along it.
            None if !self.exact => {
                self.facing = None;
                self.exact = true;
                Step::Wait
            }
            None => match escape(context, scene, pose) {
                Some(command) => {
                    self.facing = None;
                    Step::Send(command)
                }
                None => Step::Become(Phase::Think(Think::again())),
            },
        }
    }
}

/// What to do at the end of a path; `None` when that would show nothing new.
pub(super) fn arrive(
    context: &mut Context<'_>,
    pose: &LevelPose,
    arrival: Arrival,
) -> Option<Step> {
    match arrival {
        Arrival::Home => Some(context.land(context.homing.clone().unwrap_or(Outcome::Explored))),
        Arrival::Site(portal) => {
            if let Some(portal) = portal {
                context.explored.traverse(portal);
            }
            Some(Step::Become(Phase::Scan(Scan::full())))
        }
        Arrival::Look { portal, left } => look_at(context, pose, portal, left),
    }
}

/// Looks at the place behind a portal from here, `left` map units away, and notes that it did; `None` when there is nothing to
/// turn to and no room to climb, so that a look would show nothing new.
fn look_at(
    context: &mut Context<'_>,
    pose: &LevelPose,
    portal: PortalId,
    left: f64,
) -> Option<Step> {
    context.explored.note_approach(portal, left);
    let through = context.explored.portal(portal)?.exit.into();
    let towards = pose.turn_to(&through);
    let towards = context
        .scene
        .as_ref()
        .map_or(towards, |scene| tracked_turn(scene, pose, towards));
    let look = Scan::look(context, towards)?;
    Some(Step::Become(Phase::Scan(look)))
}

/// As much of a turn as keeps known points in view: what SLAM has never seen it cannot hold on to.
fn tracked_turn(scene: &Scene, pose: &LevelPose, turn: f64) -> f64 {
    let axis = Unit::new_normalize(pose.up);
    let shares = (0..=LOOK_SHARES)
        .rev()
        .map(|share| turn * f64::from(share) / f64::from(LOOK_SHARES));
    let mut turns = shares.filter(|&turn| {
        let forward = Rotation3::from_axis_angle(&axis, turn) * pose.forward;
        scene.sight.expected(&pose.position, &forward, &pose.up) >= COMFORTABLE
    });
    turns.next().unwrap_or(0.0)
}

fn is_flyable(delta: &Vector3<f64>) -> bool {
    delta.xy().norm() >= SHORTEST_MOVE_M || delta.z.abs() >= SHORTEST_MOVE_M
}

/// The command that flies towards `delta` metres, at most `longest`, and what it flies (forward, left, up).
fn straight(delta: &Vector3<f64>, facing: Facing, longest: f64) -> Option<(Command, Vector3<f64>)> {
    let level = delta.xy().norm();
    if delta.z.abs() < SHORTEST_MOVE_M {
        let meters = level.min(longest);
        return Some((
            facing.command(Distance::from_meters(meters).ok()?),
            facing.axis() * meters,
        ));
    }
    if level < SHORTEST_MOVE_M || facing != Facing::Ahead {
        let meters = Distance::from_meters(delta.z.abs().min(longest)).ok()?;
        let command = if delta.z > 0.0 {
            Command::Up(meters)
        } else {
            Command::Down(meters)
        };
        return Some((
            command,
            Vector3::new(0.0, 0.0, delta.z.signum() * meters.meters()),
        ));
    }
    let share = (longest / delta.norm()).min(1.0);
    let flown = Vector3::new(level * share, 0.0, delta.z * share);
    let to = Waypoint::from_cm(
        (flown.x * 100.0).round() as i64,
        0,
        (flown.z * 100.0).round() as i64,
    )
    .ok()?;
    let speed = Speed::from_cm_per_s(GO_SPEED_CM_S).ok()?;
    Some((Command::Go { to, speed }, flown))
}

/// The longest move towards `delta` metres that, from where the drone really is and along its real heading, lies in proven-free
/// space with room for the errors that grow along it.
fn longest_free_leg(
    context: &Context<'_>,
    scene: &Scene,
    pose: &LevelPose,
    delta: &Vector3<f64>,
    facing: Facing,
) -> Option<Command> {
    let longest = context.config.longest_leg_m.min(delta.norm());
    LEG_CHOICES.iter().find_map(|(spare, shares)| {
        shares.iter().find_map(|share| {
            let length = (longest * share).max(SHORTEST_MOVE_M);
            let (command, flown) = straight(delta, facing, length)?;
            let radius = scene.units(context.config.flying_radius_m(flown.norm()) + spare);
            let end = pose.position + in_map(pose, &flown) / scene.meters_per_unit;
            scene
                .motion_is_free(&pose.position, &end, radius)
                .then_some(command)
        })
    })
}

/// A short move out of a place that is tighter than a leg allows: one that never comes nearer to anything and ends with more room.
fn escape(context: &Context<'_>, scene: &Scene, pose: &LevelPose) -> Option<Command> {
    let enough = scene.units(context.config.flying_radius_m(0.0));
    let here = scene.clearance(&pose.position, enough);
    if here >= enough {
        return None;
    }
    let mut best: Option<(f64, Command)> = None;
    for facing in Facing::ALL {
        for meters in ESCAPES_M {
            let offset = in_map(pose, &(facing.axis() * meters)) / scene.meters_per_unit;
            let end = pose.position + offset;
            let room = scene.clearance(&end, 2.0 * enough);
            let wins = room > here + scene.units(LEAST_ESCAPE_M)
                && best.as_ref().is_none_or(|(most, _)| room > *most)
                && scene.motion_is_free(&pose.position, &end, 0.9 * here);
            if wins && let Ok(distance) = Distance::from_meters(meters) {
                best = Some((room, facing.command(distance)));
            }
        }
    }
    best.map(|(_, command)| command)
}

/// A displacement (forward, left, up) along the map's axes.
fn in_map(pose: &LevelPose, flown: &Vector3<f64>) -> Vector3<f64> {
    pose.forward * flown.x + pose.left() * flown.y + pose.up * flown.z
}

/// An angle in (−π, π].
pub(super) fn wrap(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}
