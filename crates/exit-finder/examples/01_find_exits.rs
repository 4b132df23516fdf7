//! Finds the door of a small analytic room: 4 m × 4 m, a door of 0.9 m towards +x, a hall behind it.
//!
//! Expected output: one exit towards +x, about 0.9 wide.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use exit_finder::{AffinePlane, ExitConfig, ExitView, find_exits};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let agent = [0.0, 0.0, 1.0];
    let plane = AffinePlane::from_up([0.0, 0.0, 1.0], agent)?;
    // What a turning camera maps: the nearest wall in each of 1080 directions.
    let points: Vec<[f64; 3]> = (0..1080)
        .map(|i| (f64::from(i) + 0.5).to_radians() / 3.0)
        .map(|bearing| {
            let (sin, cos) = bearing.sin_cos();
            let through_the_door = cos > 0.0 && (2.0 * sin / cos).abs() < 0.45;
            let half = if through_the_door { 6.0 } else { 2.0 };
            let range = half / sin.abs().max(cos.abs());
            [range * cos, range * sin, 1.0 + 0.1 * (7.0 * bearing).sin()]
        })
        .collect();

    let report = find_exits(
        &points,
        agent,
        &plane,
        &ExitView::default(),
        &ExitConfig::default(),
    )?;
    for exit in &report.exits {
        println!(
            "exit towards {:+.2?}, {:.2} wide, fly to {:.2?} ({:?}, score {:.2})",
            exit.direction, exit.width, exit.position, exit.kind, exit.score
        );
    }
    let best = report.best().ok_or("the room is enclosed")?;
    assert!(report.exits.len() == 1 && best.direction[0] > 0.999 && (best.width - 0.9).abs() < 0.2);
    Ok(())
}
