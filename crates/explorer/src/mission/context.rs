//! What all phases share: the configuration, what is known, the explored places, and the record.

use std::sync::Arc;

use nalgebra::Point3;
use rand_pcg::Pcg64;

use super::event::{Event, Logged};
use super::explored::Explored;
use super::knowledge::Knowledge;
use super::landing::Landing;
use super::maneuver::Maneuver;
use super::outcome::Outcome;
use super::phase::{Phase, Step};
use super::pilot::{CommandOutcome, Finished};
use super::record::{Cycle, Scan};
use super::retreat::Retreat;
use crate::config::MissionConfig;
use crate::scene::Scene;
use crate::stage::StageObserver;
use slam_bridge::Map;

/// Everything that outlives a phase.
pub(super) struct Shared {
    pub(super) config: MissionConfig,
    pub(super) knowledge: Knowledge,
    pub(super) rng: Pcg64,
    pub(super) explored: Explored,
    /// Epoch that what was explored and the scene belong to.
    pub(super) epoch: Option<u64>,
    pub(super) scene: Option<Arc<Scene>>,
    pub(super) map: Option<Map>,
    pub(super) last: Option<Finished>,
    pub(super) retreat: Retreat,
    /// Failures of commands in a row.
    pub(super) failures: usize,
    /// Whether the drone still obeys sticks that are not at rest.
    pub(super) sticks_held: bool,
    pub(super) scans: Vec<Scan>,
    /// Why the drone is on its way home, if it is.
    pub(super) homing: Option<Outcome>,
    /// Flights home so far.
    pub(super) home_flights: usize,
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

    /// Above the place where the drone was first tracked in this epoch, at its present height, map units: in the first epoch, above
    /// the place where it took off.
    pub(super) fn home(&self) -> Option<Point3<f64>> {
        let (_, here) = self.knowledge.tracked_position()?;
        let first = self.first_place()?;
        let up = self.knowledge.up();
        Some(first + up * up.dot(&(here - first)))
    }

    /// Where the drone was first tracked in this epoch, map units.
    pub(super) fn first_place(&self) -> Option<Point3<f64>> {
        let epoch = self.knowledge.epoch();
        let mut trail = self.knowledge.trail().poses().iter();
        let first = trail.find(|frame| frame.epoch == epoch)?;
        Some(Point3::from(first.world_from_camera.translation.vector))
    }

    /// Where the first scan of this epoch was made, map units.
    pub(super) fn first_scan(&self) -> Option<Point3<f64>> {
        let epoch = self.knowledge.epoch();
        let mut scans = self.scans.iter().filter_map(|scan| scan.position);
        scans.find(|(of, _)| *of == epoch).map(|(_, place)| place)
    }

    /// Charge that the way home costs, percent.
    pub(super) fn charge_home(&self) -> f64 {
        let (Some(home), Some((_, here)), Some(scale)) = (
            self.home(),
            self.knowledge.tracked_position(),
            self.knowledge.meters_per_unit(),
        ) else {
            return 0.0;
        };
        (here - home).norm() * scale * self.config.battery_percent_per_meter_home
    }

    /// The flown path backwards, thinned to a quarter of a metre, map units.
    pub(super) fn way_came(&self, scene: &Scene) -> Vec<[f64; 3]> {
        let epoch = self.knowledge.epoch();
        let mut way: Vec<[f64; 3]> = Vec::new();
        for frame in self
            .knowledge
            .trail()
            .poses()
            .iter()
            .rev()
            .filter(|frame| frame.epoch == epoch)
        {
            let place = Point3::from(frame.world_from_camera.translation.vector);
            let near = way
                .last()
                .is_some_and(|&last| (place - Point3::from(last)).norm() < scene.units(0.25));
            if !near {
                way.push(place.into());
            }
        }
        way
    }

    /// Notes where this scan happens; a new epoch voids everything that was explored before.
    pub(super) fn begin_scan(&mut self) {
        self.follow_epoch();
        self.retreat.forget();
        let position = self.knowledge.tracked_position();
        let frames = self.knowledge.trail().poses().len();
        self.scans.push(Scan {
            time: self.knowledge.now(),
            position,
            frame: position.and(frames.checked_sub(1)),
        });
    }

    /// Moves all that is remembered to where the map's keyframes are now.
    pub(super) fn follow_map(&mut self, map: &Map) {
        self.explored.follow_map(map);
        self.knowledge.follow_map(map);
        for scan in &mut self.scans {
            let frame = scan
                .frame
                .and_then(|at| self.knowledge.trail().poses().get(at));
            scan.position = frame.map(|frame| {
                let place = frame.world_from_camera.translation.vector.into();
                (frame.epoch, place)
            });
        }
    }

    pub(super) fn follow_epoch(&mut self) {
        let epoch = self.knowledge.epoch();
        if self.epoch.is_some_and(|known| known != epoch) {
            self.scene = None;
        }
        self.explored.follow_epoch(epoch);
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

    /// Whether the drone may climb by `meters` (negative: sink): within the start bubble before there is a scene, proven free
    /// afterwards.
    pub(super) fn vertical_is_free(&self, meters: f64) -> bool {
        let Some(scene) = &self.scene else {
            return meters > 0.0 && meters <= self.config.start_bubble_m;
        };
        let Some(pose) = self.knowledge.pose() else {
            return false;
        };
        let radius = scene.units(self.config.flying_radius_m(meters));
        let end: Point3<f64> = pose.position + pose.up * scene.units(meters);
        scene.motion_is_free(&pose.position, &end, radius)
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawn::Drawn;
    use super::*;
    use nalgebra::{Isometry3, Vector3};
    use slam_bridge::{KeyFrame, KeyFrameId};

    /// A map of one keyframe that stands `meters` along x.
    fn map(meters: f64) -> Map {
        Map {
            keyframes: vec![KeyFrame {
                id: KeyFrameId(1),
                time: None,
                world_from_camera: Isometry3::translation(meters, 0.0, 0.0),
            }],
            ..Map::default()
        }
    }

    #[test]
    fn a_corrected_map_moves_the_scans_the_way_home_and_home() {
        let mut drawn = Drawn::new(&["#######", "#a...b#", "#######"]);
        let start = drawn.place('a');
        let far = drawn.place('b');
        drawn.with_context(|context, _| context.begin_scan());
        drawn.fly_to(far, &Vector3::x());
        drawn.with_context(|context, scene| {
            context.follow_map(&map(0.0));
            context.follow_map(&map(3.0));
            let moved = Vector3::new(3.0, 0.0, 0.0);
            let places = [context.first_scan(), context.first_place()];
            for place in places {
                assert!(
                    (place.unwrap() - (start + moved)).norm() < 1e-9,
                    "{place:?}"
                );
            }
            let way: Vec<Point3<f64>> = context.way_came(scene).iter().map(|&p| p.into()).collect();
            assert!((way[0] - (far + moved)).norm() < 1e-9, "{way:?}");
            assert!(
                (way.last().unwrap() - (start + moved)).norm() < 1e-9,
                "{way:?}"
            );
        });
    }
}
