//! States of portals, closing by virtual points, map corrections and epochs.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod walls;

use exit_finder::sites::{
    History, KeyframePose, PortalId, PortalState, Refusal, SiteConfig, SiteError, SiteGraph, SiteId,
};
use exit_finder::{AffinePlane, ExitConfig, ExitReport, ExitView, find_exits};
use walls::{Walls, room};

const AGENT: [f64; 3] = [0.0, 0.0, 1.0];
const LEVEL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A square room with doors to +x and −x in a hall.
fn report(closed: &[[f64; 3]]) -> ExitReport {
    let door = Some([1.55, 2.45]);
    let main = room([-2.0; 2], [2.0; 2], [None, door, None, door]);
    let hall = room([-6.0; 2], [6.0; 2], [None; 4]);
    let points = Walls([main.0, hall.0].concat()).seen_from([0.0; 2], 1080, 20.0);
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], AGENT).unwrap();
    let view = ExitView {
        virtual_points: closed,
        ..Default::default()
    };
    find_exits(&points, AGENT, &plane, &view, &ExitConfig::default()).unwrap()
}

fn graph() -> SiteGraph {
    SiteGraph::new(SiteConfig::for_scale(1.0)).unwrap()
}

#[test]
fn a_portal_is_used_once() {
    let mut graph = graph();
    let admission = graph.add_site(&report(&[]), &History::default()).unwrap();
    assert_eq!(admission.portals.len(), 2);
    graph.traverse(PortalId(0)).unwrap();
    assert_eq!(
        graph.traverse(PortalId(0)),
        Err(SiteError::Used {
            portal: 0,
            state: PortalState::Traversed
        })
    );
    // The passage failed on the way: it may still be blocked, once.
    graph.block(PortalId(0)).unwrap();
    assert!(matches!(
        graph.block(PortalId(0)),
        Err(SiteError::Used { .. })
    ));
    assert!(matches!(
        graph.block(PortalId(7)),
        Err(SiteError::UnknownPortal { .. })
    ));
    assert!(matches!(
        graph.next_portal(SiteId(3)),
        Err(SiteError::UnknownSite { .. })
    ));
    assert_eq!(
        graph.next_portal(SiteId(0)).unwrap().unwrap().portal,
        PortalId(1)
    );
}

#[test]
fn virtual_points_close_used_portals_only() {
    let mut graph = graph();
    graph.add_site(&report(&[]), &History::default()).unwrap();
    assert!(graph.virtual_points(AGENT, 10.0).is_empty());
    graph.traverse(PortalId(0)).unwrap();
    let closed = graph.virtual_points(AGENT, 10.0);
    assert!(graph.virtual_points([900.0, 0.0, 0.0], 10.0).is_empty());
    let again = report(&closed);
    assert_eq!(again.exits.len(), 1);
    let gone = graph.portals()[0].middle();
    assert!(again.exits[0].direction[0] * gone[0] < 0.0);
    assert!(again.profile.counts.hidden > 0 && again.profile.counts.virtual_used == closed.len());
    // A way that turned out to be blocked is closed like one that was used.
    graph.block(PortalId(1)).unwrap();
    assert!(report(&graph.virtual_points(AGENT, 10.0)).exits.is_empty());
}

#[test]
fn the_same_exits_are_no_new_portals() {
    let mut graph = graph();
    graph.add_site(&report(&[]), &History::default()).unwrap();
    let second = graph.add_site(&report(&[]), &History::default()).unwrap();
    assert!(second.portals.is_empty());
    assert_eq!(second.refused.len(), 2);
    assert!(matches!(second.refused[0].1, Refusal::Known(_)));
    let mut fresh = self::graph();
    let exit = report(&[]).exits[0].position;
    let history = History {
        trajectory: &[exit],
        ..Default::default()
    };
    let admission = fresh.add_site(&report(&[]), &history).unwrap();
    assert_eq!(admission.refused, vec![(0, Refusal::Flown)]);
}

#[test]
fn a_map_correction_moves_sites_and_portals() {
    let mut graph = graph();
    let pose = |position, rotation| {
        [KeyframePose {
            id: 4,
            rotation,
            position,
        }]
    };
    let before = pose([0.5, 0.0, 1.0], LEVEL);
    let history = History {
        keyframes: &before,
        ..Default::default()
    };
    graph.add_site(&report(&[]), &history).unwrap();
    let old: Vec<[f64; 3]> = graph
        .portals()
        .iter()
        .map(exit_finder::sites::Portal::middle)
        .collect();
    let quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let axes = graph.sites()[0].plane.axes();
    assert_eq!(graph.reanchor(&pose([10.0, 0.0, 1.0], quarter)), Ok(0));
    for (old, new) in axes.iter().zip(graph.sites()[0].plane.axes()) {
        let expected = [-old[1], old[0], old[2]];
        assert!(
            (0..3).all(|i| (new[i] - expected[i]).abs() < 1e-9),
            "{new:?}"
        );
    }
    for (old, portal) in old.iter().zip(graph.portals()) {
        let expected = [10.0 - old[1], old[0] - 0.5, old[2]];
        let new = portal.middle();
        assert!(
            (0..3).all(|i| (new[i] - expected[i]).abs() < 1e-9),
            "{new:?} {expected:?}"
        );
    }
    let site = &graph.sites()[0];
    assert!((site.position[0] - 10.0).abs() < 1e-9 && (site.position[1] + 0.5).abs() < 1e-9);
    assert!(site.contains([10.0, 0.5, 1.0], 0.3) && !site.contains([0.0, 0.0, 1.0], 0.3));
    let site_before = site.position;
    assert_eq!(
        graph.reanchor(&[]),
        Ok(3),
        "a lost keyframe leaves everything in place"
    );
    assert_eq!(graph.sites()[0].position, site_before);
    let broken = pose([f64::NAN; 3], LEVEL);
    assert_eq!(
        graph.reanchor(&broken),
        Err(SiteError::Pose { keyframe: 4 })
    );
}

#[test]
fn a_new_epoch_forgets_everything() {
    let mut graph = graph();
    graph.add_site(&report(&[]), &History::default()).unwrap();
    let late = History {
        epoch: 1,
        ..Default::default()
    };
    let refused = graph.add_site(&report(&[]), &late);
    assert_eq!(refused, Err(SiteError::Epoch { graph: 0, given: 1 }));
    graph.reset(1);
    assert!(graph.sites().is_empty() && graph.add_site(&report(&[]), &late).is_ok());
    let config = SiteConfig {
        merge: 0.0,
        ..SiteConfig::for_scale(1.0)
    };
    assert!(matches!(
        SiteGraph::new(config),
        Err(SiteError::Config { field: "merge", .. })
    ));
}

#[test]
fn what_hung_on_a_culled_keyframe_follows_the_nearest_that_is_left() {
    let mut graph = graph();
    let pose = |id, position| KeyframePose {
        id,
        rotation: LEVEL,
        position,
    };
    let before = [pose(4, AGENT), pose(5, [3.0, 0.0, 1.0])];
    let history = History {
        keyframes: &before,
        ..Default::default()
    };
    graph.add_site(&report(&[]), &history).unwrap();
    let site = graph.sites()[0].position;
    // Keyframe 4 goes; 5 moves at the same time, which tells nothing about the site.
    assert!(graph.reanchor(&[pose(5, [3.5, 0.0, 1.0])]).unwrap() >= 1);
    assert_eq!(graph.sites()[0].position, site);
    assert_eq!(graph.reanchor(&[pose(5, [3.5, 2.0, 1.0])]), Ok(0));
    let moved = graph.sites()[0].position;
    assert!((moved[1] - site[1] - 2.0).abs() < 1e-12, "{moved:?}");
}

#[test]
fn a_portal_into_what_a_later_scan_explored_is_exhausted() {
    // A ring: two doors lead into the same hall, which a scan behind the first one sees.
    let mut graph = graph();
    graph.add_site(&report(&[]), &History::default()).unwrap();
    assert_eq!(graph.unvisited().count(), 2);
    let mut behind = report(&[]);
    behind.exits.clear();
    // The same polygon without its doors reaches through them, to the walls of the hall.
    let admission = graph.add_site(&behind, &History::default()).unwrap();
    assert_eq!(admission.exhausted, [PortalId(0), PortalId(1)]);
    assert!(graph.unvisited().next().is_none() && graph.virtual_points(AGENT, 9.0).is_empty());
    assert!(graph.is_explored(graph.portals()[0].exit));
    assert!(!graph.is_explored([50.0, 0.0, 1.0]));
}

#[test]
fn other_distances_hold_from_the_next_scan_on() {
    let mut graph = graph();
    let flown = [report(&[]).exits[0].position.map(|part| 1.1 * part)];
    let history = History {
        trajectory: &flown,
        ..Default::default()
    };
    let mut narrow = graph.clone();
    narrow
        .set_config(SiteConfig {
            flown: 0.01,
            ..SiteConfig::for_scale(1.0)
        })
        .unwrap();
    assert_eq!(
        graph
            .add_site(&report(&[]), &history)
            .unwrap()
            .portals
            .len(),
        1
    );
    assert_eq!(
        narrow
            .add_site(&report(&[]), &history)
            .unwrap()
            .portals
            .len(),
        2
    );
    let broken = SiteConfig {
        shrink: f64::NAN,
        ..SiteConfig::for_scale(1.0)
    };
    assert!(graph.set_config(broken).is_err());
}
