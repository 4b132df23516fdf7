//! What the reached places leave open at flying height: floor that no scan saw, and edges behind which nothing is proven.
//!
//! Input:  the reached places, the scene, the sites scanned so far.
//! Output: the place from which a scan shows most unseen floor; the one from which it shows most open edges.
//! Method: a place is seen where the line from a site within the range of sight is proven free. Edges: see `edge.rs`.
//! Cost:   O(places · sites) lines of sight on a lattice thinned to 0.2 m.

use nalgebra::Point3;

use super::choice::Choice;
use super::context::Shared;
use super::edge::{VANTAGE_M, open_edges};
use super::event::Goal;
use super::fly::Arrival;
use crate::heading::LevelPose;
use crate::reach::{Place, Reach};
use crate::scene::Scene;

/// A scan shows floor up to this distance, metres.
pub(super) const SIGHT_M: f64 = 4.5;
/// A scan is taken to show unseen places within this distance, metres.
const UNSEEN_RANGE_M: f64 = 2.0;
/// Unseen places compared for the next scan at most.
const MOST_CANDIDATES: usize = 300;
/// Scan places have at least this much room around them, metres.
const SCAN_ROOM_M: f64 = 0.25;
/// Places compared for a scan of edges at most.
const MOST_EDGE_SCANS: usize = 60;
/// Length of edges, metres, that is worth a scan.
const LEAST_EDGES_M: f64 = 1.0;
/// A scan costs as much as a flight of this length, metres.
const SCAN_WAY_M: f64 = 4.0;

/// One look at the floor plan as it is known.
pub(super) struct Survey<'a> {
    shared: &'a Shared,
    scene: &'a Scene,
    pose: &'a LevelPose,
    /// Every second place at the drone's height, with its number.
    floor: Vec<(usize, Place)>,
    /// Those of them that no scan saw.
    unseen: Vec<(usize, Place)>,
}

impl<'a> Survey<'a> {
    pub(super) fn new(
        shared: &'a Shared,
        scene: &'a Scene,
        reach: &'a Reach,
        pose: &'a LevelPose,
    ) -> Self {
        let step = scene.free.resolution();
        let even = |length: f64| (length / step).round() as i64 % 2 == 0;
        let floor = reach
            .places()
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, place)| {
                let offset = pose.body_displacement(&place.position);
                offset.z.abs() < 0.5 * step && even(offset.x) && even(offset.y)
            });
        let floor: Vec<(usize, Place)> = floor.collect();
        let unseen = floor
            .iter()
            .filter(|(_, place)| !is_seen(shared, scene, &place.position))
            .copied()
            .collect();
        Self {
            shared,
            scene,
            pose,
            floor,
            unseen,
        }
    }

    /// Square metres that no scan saw and a scan at `place` shows.
    pub(super) fn unseen_near(&self, place: &Point3<f64>) -> f64 {
        let range = self.scene.units(UNSEEN_RANGE_M);
        let cell = 2.0 * self.scene.free.resolution() * self.scene.meters_per_unit;
        let near = self
            .unseen
            .iter()
            .filter(|(_, other)| (other.position - place).norm() < range);
        near.count() as f64 * cell * cell
    }

    /// The unseen square metres that a scan shows, and the reachable place for it. Each scan becomes a site, at a distance from all
    /// others, and each place is tried a few times, so there are finitely many.
    pub(super) fn unseen(&self) -> Option<(f64, usize)> {
        let (scene, unseen) = (self.scene, &self.unseen);
        let stride = unseen.len().div_ceil(MOST_CANDIDATES).max(1);
        let mut best: Option<(f64, f64, usize)> = None;
        for (index, place) in unseen.iter().step_by(stride) {
            if place.clearance < scene.units(SCAN_ROOM_M) || !self.is_new(&place.position) {
                continue;
            }
            let area = self.unseen_near(&place.position);
            let worth = area / (place.way * scene.meters_per_unit + SCAN_WAY_M);
            let enough = area >= self.shared.config.exploration.least_unseen_m2;
            if enough && best.is_none_or(|(most, ..)| worth > most) {
                best = Some((worth, area, *index));
            }
        }
        best.map(|(_, area, place)| (area, place))
    }

    /// The place from which a scan shows most of the edges that were not looked at from two places yet.
    pub(super) fn edges(&self) -> Option<Choice> {
        let (shared, scene) = (self.shared, self.scene);
        let open = open_edges(shared, scene, self.pose, &self.floor);
        let apart = scene.units(VANTAGE_M);
        let explored = &shared.explored;
        let is_new = |place: &Point3<f64>| {
            let near_site = explored.sites().any(|site| (site - place).norm() < apart);
            let tries = explored.tried();
            let in_vain = tries.filter(|tried| (tried - place).norm() < 0.5 * apart);
            !near_site && in_vain.count() < shared.config.exploration.failures
        };
        let candidates: Vec<&(usize, Place)> = self
            .floor
            .iter()
            .filter(|(_, place)| {
                place.clearance >= scene.units(SCAN_ROOM_M) && is_new(&place.position)
            })
            .collect();
        let stride = candidates.len().div_ceil(MOST_EDGE_SCANS).max(1);
        let mut best: Option<(f64, usize)> = None;
        for (index, place) in candidates.into_iter().step_by(stride) {
            let gain: f64 = open
                .iter()
                .filter(|edge| edge.gains_from(scene, &place.position))
                .map(|edge| edge.weight)
                .sum();
            let worth = gain / (place.way * scene.meters_per_unit + SCAN_WAY_M);
            if gain >= LEAST_EDGES_M && best.is_none_or(|(most, _)| worth > most) {
                best = Some((worth, *index));
            }
        }
        best.map(|(_, place)| Choice {
            place,
            goal: Goal::Edge,
            arrival: Arrival::Site(None),
        })
    }

    /// Whether a scan here would be a new one: far from other sites, and not flown to in vain again and again.
    fn is_new(&self, place: &Point3<f64>) -> bool {
        let exploration = &self.shared.config.exploration;
        let apart = self.scene.units(exploration.site_distance_m);
        let explored = &self.shared.explored;
        let near_site = explored.sites().any(|site| (site - place).norm() < apart);
        let in_vain = explored
            .tried()
            .filter(|tried| (tried - place).norm() < 0.5 * apart)
            .count();
        !near_site && in_vain < exploration.failures
    }
}

/// Whether a scan saw this place.
fn is_seen(shared: &Shared, scene: &Scene, place: &Point3<f64>) -> bool {
    let range = scene.units(SIGHT_M);
    let mut sites = shared.explored.sites();
    sites.any(|site| (site - place).norm() < range && scene.sees(&site, place))
}

#[cfg(test)]
mod tests {
    use super::super::drawn::Drawn;
    use super::*;

    /// Two rooms with a door; everything is proven free.
    const ROOMS: [&str; 16] = [
        "###########################",
        "#............#............#",
        "#............#............#",
        "#............#............#",
        "#............#............#",
        "#.....a......#............#",
        "#............#............#",
        "#.........................#",
        "#...................b.....#",
        "#.........................#",
        "#.........................#",
        "#............#............#",
        "#............#............#",
        "#............#............#",
        "#............#............#",
        "###########################",
    ];

    fn survey<T>(drawn: &mut Drawn, ask: impl FnOnce(&Survey<'_>, &Reach) -> T) -> T {
        let (reach, pose) = (drawn.reach(), drawn.pose());
        drawn.with_context(|context, scene| {
            ask(&Survey::new(context.shared, scene, &reach, &pose), &reach)
        })
    }

    #[test]
    fn floor_behind_a_door_is_unseen_until_a_scan_was_made_there() {
        let mut drawn = Drawn::new(&ROOMS);
        let (first, second) = (drawn.place('a'), drawn.place('b'));
        drawn.scan(first);
        let (area, place) = survey(&mut drawn, |survey, reach| {
            let (area, place) = survey.unseen().unwrap();
            (area, reach.position(place).unwrap())
        });
        assert!(place.x > 2.8, "{place} lies in the first room");
        assert!(area > 1.0 && area < 13.0, "{area} m2 within 2 m");
        drawn.scan(second);
        assert_eq!(survey(&mut drawn, |survey, _| survey.unseen()), None);
    }

    #[test]
    fn a_place_that_was_tried_in_vain_is_left_alone() {
        let mut drawn = Drawn::new(&ROOMS);
        let first = drawn.place('a');
        drawn.scan(first);
        let mut places = Vec::new();
        // Every place is tried three times at most, and there are finitely many.
        for _ in 0..200 {
            let place = survey(&mut drawn, |survey, reach| {
                reach.position(survey.unseen()?.1)
            });
            let Some(place) = place else { break };
            drawn.mission.shared.explored.note_tried(place);
            places.push(place);
        }
        assert!((4..200).contains(&places.len()), "{}", places.len());
        let failures = drawn.mission.shared.config.exploration.failures;
        for place in &places {
            let same = places.iter().filter(|other| (*other - place).norm() < 1e-9);
            assert!(same.count() <= failures);
        }
    }
}
