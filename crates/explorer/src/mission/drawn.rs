//! Small scenes for tests, drawn in letters: what is wall, what is proven free, and where the drone stands.
//!
//! A letter is a square of 0.2 m; columns run along x, rows along z, y is down and one map unit is a metre. `#` is a wall full of points,
//! a space is unknown, everything else is proven free. The drone stands at `a` and looks along z; other letters name places.

use core::time::Duration;

use exit_finder::sites::PortalId;
use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};
use nalgebra::{Isometry3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use slam_bridge::{SlamUpdate, TrackingState};
use tello_sdk::{Source, Telemetry};

use super::Mission;
use super::context::Context;
use crate::config::MissionConfig;
use crate::heading::LevelPose;
use crate::reach::{Reach, ReachLimits};
use crate::scene::Scene;

/// Side of a letter, metres.
const CELL_M: f64 = 0.2;

/// A mission in the middle of a drawn scene.
pub(super) struct Drawn {
    pub(super) mission: Mission,
    pub(super) scene: Scene,
    plan: Vec<Vec<char>>,
    walls: Vec<[f64; 3]>,
    frames: u32,
}

impl Drawn {
    pub(super) fn new(plan: &[&str]) -> Self {
        let plan: Vec<Vec<char>> = plan.iter().map(|row| row.chars().collect()).collect();
        let config = MissionConfig::default();
        let walls: Vec<[f64; 3]> = cells(&plan)
            .filter(|&(letter, _)| letter == '#')
            .flat_map(|(_, middle)| wall(middle))
            .collect();
        let balls: Vec<[f64; 3]> = cells(&plan)
            .filter(|&(letter, _)| letter != '#' && letter != ' ')
            .flat_map(|(_, middle)| [-0.4, -0.2, 0.0, 0.2, 0.4].map(|y| [middle.x, y, middle.z]))
            .collect();
        let scene = Scene::proven(walls.clone(), &balls, 0.45 * CELL_M, &config);
        let mut drawn = Self {
            mission: Mission::new(config, 1).unwrap(),
            scene,
            plan,
            walls,
            frames: 0,
        };
        let knowledge = &mut drawn.mission.shared.knowledge;
        knowledge.calibrate(Vector3::new(0.0, 0.0, 0.4), Vector3::new(0.0, -0.4, 0.0));
        let start = drawn.place('a');
        drawn.fly_to(start, &Vector3::z());
        drawn
    }

    /// The middle of the first square with this letter.
    pub(super) fn place(&self, wanted: char) -> Point3<f64> {
        let mut cells = cells(&self.plan);
        cells.find(|&(letter, _)| letter == wanted).unwrap().1
    }

    /// The drone is tracked at a place and looks along `forward`.
    pub(super) fn fly_to(&mut self, place: Point3<f64>, forward: &Vector3<f64>) {
        self.frames += 1;
        let time = Duration::from_millis(100) * self.frames;
        let turn = Rotation3::face_towards(forward, &Vector3::y());
        let update = SlamUpdate {
            time,
            state: TrackingState::Tracking,
            world_from_camera: Some(Isometry3::from_parts(
                Translation3::from(place.coords),
                UnitQuaternion::from_rotation_matrix(&turn),
            )),
            epoch: 0,
            tracked_points: 100,
        };
        let telemetry = Telemetry::builder(time, Source::Simulated).build();
        let knowledge = &mut self.mission.shared.knowledge;
        knowledge.observe(time, &telemetry, Some(&update));
    }

    /// The drone turns once at a place, which becomes a site with the exits that are seen from there.
    pub(super) fn scan(&mut self, place: Point3<f64>) -> Vec<PortalId> {
        for step in 0..24 {
            let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), f64::from(step) * 0.2618);
            self.fly_to(place, &(turn * Vector3::z()));
        }
        let seen = self.walls.iter().copied();
        let seen: Vec<[f64; 3]> = seen.filter(|&point| self.shows(place, point)).collect();
        let plane = AffinePlane::from_up([0.0, -1.0, 0.0], place.into()).unwrap();
        let view = ExitView::default();
        let exits = ExitConfig::default();
        let report = find_exits(&seen, place.into(), &plane, &view, &exits).unwrap();
        let shared = &mut self.mission.shared;
        let before = shared.explored.graph().portals().len();
        let limits = &shared.config.exploration;
        shared.explored.register(&report, &[], limits, 1.0).unwrap();
        (before..shared.explored.graph().portals().len())
            .map(PortalId)
            .collect()
    }

    /// Whether no wall stands between a place and a point of a wall.
    fn shows(&self, place: Point3<f64>, point: [f64; 3]) -> bool {
        let way = Point3::from(point) - place;
        let steps = (way.norm() / (0.25 * CELL_M)).ceil() as i32;
        let own = self.square(&point.into());
        (0..steps).all(|step| {
            let passed = place + way * (f64::from(step) / f64::from(steps));
            let square = self.square(&passed);
            square == own || self.letter(square) != '#'
        })
    }

    fn square(&self, place: &Point3<f64>) -> [usize; 2] {
        [place.x, place.z].map(|part| (part / CELL_M).floor().max(0.0) as usize)
    }

    fn letter(&self, [column, row]: [usize; 2]) -> char {
        let letter = self.plan.get(row).and_then(|row| row.get(column));
        letter.copied().unwrap_or(' ')
    }

    pub(super) fn pose(&self) -> LevelPose {
        self.mission.shared.knowledge.pose().unwrap()
    }

    /// What can be reached from where the drone is, at its height.
    pub(super) fn reach(&self) -> Reach {
        let config = &self.mission.shared.config;
        let limits = ReachLimits {
            step: self.scene.free.resolution(),
            below: 0.0,
            above: 0.0,
            least: config.planning_radius_m(),
            comfortable: config.comfortable_radius_m(),
            max_places: 10_000,
        };
        Reach::flood(&self.pose(), &limits, &self.scene)
    }

    /// The mission's own context, and the scene beside it.
    pub(super) fn with_context<T>(&mut self, act: impl FnOnce(&mut Context<'_>, &Scene) -> T) -> T {
        let mut context = Context {
            shared: &mut self.mission.shared,
            stages: &mut (),
        };
        act(&mut context, &self.scene)
    }
}

/// All squares with the middles of their letters, at flying height.
fn cells(plan: &[Vec<char>]) -> impl Iterator<Item = (char, Point3<f64>)> + '_ {
    plan.iter().enumerate().flat_map(|(row, letters)| {
        letters.iter().enumerate().map(move |(column, &letter)| {
            let middle = [column, row].map(|number| (number as f64 + 0.5) * CELL_M);
            (letter, Point3::new(middle[0], 0.0, middle[1]))
        })
    })
}

/// Points all over the wall in one square.
fn wall(middle: Point3<f64>) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for height in -4..=4 {
        for (x, z) in [(-0.05, -0.05), (-0.05, 0.05), (0.05, -0.05), (0.05, 0.05)] {
            let y = 0.15 * f64::from(height);
            points.push([middle.x + x, y, middle.z + z]);
        }
    }
    points
}
