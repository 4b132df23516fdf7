//! What has been explored: `exit_finder`'s graph of scan sites and portals, with what the mission notes beside it.
//!
//! The graph drops an exit that leads into what an earlier site saw or close to where the drone has flown, closes passed portals
//! to later searches, and lets every portal be entered at most once: so a mission ends after finitely many scans. The mission adds how
//! often it tried to come to a portal, and the places that it flew to for another reason. All of it hangs on keyframes: a
//! corrected map moves it along, a new epoch voids it.

use exit_finder::ExitReport;
use exit_finder::sites::{
    Anchor, History, KeyframePose, Portal, PortalId, Site, SiteConfig, SiteError, SiteGraph,
};
use nalgebra::Point3;
use slam_bridge::Map;

use crate::config::ExplorationConfig;

/// Attempts to come to one portal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Attempts {
    /// How often the drone came nearer to look again.
    pub(super) approaches: usize,
    /// Least distance from which the drone has looked at it, map units.
    pub(super) closest: f64,
    /// Flights towards it that ended before they arrived.
    pub(super) failures: usize,
}

const NONE_YET: Attempts = Attempts {
    approaches: 0,
    closest: f64::INFINITY,
    failures: 0,
};

/// A place that was flown to for what no site had seen.
#[derive(Debug, Clone, Copy)]
struct Tried {
    place: Point3<f64>,
    anchor: Anchor,
}

/// Sites, portals, attempts and tried places of one epoch.
#[derive(Debug, Clone, Default)]
pub(super) struct Explored {
    graph: SiteGraph,
    /// One for each portal.
    attempts: Vec<Attempts>,
    tried: Vec<Tried>,
    keyframes: Vec<KeyframePose>,
}

impl Explored {
    pub(super) fn graph(&self) -> &SiteGraph {
        &self.graph
    }

    /// Where the drone turned and looked, map units.
    pub(super) fn sites(&self) -> impl Iterator<Item = Point3<f64>> + Clone {
        self.graph.sites().iter().map(|site| site.position.into())
    }

    /// Where flights went for what no site had seen, map units.
    pub(super) fn tried(&self) -> impl Iterator<Item = Point3<f64>> + Clone {
        self.tried.iter().map(|tried| tried.place)
    }

    /// Everything of another epoch is void.
    pub(super) fn follow_epoch(&mut self, epoch: u64) {
        if self.graph.epoch() != epoch {
            self.graph.reset(epoch);
            self.attempts.clear();
            self.tried.clear();
            self.keyframes.clear();
        }
    }

    /// Moves everything with the keyframes of a newer map of the same epoch.
    pub(super) fn follow_map(&mut self, map: &Map) {
        if map.epoch != self.graph.epoch() {
            return;
        }
        let keyframes = keyframe_poses(map);
        // A pose that is no rigid motion cannot tell where anything went: stay.
        if self.graph.reanchor(&keyframes).is_err() {
            return;
        }
        for tried in &mut self.tried {
            match tried.anchor.resolve(&keyframes) {
                Some(place) => tried.place = place.into(),
                None if keyframes.is_empty() => {}
                None => tried.anchor = Anchor::new(tried.place.into(), &keyframes),
            }
        }
        self.keyframes = keyframes;
    }

    /// Adds the site of `report` and its new exits; `trail` is the path flown in this epoch.
    pub(super) fn register(
        &mut self,
        report: &ExitReport,
        trail: &[[f64; 3]],
        exploration: &ExplorationConfig,
        meters_per_unit: f64,
    ) -> Result<(), SiteError> {
        self.graph
            .set_config(site_config(exploration, meters_per_unit))?;
        let history = History {
            epoch: self.graph.epoch(),
            trajectory: trail,
            keyframes: &self.keyframes,
        };
        self.graph.add_site(report, &history)?;
        self.attempts.resize(self.graph.portals().len(), NONE_YET);
        Ok(())
    }

    pub(super) fn portal(&self, portal: PortalId) -> Option<&Portal> {
        self.graph.portals().get(portal.0)
    }

    /// The site that saw a portal first.
    pub(super) fn finder_of(&self, portal: PortalId) -> Option<&Site> {
        self.graph.sites().get(self.portal(portal)?.from.0)
    }

    /// Whether the newest site saw the portal first.
    pub(super) fn is_newest(&self, portal: &Portal) -> bool {
        portal.from.0 + 1 == self.graph.sites().len()
    }

    pub(super) fn attempts(&self, portal: PortalId) -> Attempts {
        self.attempts.get(portal.0).copied().unwrap_or(NONE_YET)
    }

    /// Notes a look at the portal from a distance, map units.
    pub(super) fn note_approach(&mut self, portal: PortalId, left: f64) {
        if let Some(attempts) = self.attempts.get_mut(portal.0) {
            attempts.approaches += 1;
            attempts.closest = attempts.closest.min(left);
        }
    }

    /// Notes a flight that has not arrived yet.
    pub(super) fn note_failure(&mut self, portal: PortalId) {
        if let Some(attempts) = self.attempts.get_mut(portal.0) {
            attempts.failures += 1;
        }
    }

    /// Notes a flight to a place that is no portal.
    pub(super) fn note_tried(&mut self, place: Point3<f64>) {
        let anchor = Anchor::new(place.into(), &self.keyframes);
        self.tried.push(Tried { place, anchor });
    }

    /// The drone is behind the portal. Nothing happens when it had been used before.
    pub(super) fn traverse(&mut self, portal: PortalId) {
        // A used portal stays as it is: only its own flight ends here, and the next one goes elsewhere.
        let _used = self.graph.traverse(portal);
    }

    /// There is no way to the portal. Nothing happens when it had been used before.
    pub(super) fn block(&mut self, portal: PortalId) {
        let _used = self.graph.block(portal);
    }
}

/// The graph's distances from the mission's, map units.
fn site_config(exploration: &ExplorationConfig, meters_per_unit: f64) -> SiteConfig {
    SiteConfig {
        shrink: exploration.known_shrink_m / meters_per_unit,
        flown: exploration.known_distance_m / meters_per_unit,
        // The flown path tells where the drone has been, with a distance of its own.
        crowd: 0,
        ..SiteConfig::for_scale(1.0 / meters_per_unit)
    }
}

fn keyframe_poses(map: &Map) -> Vec<KeyframePose> {
    let poses = map.keyframes.iter().map(|keyframe| {
        let turn = keyframe.world_from_camera.rotation.to_rotation_matrix();
        let turn = turn.matrix();
        KeyframePose {
            id: keyframe.id.0,
            rotation: core::array::from_fn(|row| {
                core::array::from_fn(|column| turn[(row, column)])
            }),
            position: keyframe.center().into(),
        }
    });
    poses.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use exit_finder::sites::PortalState;
    use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};
    use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
    use slam_bridge::{KeyFrame, KeyFrameId};

    /// A room of 6 by 6 metres, y down, with a door of 20 degrees towards each bearing, behind which a wall is seen at 8 m.
    fn report(doors_deg: &[f64]) -> ExitReport {
        let points: Vec<[f64; 3]> = (0..720)
            .map(|i| (f64::from(i) * 0.5 + 0.25).to_radians())
            .map(|bearing| {
                let in_door =
                    |door: &f64| (bearing - door.to_radians()).cos() > 10f64.to_radians().cos();
                let range = if doors_deg.iter().any(in_door) {
                    8.0
                } else {
                    3.0 / bearing.cos().abs().max(bearing.sin().abs())
                };
                [range * bearing.cos(), 0.0, range * bearing.sin()]
            })
            .collect();
        let plane = AffinePlane::from_up([0.0, -1.0, 0.0], [0.0; 3]).unwrap();
        let view = ExitView::default();
        find_exits(&points, [0.0; 3], &plane, &view, &ExitConfig::default()).unwrap()
    }

    fn register(explored: &mut Explored, doors_deg: &[f64], trail: &[[f64; 3]]) -> usize {
        let before = explored.graph().portals().len();
        let limits = ExplorationConfig::default();
        explored
            .register(&report(doors_deg), trail, &limits, 1.0)
            .unwrap();
        explored.graph().portals().len() - before
    }

    /// A map of one keyframe.
    fn map(epoch: u64, id: u64, world_from_camera: Isometry3<f64>) -> Map {
        Map {
            epoch,
            keyframes: vec![KeyFrame {
                id: KeyFrameId(id),
                time: None,
                world_from_camera,
            }],
            ..Map::default()
        }
    }

    #[test]
    fn every_exit_is_listed_once_and_entered_once() {
        let mut explored = Explored::default();
        assert_eq!(register(&mut explored, &[0.0, 120.0], &[]), 2);
        assert_eq!(register(&mut explored, &[0.0, 120.0], &[]), 0);
        assert_eq!(explored.sites().count(), 2);
        explored.traverse(PortalId(0));
        explored.block(PortalId(1));
        assert_eq!(explored.graph().unvisited().count(), 0);
        // Traversed before it was blocked, blocked before it was traversed: neither is taken back.
        explored.traverse(PortalId(1));
        assert_eq!(
            explored.portal(PortalId(1)).map(|portal| portal.state),
            Some(PortalState::Blocked)
        );
    }

    #[test]
    fn an_exit_that_was_flown_through_is_none() {
        let through = report(&[0.0]).exits[0].position;
        let mut explored = Explored::default();
        assert_eq!(
            register(&mut explored, &[0.0, 120.0], &[[0.0; 3], through]),
            1
        );
    }

    #[test]
    fn attempts_count_for_their_portal_alone() {
        let mut explored = Explored::default();
        register(&mut explored, &[0.0, 120.0], &[]);
        explored.note_approach(PortalId(1), 2.0);
        explored.note_approach(PortalId(1), 3.0);
        explored.note_failure(PortalId(1));
        let counted = explored.attempts(PortalId(1));
        assert_eq!((counted.approaches, counted.failures), (2, 1));
        assert!((counted.closest - 2.0).abs() < 1e-12);
        assert_eq!(explored.attempts(PortalId(0)), NONE_YET);
        assert_eq!(explored.attempts(PortalId(9)), NONE_YET);
    }

    #[test]
    fn a_corrected_map_moves_sites_portals_and_tried_places() {
        let mut explored = Explored::default();
        explored.follow_map(&map(0, 5, Isometry3::identity()));
        register(&mut explored, &[0.0], &[]);
        explored.note_tried(Point3::new(1.0, 0.0, 2.0));
        let before = Point3::from(explored.portal(PortalId(0)).unwrap().exit);
        let correction = Isometry3::from_parts(
            Translation3::new(0.5, 0.0, -1.0),
            UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.3),
        );
        explored.follow_map(&map(0, 5, correction));
        let after = Point3::from(explored.portal(PortalId(0)).unwrap().exit);
        assert!((after - correction * before).norm() < 1e-9);
        let site = explored.sites().next().unwrap();
        assert!((site - correction * Point3::origin()).norm() < 1e-9);
        let tried = explored.tried().next().unwrap();
        assert!((tried - correction * Point3::new(1.0, 0.0, 2.0)).norm() < 1e-9);
        // The keyframe was culled: everything stays, hangs on the one that is left, and moves with that.
        explored.follow_map(&map(0, 6, Isometry3::identity()));
        explored.follow_map(&map(0, 6, Isometry3::translation(0.0, 0.0, 4.0)));
        let moved = explored.tried().next().unwrap();
        assert!((moved - tried - Vector3::new(0.0, 0.0, 4.0)).norm() < 1e-9);
        let moved = Point3::from(explored.portal(PortalId(0)).unwrap().exit);
        assert!((moved - after - Vector3::new(0.0, 0.0, 4.0)).norm() < 1e-9);
    }

    #[test]
    fn a_new_epoch_voids_everything_and_a_map_of_another_one_moves_nothing() {
        let mut explored = Explored::default();
        register(&mut explored, &[0.0], &[]);
        explored.note_tried(Point3::origin());
        explored.note_failure(PortalId(0));
        explored.follow_map(&map(3, 5, Isometry3::translation(9.0, 0.0, 0.0)));
        assert_eq!(explored.sites().next(), Some(Point3::origin()));
        explored.follow_epoch(0);
        assert_eq!(explored.tried().count(), 1, "the same epoch goes on");
        explored.follow_epoch(3);
        assert_eq!(explored.sites().count() + explored.tried().count(), 0);
        assert_eq!(explored.attempts(PortalId(0)), NONE_YET);
        assert_eq!(register(&mut explored, &[0.0], &[]), 1);
    }
}
