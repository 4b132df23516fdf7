//! What all phases share: the configuration, what is known, the explored places, and the record.

use nalgebra::{Point3, Vector3};
use rand_pcg::Pcg64;

use super::event::{Event, Logged};
use super::knowledge::Knowledge;
use super::landing::Landing;
use super::maneuver::Maneuver;
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::pilot::{CommandOutcome, Finished};
use super::record::{Cycle, Scan};
use crate::atlas::Atlas;
use crate::config::MissionConfig;
use crate::scene::Scene;
use crate::stage::StageObserver;
use slam_bridge::Map;

/// Everything that outlives a phase.
pub(super) struct Shared {
    pub(super) config: MissionConfig,
    pub(super) knowledge: Knowledge,
    pub(super) rng: Pcg64,
    pub(super) atlas: Atlas,
    /// Epoch that the atlas and the scene belong to.
    pub(super) epoch: Option<u64>,
    pub(super) scene: Option<Scene>,
    pub(super) map: Option<Map>,
    pub(super) last: Option<Finished>,
    /// Failures of commands in a row.
    pub(super) failures: usize,
    pub(super) scans: Vec<Scan>,
    pub(super) triangle_flown: Option<u64>,
    pub(super) cycles: Vec<Cycle>,
    pub(super) log: Vec<Logged>,
    pub(super) outcome: Option<Outcome>,
}

/// What a phase works with.
pub(super) struct Context<'a> {
    pub(super) shared: &'a mut Shared,
    pub(super) stages: &'a mut dyn StageObserver,
}

impl core::ops::Deref for Context<'_> {
    type Target = Shared;

    fn deref(&self) -> &Shared {
        self.shared
    }
}

impl core::ops::DerefMut for Context<'_> {
    fn deref_mut(&mut self) -> &mut Shared {
        self.shared
    }
}

impl Shared {
    pub(super) fn log(&mut self, event: Event) {
        let time = self.knowledge.now();
        self.log.push(Logged { time, event });
    }

    pub(super) fn last_outcome(&self) -> Option<&CommandOutcome> {
        self.last.as_ref().map(|finished| &finished.outcome)
    }

    pub(super) fn set_outcome(&mut self, outcome: Outcome) {
        self.outcome = Some(outcome);
    }

    pub(super) fn land(&self, outcome: Outcome) -> Step {
        Step::Become(Phase::Land(Landing::new(outcome)))
    }

    /// Notes where this scan happens; a new epoch voids everything that was explored before.
    pub(super) fn begin_scan(&mut self) {
        self.follow_epoch();
        let position = self.knowledge.tracked_position();
        self.scans.push(Scan {
            time: self.knowledge.now(),
            position,
        });
    }

    pub(super) fn follow_epoch(&mut self) {
        let epoch = self.knowledge.epoch();
        if self.epoch.is_some_and(|known| known != epoch) {
            self.atlas = Atlas::default();
            self.scene = None;
        }
        self.epoch = Some(epoch);
    }

    /// Whether the plane (A, v) still has to be flown in this epoch.
    pub(super) fn needs_triangle(&self) -> bool {
        self.triangle_flown != Some(self.knowledge.epoch())
    }

    pub(super) fn triangle(&mut self) -> Phase {
        self.triangle_flown = Some(self.knowledge.epoch());
        Phase::Triangle(Maneuver::triangle(self.config.triangle_cm))
    }

    /// Whether the drone may climb by `meters`: within the start bubble before there is a scene, proven free afterwards.
    pub(super) fn vertical_is_free(&self, meters: f64) -> bool {
        let Some(scene) = &self.scene else {
            return meters <= self.config.start_bubble_m;
        };
        let Some(pose) = self.knowledge.pose() else {
            return false;
        };
        let radius = self.config.planning_radius_m();
        let top: Point3<f64> = pose.position + pose.up * scene.units(meters);
        scene.motion_is_free(&pose.position, &top, scene.units(radius))
    }

    /// Displacement of `meters` along `direction` in map units, with the latest scale.
    pub(super) fn in_units(&self, direction: Vector3<f64>, meters: f64) -> Option<Vector3<f64>> {
        Some(direction * (meters / self.knowledge.meters_per_unit()?))
    }
}
