//! Two rooms joined by one door: the graph of sites closes the door behind the agent and then stops.
//!
//! Expected output: the door is taken once, and the second room has nothing left.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/walls/mod.rs"]
mod walls;

use exit_finder::sites::{Admission, History, SiteConfig, SiteGraph};
use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};
use walls::{Walls, room};

fn main() -> Result<(), Box<dyn std::error::Error>> {
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
    let rooms = Walls([left.0, right.0].concat());
    let mut graph = SiteGraph::new(SiteConfig::for_scale(1.0))?;

    let first = scan(&rooms, [0.0, 0.1, 1.0], &mut graph)?;
    let next = graph.next_portal(first.site)?.ok_or("no door")?;
    println!(
        "first room: {} portal, {:.1} m away",
        first.portals.len(),
        next.length
    );
    graph.traverse(next.portal)?;

    let second = scan(&rooms, [3.4, 0.0, 1.0], &mut graph)?;
    println!(
        "second room: {} portals, {} refused",
        second.portals.len(),
        second.refused.len()
    );
    let left_over = graph.next_portal(second.site)?;
    println!("next portal: {left_over:?}");
    assert!(left_over.is_none() && graph.portals().len() == 1);
    Ok(())
}

fn scan(
    rooms: &Walls,
    agent: [f64; 3],
    graph: &mut SiteGraph,
) -> Result<Admission, Box<dyn std::error::Error>> {
    let points = rooms.seen_from([agent[0], agent[1]], 1080, 15.0);
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], agent)?;
    let closed = graph.virtual_points(agent, 15.0);
    let view = ExitView {
        virtual_points: &closed,
        ..Default::default()
    };
    let config = ExitConfig {
        min_width: Some(0.6),
        ..Default::default()
    };
    let report = find_exits(&points, agent, &plane, &view, &config)?;
    Ok(graph.add_site(&report, &History::default())?)
}
