//! Exits of real room scans next to the openings labelled by eye. Reads the folder named by
//! EXPLORER_DATA, or the shared data folder beside the project.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../tests/real/mod.rs"]
mod real;

use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let agent = [0.0; 3];
    let plane = AffinePlane::from_up([0.0, -1.0, 0.0], agent)?;
    for (rule, config) in [
        ("range-aware", ExitConfig::default()),
        ("paper", ExitConfig::paper()),
        ("paper repaired", ExitConfig::paper_repaired()),
    ] {
        println!("{rule}");
        for room in real::ROOMS {
            let Some(points) = real::load(room.name) else {
                continue;
            };
            let report = match find_exits(&points, agent, &plane, &ExitView::default(), &config) {
                Ok(report) => report,
                Err(error) => {
                    println!("  {:10} {error}", room.name);
                    continue;
                }
            };
            let degrees = |rad: f64| (rad.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
            let exits: Vec<String> = report
                .exits
                .iter()
                .take(4)
                .map(|e| {
                    let (at, wide) = (degrees(e.bearing_rad), e.width_rad.to_degrees());
                    format!("{at:.0}±{:.0} {:?} {:.2}", wide / 2.0, e.kind, e.score)
                })
                .collect();
            let unseen: f64 = report.unseen.iter().map(|sector| sector.width_rad).sum();
            println!(
                "  {:10} truth {:?} -> {} | unseen {:.0}°",
                room.name,
                room.opening,
                exits.join(", "),
                unseen.to_degrees()
            );
        }
    }
    Ok(())
}
