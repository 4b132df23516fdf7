//! What a mission leaves behind for reports: scans, cycles and the flown path.

use core::time::Duration;

use exit_finder::ExitReport;
use exit_finder::sites::SiteGraph;
use nalgebra::Point3;

use super::event::{Goal, Logged};
use super::outcome::Outcome;
use super::trail::TrailPose;
use crate::scene::Scene;

/// One turn on the spot.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// When it began.
    pub time: Duration,
    /// Epoch and position, map units; `None` when the pose was unknown.
    pub position: Option<(u64, Point3<f64>)>,
    /// The frame of [`MissionRecord::trail`] at which it began; `None` when the pose was unknown.
    pub frame: Option<usize>,
}

/// One pass of clean, exits, obstacles, plan, refine.
#[derive(Debug, Clone)]
pub struct Cycle {
    /// When it happened.
    pub time: Duration,
    /// Where the drone was, map units.
    pub position: Point3<f64>,
    /// Points of the map.
    pub points: usize,
    /// Points that were kept.
    pub kept: usize,
    /// What was seen around, when the cycle followed a scan.
    pub exits: Option<ExitReport>,
    /// The kept points among which `exits` was found; empty without it.
    pub cloud: Vec<[f64; 3]>,
    /// The path as planned, map units; empty when there was nowhere to go.
    pub raw_path: Vec<[f64; 3]>,
    /// The path as flown, map units.
    pub path: Vec<[f64; 3]>,
    /// What the flight is for.
    pub goal: Option<Goal>,
}

/// Everything about one mission.
#[derive(Debug)]
pub struct MissionRecord<'a> {
    /// How it ended; `None` while it goes on.
    pub outcome: Option<&'a Outcome>,
    /// All scans, oldest first.
    pub scans: &'a [Scan],
    /// All cycles, oldest first.
    pub cycles: &'a [Cycle],
    /// Sites and portals of the present epoch.
    pub sites: &'a SiteGraph,
    /// The last scene.
    pub scene: Option<&'a Scene>,
    /// Every tracked frame, where the latest map's keyframes put it.
    pub trail: &'a [TrailPose],
    /// Metres per map unit, if measured.
    pub meters_per_unit: Option<f64>,
    /// Unit up vector in the map's frame.
    pub up: [f64; 3],
    /// The story.
    pub log: &'a [Logged],
}
