//! Problem: an arm of four joints in a plane, past a post: four dimensions, and no geometry library.
//!
//! Run: `cargo run --release -p rrt-refine --example 05_four_joints`
//! Prints the angles of the path's vertices in degrees, and what they cost.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

use std::error::Error;

use rand_pcg::Pcg64;
use rrt_refine::{Bounds, FindPathConfig, Query, RrtConfig, find_path};

/// Length of each link, metres.
const LINK: f64 = 0.5;
const POST: [f64; 2] = [1.2, 0.0];
const POST_RADIUS: f64 = 0.2;
/// No place of the arm moves farther than this between two places that are looked at, so the post is made so much larger.
const STEP: f64 = 0.01;

fn main() -> Result<(), Box<dyn Error>> {
    let limit = std::f64::consts::PI;
    // Angles of each link against the one before: from stretched out above the post to stretched out below it.
    let (above, below) = ([0.6, 0.0, 0.0, 0.0], [-0.6, 0.0, 0.0, 0.0]);
    let query = Query::new(above, below, Bounds::new([-limit; 4], [limit; 4])?);
    let config = FindPathConfig {
        rrt: RrtConfig {
            // In the unit of the space, here radians.
            step_length: 0.5,
            ..RrtConfig::default()
        },
        ..FindPathConfig::default()
    };
    let found = find_path(&query, &is_free, &config, &mut Pcg64::new(1, 1))?;
    let path = found.path.ok_or("no way past the post")?;
    for angles in path.points() {
        println!("{:6.1?}", angles.map(f64::to_degrees));
    }
    println!(
        "{:.2} rad, {} motions checked, {} searches",
        path.length(),
        found.checks,
        found.attempts
    );
    Ok(())
}

/// Whether the arm keeps off the post all along a motion.
fn is_free(from: &[f64; 4], to: &[f64; 4]) -> bool {
    // A joint moves what hangs on it by its turn times the length of that.
    let reach = [4.0, 3.0, 2.0, 1.0];
    let travel: f64 = (0..4)
        .map(|joint| LINK * reach[joint] * (to[joint] - from[joint]).abs())
        .sum();
    let steps = (travel / STEP).ceil().max(1.0);
    (0..=steps as usize).all(|step| {
        let share = step as f64 / steps;
        let angles = std::array::from_fn(|joint| from[joint] + share * (to[joint] - from[joint]));
        distance_to_post(angles) > POST_RADIUS + STEP
    })
}

fn distance_to_post(angles: [f64; 4]) -> f64 {
    let (mut base, mut heading, mut nearest) = ([0.0, 0.0], 0.0, f64::INFINITY);
    for angle in angles {
        heading += angle;
        let (sin, cos): (f64, f64) = f64::sin_cos(heading);
        let offset = [POST[0] - base[0], POST[1] - base[1]];
        let along = (offset[0] * cos + offset[1] * sin).clamp(0.0, LINK);
        nearest = nearest.min((offset[0] - along * cos).hypot(offset[1] - along * sin));
        base = [base[0] + LINK * cos, base[1] + LINK * sin];
    }
    nearest
}
