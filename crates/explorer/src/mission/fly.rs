//! Fly a path leg by leg: turn, fly forward, look where the drone really is, go on from there.

use core::f64::consts::PI;

use nalgebra::{Point3, Vector3};
use tello_sdk::{Command, Distance, Speed, Waypoint};

use super::context::Context;
use super::maneuver::turn;
use super::phase::{Phase, Step};
use super::recover::Recover;
use super::scan::Scan;
use super::think::Think;
use crate::heading::LevelPose;
use crate::route::Route;

/// The drone cannot move by less.
const SHORTEST_MOVE_M: f64 = 0.20;
/// Turns below this are not worth flying, radians: the drone's own heading error is of that size.
const HEADING_TOLERANCE: f64 = 3.0 * PI / 180.0;
/// A waypoint counts as reached within this distance, metres: under the shortest move.
const REACHED_M: f64 = 0.15;
/// Moves on one path at most; more means that the drone makes no headway.
const MOST_MOVES: usize = 60;
/// Speed of slanted legs, centimetres per second.
const GO_SPEED_CM_S: i64 = 40;

/// What to do at the end of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Arrival {
    /// Turn on the spot: a new site.
    Site,
    /// Look at this place, map units.
    LookAt(Point3<f64>),
}

#[derive(Debug)]
pub(super) struct Fly {
    waypoints: Vec<Point3<f64>>,
    next: usize,
    moves: usize,
    /// Whether the turn for the present leg was made.
    turned: bool,
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
            turned: false,
            arrival,
        }
    }

    pub(super) fn next(&mut self, context: &mut Context<'_>) -> Step {
        let Some(pose) = context.knowledge.pose() else {
            return if context.knowledge.untracked_for() < context.config.lost_patience {
                Step::Wait
            } else {
                Step::Become(Phase::Recover(Recover::in_place()))
            };
        };
        let Some(meters_per_unit) = context.knowledge.meters_per_unit() else {
            return Step::Become(Phase::Think(Think::again()));
        };
        while let Some(&target) = self.waypoints.get(self.next) {
            let delta = pose.body_displacement(&target) * meters_per_unit;
            if delta.norm() < REACHED_M || !is_flyable(&delta) {
                self.next += 1;
                self.turned = false;
                continue;
            }
            return self.toward(context, &pose, &delta);
        }
        self.arrive(context, &pose)
    }

    /// One turn or one straight move towards a waypoint `delta` metres (forward, left, up) away.
    fn toward(&mut self, context: &Context<'_>, pose: &LevelPose, delta: &Vector3<f64>) -> Step {
        self.moves += 1;
        if self.moves > MOST_MOVES {
            return Step::Become(Phase::Think(Think::again()));
        }
        let level = delta.xy().norm();
        let angle = delta.y.atan2(delta.x);
        if !self.turned && level >= SHORTEST_MOVE_M && angle.abs() > HEADING_TOLERANCE {
            self.turned = true;
            if let Some(command) = turn(angle) {
                return Step::Send(command);
            }
        }
        self.turned = false;
        let Some((command, flown)) = straight(delta, context.config.longest_leg_m) else {
            self.next += 1;
            return Step::Wait;
        };
        if !move_is_free(context, pose, &flown) {
            return Step::Become(Phase::Think(Think::again()));
        }
        Step::Send(command)
    }

    fn arrive(&self, context: &mut Context<'_>, pose: &LevelPose) -> Step {
        match self.arrival {
            Arrival::Site => {
                if let Some(arrival) =
                    context.in_units(pose.up, context.config.exploration.arrival_m)
                {
                    context.atlas.arrive(&pose.position, arrival.norm());
                }
                Step::Become(Phase::Scan(Scan::full(context)))
            }
            Arrival::LookAt(target) => {
                Step::Become(Phase::Scan(Scan::look(context, pose.turn_to(&target))))
            }
        }
    }
}

fn is_flyable(delta: &Vector3<f64>) -> bool {
    delta.xy().norm() >= SHORTEST_MOVE_M || delta.z.abs() >= SHORTEST_MOVE_M
}

/// The command that flies towards `delta` metres, at most `longest`, and what it flies (forward, left, up).
fn straight(delta: &Vector3<f64>, longest: f64) -> Option<(Command, Vector3<f64>)> {
    let level = delta.xy().norm();
    if delta.z.abs() < SHORTEST_MOVE_M {
        let meters = level.min(longest);
        return Some((
            Command::Forward(Distance::from_meters(meters).ok()?),
            Vector3::new(meters, 0.0, 0.0),
        ));
    }
    if level < SHORTEST_MOVE_M {
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

/// Whether the move that is about to be flown, from where the drone really is and along its real heading, lies in proven-free
/// space: the body with half of the margin, since the other half is what position and heading errors may use up.
fn move_is_free(context: &Context<'_>, pose: &LevelPose, flown: &Vector3<f64>) -> bool {
    let Some(scene) = &context.scene else {
        return false;
    };
    let radius = scene.units(context.config.drone_radius_m + 0.5 * context.config.margin_m);
    let end = pose.position + pose.forward * scene.units(flown.x) + pose.up * scene.units(flown.z);
    scene.motion_is_free(&pose.position, &end, radius)
}
