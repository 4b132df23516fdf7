//! Whatever numbers come in, nothing panics and nothing hangs: NaN, infinities, 1e200, 1e-300, ranges of any size.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod walls;

use exit_finder::sites::{
    Anchor, History, KeyframePose, PortalId, PortalState, SiteConfig, SiteGraph, SiteId,
};
use exit_finder::{
    AffinePlane, ExitConfig, ExitReport, ExitView, Gaze, HeightBand, LiveProfile, RangeProfile,
    Ray, exits_of_profile, find_exits,
};
use proptest::prelude::*;
use walls::room;

/// Mostly ordinary numbers, and every kind that breaks arithmetic.
fn wild() -> impl Strategy<Value = f64> {
    let broken = vec![
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        -1e308,
        1e200,
        -1e200,
        1e-300,
        -0.0,
    ];
    prop_oneof![6 => -3.0f64..3.0, 2 => prop::sample::select(broken)]
}

fn place() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(wild())
}

fn cloud(most: usize) -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec(place(), 0..most)
}

const AGENT: [f64; 3] = [0.0, 0.0, 1.0];

fn level() -> AffinePlane {
    AffinePlane::from_up([0.0, 0.0, 1.0], AGENT).unwrap()
}

/// A room with two doors, some of whose points are replaced.
fn spoilt_room(broken: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let door = Some([1.55, 2.45]);
    let main = room([-2.0; 2], [2.0; 2], [None, door, None, door]);
    let hall = room([-6.0; 2], [6.0; 2], [None; 4]);
    let walls = walls::Walls([main.0, hall.0].concat());
    let mut points = walls.seen_from([0.0; 2], 360, 20.0);
    let step = (points.len() / broken.len().max(1)).max(1);
    for (slot, &point) in points.iter_mut().step_by(step).zip(broken) {
        *slot = point;
    }
    points
}

fn report(points: &[[f64; 3]], view: &ExitView<'_>) -> Option<ExitReport> {
    find_exits(points, AGENT, &level(), view, &ExitConfig::default()).ok()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn planes_are_orthonormal_or_refused(
        up in place(), a in place(), b in place(), c in place(), more in cloud(8), q in prop::array::uniform2(wild()),
    ) {
        let planes = [
            AffinePlane::from_up(up, a).ok(),
            AffinePlane::from_three_points(a, b, c, up).ok(),
            AffinePlane::from_points(&more, up).ok().map(|fit| fit.plane),
            AffinePlane::from_basis(a, [b, c]).ok(),
        ];
        for plane in planes.into_iter().flatten() {
            let [x, y] = plane.axes();
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            prop_assert!(dot(x, y).abs() < 1e-5 && (dot(x, x) - 1.0).abs() < 1e-5);
            prop_assert!((dot(plane.normal(), plane.normal()) - 1.0).abs() < 1e-5);
            prop_assert!(plane.origin().iter().all(|part| part.is_finite()));
            let (_, _, _) = (plane.project(b), plane.lift(q), plane.height(c));
            if let Some(bearing) = plane.bearing(c) {
                prop_assert!((0.0..std::f64::consts::TAU).contains(&bearing));
            }
        }
    }

    #[test]
    fn views_and_closed_doors_of_any_size_are_survived(
        broken in cloud(40), closed in cloud(20), gazes in prop::collection::vec((place(), place(), wild()), 0..6),
        rays in prop::collection::vec((place(), place()), 0..40), heading in place(), heights in prop::array::uniform2(wild()),
    ) {
        let points = spoilt_room(&broken);
        let gazes: Vec<Gaze> = gazes
            .into_iter()
            .map(|(position, forward, half_fov_rad)| Gaze { position, forward, half_fov_rad })
            .collect();
        let rays: Vec<Ray> = rays.into_iter().map(|(origin, end)| Ray { origin, end }).collect();
        let view = ExitView { heading: Some(heading), gazes: &gazes, virtual_points: &closed, doubtful: &closed, rays: &rays };
        let Some(found) = report(&points, &view) else { return Ok(()) };
        for exit in &found.exits {
            prop_assert!(exit.position.iter().chain(exit.jambs.iter().flatten()).all(|part| part.is_finite()));
            let passage = exit.passage(&points, &found, &[heights, [-1.0, 1.0]]);
            prop_assert_eq!(passage.bands.len(), 2);
        }
    }

    #[test]
    fn a_living_profile_equals_a_fresh_one_whatever_came_and_went(
        broken in cloud(30), moves in prop::collection::vec((place(), place()), 0..20), agent in place(),
    ) {
        let config = ExitConfig { band: HeightBand::Off, ..ExitConfig::default() };
        prop_assert_eq!(
            LiveProfile::new(&broken, agent, &level(), &config).is_ok(),
            agent.iter().all(|part| part.is_finite())
        );
        let mut points = spoilt_room(&broken);
        let mut live = LiveProfile::new(&points, AGENT, &level(), &config).unwrap();
        for &(from, to) in &moves {
            live.insert(from);
            prop_assert!(live.relocate(from, to));
            points.push(to);
        }
        let fresh = RangeProfile::of_points(&points, &[], AGENT, &level(), &config);
        let (Ok(fresh), Ok(live)) = (fresh, live.profile()) else { return Ok(()) };
        prop_assert_eq!(fresh.counts, live.counts);
        prop_assert_eq!(fresh.bins, live.bins.clone());
        let view = ExitView::default();
        let _found = exits_of_profile(live, &view, &config);
    }

    #[test]
    fn the_graph_survives_any_place_and_any_correction(
        broken in cloud(30), exits in prop::collection::vec(prop::array::uniform3(place()), 1..5),
        trajectory in cloud(5), corrected in prop::collection::vec((0u64..4, place()), 0..4), agent in place(),
        radius in wild(), units in wild(),
    ) {
        let mut graph = SiteGraph::default();
        // A scale of any size is refused or works.
        let _refused = graph.set_config(SiteConfig::for_scale(units));
        let Some(mut found) = report(&spoilt_room(&broken), &ExitView::default()) else { return Ok(()) };
        let Some(pattern) = found.exits.first().cloned() else { return Ok(()) };
        found.exits = exits
            .iter()
            .map(|&[position, a, b]| {
                let mut exit = pattern.clone();
                (exit.position, exit.jambs) = (position, [a, b]);
                exit
            })
            .collect();
        let keyframes = [KeyframePose { id: 1, rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], position: AGENT }];
        let history = History { epoch: 0, trajectory: &trajectory, keyframes: &keyframes };
        graph.add_site(&found, &history).unwrap();
        graph.add_site(&found, &history).unwrap();
        let count = graph.portals().len();
        for id in (0..count).map(PortalId) {
            if graph.portals()[id.0].state == PortalState::Unvisited {
                graph.traverse(id).unwrap();
            }
        }
        prop_assert!(graph.virtual_points(agent, radius).len() <= count * 4097);
        let poses: Vec<KeyframePose> = corrected
            .iter()
            .map(|&(id, position)| KeyframePose { id, position, ..keyframes[0] })
            .collect();
        let finite = poses.iter().all(|pose| pose.position.iter().all(|part| part.is_finite()));
        prop_assert_eq!(graph.reanchor(&poses).is_ok(), finite);
        let _inside = graph.sites()[0].contains(agent, radius) | graph.is_explored(agent);
        prop_assert!(graph.next_portal(SiteId(0)).unwrap().is_none());
        let _anchored = Anchor::new(agent, &keyframes).resolve(&poses);
    }
}
