//! Whole explorations in plan: scan, choose, fly through, scan again, until nothing is left.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod walls;

use exit_finder::sites::{History, PortalState, SiteConfig, SiteGraph, SiteId};
use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};
use walls::{Walls, room};

/// What an exploration did.
struct Outcome {
    visited: Vec<[f64; 2]>,
    graph: SiteGraph,
    finished: bool,
}

/// Explores like the mission does, for at most `limit` decisions.
fn explore(walls: &Walls, start: [f64; 2], limit: usize) -> Outcome {
    let config = ExitConfig {
        min_width: Some(0.6),
        ..Default::default()
    };
    let mut graph = SiteGraph::new(SiteConfig::for_scale(1.0)).unwrap();
    let (mut at, mut here) = (start, SiteId(0));
    let mut trajectory = Vec::new();
    let mut visited = vec![start];
    scan(walls, at, &config, &mut graph, &trajectory);
    for _ in 0..limit {
        let Some(next) = graph.next_portal(here).unwrap() else {
            return Outcome {
                visited,
                graph,
                finished: true,
            };
        };
        let portal = graph.portals()[next.portal.0].clone();
        here = portal.from;
        let home = graph.sites()[here.0].position;
        at = [home[0], home[1]];
        let goal = [portal.exit[0], portal.exit[1]];
        if !walls.is_free(at, goal) {
            graph.block(next.portal).unwrap();
            continue;
        }
        graph.traverse(next.portal).unwrap();
        // Fly a little further than the exit point if there is room, so as not to scan in the door.
        let beyond = [
            goal[0] + 0.8 * (goal[0] - at[0]),
            goal[1] + 0.8 * (goal[1] - at[1]),
        ];
        trajectory.extend([
            [at[0], at[1], 1.0],
            [portal.middle()[0], portal.middle()[1], 1.0],
        ]);
        at = if walls.is_free(goal, beyond) {
            [0.5 * (goal[0] + beyond[0]), 0.5 * (goal[1] + beyond[1])]
        } else {
            goal
        };
        visited.push(at);
        here = SiteId(graph.sites().len());
        scan(walls, at, &config, &mut graph, &trajectory);
    }
    Outcome {
        visited,
        graph,
        finished: false,
    }
}

fn scan(
    walls: &Walls,
    at: [f64; 2],
    config: &ExitConfig,
    graph: &mut SiteGraph,
    trajectory: &[[f64; 3]],
) {
    let agent = [at[0], at[1], 1.0];
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], agent).unwrap();
    let points = walls.seen_from(at, 1080, 15.0);
    let closed = graph.virtual_points(agent, 15.0);
    let view = ExitView {
        virtual_points: &closed,
        ..Default::default()
    };
    let report = find_exits(&points, agent, &plane, &view, config).unwrap();
    let history = History {
        trajectory,
        ..Default::default()
    };
    graph.add_site(&report, &history).unwrap();
}

/// Two rooms of 4 m × 4 m side by side with a door of 1 m between them.
fn two_rooms() -> Walls {
    let left = room(
        [-2.0, -2.0],
        [2.0, 2.0],
        [None, Some([1.5, 2.5]), None, None],
    );
    let right = room(
        [2.0, -2.0],
        [6.0, 2.0],
        [None, None, None, Some([1.5, 2.5])],
    );
    Walls([left.0, right.0].concat())
}

#[test]
fn two_rooms_are_visited_once_each() {
    let outcome = explore(&two_rooms(), [-0.2, 0.1], 20);
    assert!(outcome.finished);
    assert_eq!(outcome.visited.len(), 2, "{:?}", outcome.visited);
    let [first, second] = [outcome.visited[0], outcome.visited[1]];
    assert!(first[0] < 2.0 && second[0] > 2.0);
    assert_eq!(outcome.graph.portals()[0].state, PortalState::Traversed);
    assert_eq!(outcome.graph.portals()[0].to, Some(SiteId(1)));
}

#[test]
fn a_ring_corridor_terminates() {
    // A corridor of 1.6 m around a block of 5 m × 5 m.
    let outer = room([0.0; 2], [8.2; 2], [None; 4]);
    let inner = room([1.6; 2], [6.6; 2], [None; 4]);
    let ring = Walls([outer.0, inner.0].concat());
    for start in [[0.8, 0.8], [4.0, 0.8], [0.8, 3.0], [7.4, 7.0]] {
        let outcome = explore(&ring, start, 60);
        assert!(outcome.finished, "{:?}", outcome.visited);
        assert!(outcome.visited.len() <= 12, "{:?}", outcome.visited);
    }
}

#[test]
fn a_row_of_rooms_is_walked_to_both_ends() {
    // Five rooms in a row, the start in the middle one: backtracking must reach the other end.
    let mut walls = Walls::default();
    for i in 0..5 {
        let low = [4.0 * f64::from(i), 0.0];
        let door = Some([1.5, 2.5]);
        let gaps = [None, door.filter(|_| i < 4), None, door.filter(|_| i > 0)];
        walls.0.extend(room(low, [low[0] + 4.0, 4.0], gaps).0);
    }
    let outcome = explore(&walls, [10.0, 1.6], 60);
    assert!(outcome.finished);
    let rooms: std::collections::BTreeSet<i64> = outcome
        .visited
        .iter()
        .map(|p| (p[0] / 4.0).floor() as i64)
        .collect();
    assert_eq!(rooms.len(), 5, "{:?}", outcome.visited);
}

#[test]
fn a_closed_room_is_explored_at_once() {
    let walls = room([-2.0; 2], [3.0, 2.0], [None; 4]);
    let outcome = explore(&walls, [0.1, 0.2], 5);
    assert!(outcome.finished);
    assert_eq!(outcome.visited.len(), 1);
}
