//! Whole explorations in plan: scan, choose, fly through, scan again, until nothing is left.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

mod walls;

use exit_finder::sites::{History, PortalState, SiteConfig, SiteGraph, SiteId};
use exit_finder::{AffinePlane, ExitConfig, ExitReport, ExitView, Sector, find_exits};
use walls::{Walls, room};

/// What an exploration did.
struct Outcome {
    visited: Vec<[f64; 2]>,
    graph: SiteGraph,
    finished: bool,
}

/// Which way the map's axes point.
#[derive(Clone, Copy, PartialEq)]
enum Frame {
    /// z up.
    World,
    /// x right, y down, z forward: a SLAM map's.
    Camera,
}

impl Frame {
    fn up(self) -> [f64; 3] {
        self.map([0.0, 0.0, 1.0])
    }

    fn map(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::World => [x, y, z],
            Self::Camera => [x, -z, y],
        }
    }

    /// In plan.
    fn plan(self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        match self {
            Self::World => [x, y],
            Self::Camera => [x, z],
        }
    }
}

/// Explores like the mission does, for at most `limit` decisions.
fn explore(walls: &Walls, start: [f64; 2], limit: usize) -> Outcome {
    explore_in(Frame::World, walls, start, limit)
}

fn explore_in(frame: Frame, walls: &Walls, start: [f64; 2], limit: usize) -> Outcome {
    let config = ExitConfig {
        min_width: Some(0.6),
        ..Default::default()
    };
    let mut graph = SiteGraph::new(SiteConfig::for_scale(1.0)).unwrap();
    let (mut at, mut here) = (start, SiteId(0));
    let mut trajectory = Vec::new();
    let mut visited = vec![start];
    scan(frame, walls, at, &config, &mut graph, &trajectory);
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
        at = frame.plan(graph.sites()[here.0].position);
        let goal = frame.plan(portal.exit);
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
        trajectory.extend([frame.map([at[0], at[1], 1.0]), portal.middle()]);
        at = if walls.is_free(goal, beyond) {
            [0.5 * (goal[0] + beyond[0]), 0.5 * (goal[1] + beyond[1])]
        } else {
            goal
        };
        visited.push(at);
        here = SiteId(graph.sites().len());
        scan(frame, walls, at, &config, &mut graph, &trajectory);
    }
    Outcome {
        visited,
        graph,
        finished: false,
    }
}

fn scan(
    frame: Frame,
    walls: &Walls,
    at: [f64; 2],
    config: &ExitConfig,
    graph: &mut SiteGraph,
    trajectory: &[[f64; 3]],
) {
    let closed = graph.virtual_points(frame.map([at[0], at[1], 1.0]), 15.0);
    let report = found(frame, walls, at, &closed, config);
    let history = History {
        trajectory,
        ..Default::default()
    };
    graph.add_site(&report, &history).unwrap();
}

fn found(
    frame: Frame,
    walls: &Walls,
    at: [f64; 2],
    closed: &[[f64; 3]],
    config: &ExitConfig,
) -> ExitReport {
    let agent = frame.map([at[0], at[1], 1.0]);
    let plane = AffinePlane::from_up(frame.up(), agent).unwrap();
    let seen = walls.seen_from(at, 1080, 15.0);
    let points: Vec<[f64; 3]> = seen.into_iter().map(|point| frame.map(point)).collect();
    let view = ExitView {
        virtual_points: closed,
        ..Default::default()
    };
    find_exits(&points, agent, &plane, &view, config).unwrap()
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

/// Whatever a search reports, the graph asks for each door once.
fn decisions_with_random_reports(seed: u64) -> (usize, usize) {
    let config = SiteConfig::for_scale(1.0);
    let side = 8.0;
    let mut state = seed;
    // Numerical Recipes' linear congruential generator: any numbers will do.
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut graph = SiteGraph::new(config).unwrap();
    let pattern = found(
        Frame::World,
        &two_rooms(),
        [-0.2, 0.1],
        &[],
        &ExitConfig::default(),
    );
    let mut here = SiteId(0);
    let mut scan = |graph: &mut SiteGraph| {
        let mut report = pattern.clone();
        // A site that explores nothing, and five exits anywhere: the worst search there is.
        report.unseen = vec![Sector {
            start_rad: 0.0,
            width_rad: std::f64::consts::TAU,
        }];
        report.exits = (0..5)
            .map(|_| {
                let mut exit = pattern.exits[0].clone();
                let middle = [side * random(), side * random(), 1.0];
                exit.position = middle;
                exit.jambs = [-0.4, 0.4].map(|aside| [middle[0] + aside, middle[1], 1.0]);
                exit
            })
            .collect();
        graph.add_site(&report, &History::default()).unwrap().site
    };
    scan(&mut graph);
    let mut decisions = 0;
    while let Some(next) = graph.next_portal(here).unwrap() {
        decisions += 1;
        assert!(decisions < 10_000, "it never ends");
        if decisions % 3 == 0 {
            graph.block(next.portal).unwrap();
        } else {
            graph.traverse(next.portal).unwrap();
            here = scan(&mut graph);
        }
    }
    // The bound of the module's proof.
    let bound = 4.0 * (side / config.merge + 1.0).powi(2);
    (decisions, bound as usize)
}

#[test]
fn it_ends_whatever_the_searches_report() {
    for seed in 1..20 {
        let (decisions, bound) = decisions_with_random_reports(seed);
        assert!(decisions > 20, "{decisions}: the exits were hardly used");
        assert!(decisions <= bound, "{decisions} of at most {bound}");
    }
}

#[test]
fn a_map_with_y_down_is_explored_like_one_with_z_up() {
    let walls = two_rooms();
    let [world, camera] =
        [Frame::World, Frame::Camera].map(|frame| explore_in(frame, &walls, [-0.2, 0.1], 20));
    assert!(camera.finished);
    assert_eq!(world.visited.len(), camera.visited.len());
    for (a, b) in world.visited.iter().zip(&camera.visited) {
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 0.05, "{a:?} {b:?}");
    }
    // Portals stand at flying height: 1 m up is y = -1.
    assert!((camera.graph.portals()[0].middle()[1] + 1.0).abs() < 1e-9);
}
