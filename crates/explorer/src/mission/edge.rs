//! Edges of what is proven: reached places with room between the obstacles ahead, but no proof of it.
//!
//! Behind an edge lies a doorway that was seen at a slant, or a blank wall: from the map alone nobody can tell. A camera that looked at it
//! from two places apart would have seen through a doorway, so such an edge is a wall, and is no longer open.
//! Input:  the floor's places, the scene, the trail of the camera. Output: the open edges.
//! Cost:   eight motion checks for every place near something, then a line of sight for every view of an edge until two count.

use core::f64::consts::{FRAC_PI_4, PI};

use nalgebra::{Point3, Rotation3, Unit, Vector3};
use sparse_to_obstacles::VoxelState;

use super::context::Shared;
use crate::heading::LevelPose;
use crate::reach::Place;
use crate::scene::Scene;

/// Views this far apart count as two, metres.
pub(super) const VANTAGE_M: f64 = 0.7;

/// How far ahead an edge must be clear of obstacles, metres: past the unproven band before a wall, which is a tenth of its distance.
const AHEAD_M: f64 = 0.9;
/// Where there may be known space again, in this length: then the unproven stretch is a gap of the proof, too short for a room.
const PAST_GAP: [f64; 3] = [1.0, 1.25, 1.5];
/// Half the width of what must be clear ahead, metres.
const AHEAD_RADIUS_M: f64 = 0.15;
/// From nearer an edge is not in view as a whole, from farther its surroundings have no parallax, metres.
const VIEW_M: core::ops::Range<f64> = 0.4..3.0;
/// Cosine of the largest angle between the camera's axis and an edge in view: half of 55 degrees and a margin.
const IN_VIEW: f64 = 0.91;
/// Cosine of the largest angle at which a doorway is looked through.
const FACING: f64 = 0.5;
/// Views of the trail are this far or this much turned apart, metres and cosine.
const NEXT_VIEW: (f64, f64) = (0.3, 0.97);
/// Open edges that are told apart at most.
const MOST_EDGES: usize = 200;
/// As far as points behind an edge are counted, metres.
const BEHIND_M: f64 = 4.5;
/// Points behind an edge that make it twice as promising, and how much more at most.
const TELLING_POINTS: f64 = 10.0;
const MOST_TOLD: f64 = 3.0;

/// What a second look at an edge is worth against the first: most were walls.
const SECOND_LOOK: f64 = 0.3;

/// A reached place with room ahead that nothing proves.
pub(super) struct Edge {
    position: Point3<f64>,
    /// Unit vector, level.
    ahead: Vector3<f64>,
    /// From where the camera looked at it, at most one place.
    vantage: Option<Point3<f64>>,
    /// Its length in metres, more where points lie behind it, less after a look at it.
    pub(super) weight: f64,
}

impl Edge {
    /// Whether a look from `place` would be a new view of it.
    pub(super) fn gains_from(&self, scene: &Scene, place: &Point3<f64>) -> bool {
        let apart = scene.units(VANTAGE_M);
        let fresh = self
            .vantage
            .is_none_or(|vantage| (vantage - place).norm() >= apart);
        fresh && self.shows_from(scene, place) && scene.sees(place, &self.position)
    }

    /// Whether it lies at a fitting distance and angle.
    fn shows_from(&self, scene: &Scene, place: &Point3<f64>) -> bool {
        let ray = self.middle(scene) - place;
        let range = ray.norm();
        VIEW_M.contains(&(range * scene.meters_per_unit)) && ray.dot(&self.ahead) > FACING * range
    }

    fn middle(&self, scene: &Scene) -> Point3<f64> {
        self.position + self.ahead * (0.5 * scene.units(AHEAD_M))
    }
}

/// Every edge that was not looked at from two places yet.
pub(super) fn open_edges(
    shared: &Shared,
    scene: &Scene,
    pose: &LevelPose,
    floor: &[(usize, Place)],
) -> Vec<Edge> {
    let views = views(shared, scene);
    let mut open = all_edges(shared, scene, pose, floor);
    open.retain_mut(|edge| {
        let apart = scene.units(VANTAGE_M);
        for (position, forward) in &views {
            let ray = edge.middle(scene) - position;
            let fresh = edge
                .vantage
                .is_none_or(|vantage| (vantage - position).norm() >= apart);
            let in_view = ray.dot(forward) > IN_VIEW * ray.norm();
            if fresh
                && in_view
                && edge.shows_from(scene, position)
                && scene.sees(position, &edge.position)
            {
                if edge.vantage.is_some() {
                    return false;
                }
                edge.vantage = Some(*position);
            }
        }
        true
    });
    let stride = open.len().div_ceil(MOST_EDGES).max(1);
    let mut kept: Vec<Edge> = open.into_iter().step_by(stride).collect();
    let cell = 2.0 * scene.free.resolution() * scene.meters_per_unit;
    for edge in &mut kept {
        let told = (points_behind(scene, edge) as f64 / TELLING_POINTS).min(MOST_TOLD);
        let news = if edge.vantage.is_some() {
            SECOND_LOOK
        } else {
            1.0
        };
        edge.weight = stride as f64 * cell * (1.0 + told) * news;
    }
    kept
}

fn all_edges(
    shared: &Shared,
    scene: &Scene,
    pose: &LevelPose,
    floor: &[(usize, Place)],
) -> Vec<Edge> {
    let axis = Unit::new_normalize(pose.up);
    let directions: [Vector3<f64>; 8] = core::array::from_fn(|side| {
        let turn = side as f64 * FRAC_PI_4 - PI;
        Rotation3::from_axis_angle(&axis, turn) * pose.forward
    });
    let (length, radius) = (scene.units(AHEAD_M), scene.units(AHEAD_RADIUS_M));
    let comfortable = scene.units(shared.config.comfortable_radius_m());
    let mut edges = Vec::new();
    for (_, place) in floor {
        if place.clearance >= comfortable {
            continue;
        }
        for ahead in &directions {
            let beyond = place.position + ahead * length;
            let (from, to) = (place.position.into(), beyond.into());
            let past = PAST_GAP.map(|share| place.position + ahead * (share * length));
            if !past.iter().any(|place| is_known(shared, scene, place))
                && !scene.sees(&place.position, &beyond)
                && scene.obstacles.motion_is_free(from, to, radius)
            {
                edges.push(Edge {
                    position: place.position,
                    ahead: *ahead,
                    vantage: None,
                    weight: 0.0,
                });
            }
        }
    }
    edges
}

/// Whether a place is proven free or well inside what a scan saw all around: what lies between is a gap in the proof, and leads nowhere
/// new.
fn is_known(shared: &Shared, scene: &Scene, place: &Point3<f64>) -> bool {
    let place = (*place).into();
    scene.free.state(place) == VoxelState::Free || shared.explored.graph().is_explored(place)
}

/// The camera's positions and axes of this epoch, thinned.
fn views(shared: &Shared, scene: &Scene) -> Vec<(Point3<f64>, Vector3<f64>)> {
    let epoch = shared.knowledge.epoch();
    let mut views: Vec<(Point3<f64>, Vector3<f64>)> = Vec::new();
    let trail = shared.knowledge.trail().poses().iter();
    for frame in trail.filter(|frame| frame.epoch == epoch) {
        let position = Point3::from(frame.world_from_camera.translation.vector);
        let forward = frame.world_from_camera.rotation * Vector3::z();
        let same = views.last().is_some_and(|(last, axis)| {
            (last - position).norm() < scene.units(NEXT_VIEW.0) && axis.dot(&forward) > NEXT_VIEW.1
        });
        if !same {
            views.push((position, forward));
        }
    }
    views
}

/// Points of the map that lie ahead, behind the edge.
fn points_behind(scene: &Scene, edge: &Edge) -> usize {
    let range = scene.units(AHEAD_M)..scene.units(BEHIND_M);
    let kept = scene.kept.iter();
    kept.filter_map(|&index| scene.points.get(index))
        .filter(|&&point| {
            let ray = Point3::from(point) - edge.position;
            let depth = ray.dot(&edge.ahead);
            range.contains(&depth) && depth > 0.94 * ray.norm()
        })
        .count()
}

#[cfg(test)]
mod tests {
    use super::super::drawn::Drawn;
    use super::*;

    /// A room whose wall towards +x has a stretch without points: blank, or a doorway. Beyond it nothing is known.
    const BLANK: [&str; 14] = [
        "#############      ",
        "#...........#      ",
        "#...........#      ",
        "#...........#      ",
        "#............      ",
        "#.a....b.c...      ",
        "#............      ",
        "#............      ",
        "#............      ",
        "#............      ",
        "#............      ",
        "#...........#      ",
        "#...........#      ",
        "#############      ",
    ];

    fn edges(drawn: &mut Drawn) -> Vec<Edge> {
        let (reach, pose) = (drawn.reach(), drawn.pose());
        let floor: Vec<(usize, Place)> = reach.places().iter().copied().enumerate().collect();
        drawn.with_context(|context, scene| open_edges(context.shared, scene, &pose, &floor))
    }

    #[test]
    fn edges_lead_to_where_points_and_proof_are_both_missing() {
        let edges = edges(&mut Drawn::new(&BLANK));
        assert!(!edges.is_empty());
        for edge in &edges {
            assert!(edge.position.x > 1.8, "{} has a wall ahead", edge.position);
            assert!(edge.ahead.x > 0.6, "{} leads back inside", edge.ahead);
        }
    }

    #[test]
    fn two_looks_from_apart_close_an_edge_and_one_makes_it_less_promising() {
        let mut drawn = Drawn::new(&BLANK);
        let straight = |edges: &[Edge]| {
            let ahead = edges.iter().filter(|edge| edge.ahead.x > 0.99);
            ahead.map(|edge| edge.weight).sum::<f64>()
        };
        // The drone begins at `a` and looks along z: no edge is in view.
        let fresh = straight(&edges(&mut drawn));
        let (middle, near) = (drawn.place('b'), drawn.place('c'));
        drawn.fly_to(middle, &Vector3::x());
        let once = straight(&edges(&mut drawn));
        assert!(once < 0.9 * fresh, "{once} of {fresh}");
        // From nearly the same place it is the same view.
        drawn.fly_to(near, &Vector3::x());
        let again = straight(&edges(&mut drawn));
        let start = drawn.place('a');
        drawn.fly_to(start, &Vector3::x());
        let twice = straight(&edges(&mut drawn));
        assert!(twice < 0.5 * again, "{twice} of {again}");
    }

    #[test]
    fn a_gap_of_the_proof_inside_a_known_room_is_no_edge() {
        let drawn = [
            "###############",
            "#.............#",
            "#.............#",
            "#.............#",
            "#.............#",
            "#..a..  ......#",
            "#.............#",
            "#.............#",
            "#.............#",
            "#.............#",
            "###############",
        ];
        let open = edges(&mut Drawn::new(&drawn));
        assert_eq!(open.len(), 0);
    }

    #[test]
    fn what_a_scan_saw_all_around_is_no_edge() {
        // A wide gap: nothing beyond is proven free near the wall, but a scan from `a` saw the wall behind it.
        let plan = [
            "###############",
            "#......       #",
            "#......       #",
            "#......       #",
            "#......       #",
            "#..a...       #",
            "#......       #",
            "#......       #",
            "#......       #",
            "###############",
        ];
        let mut drawn = Drawn::new(&plan);
        let open = edges(&mut drawn).len();
        let start = drawn.place('a');
        drawn.scan(start);
        drawn.fly_to(start, &-Vector3::x());
        let left = edges(&mut drawn).len();
        assert!(open > 0 && left < open / 2, "{left} of {open}");
    }
}
