//! Reads a map of any format, says what is in it.
//!
//! `cargo run -p slam-bridge --example 01_read_map -- MAP` with a file (.ply, .pcd, .csv, .xyz, .txt)
//! or a map folder. Prints for example:
//!
//! ```text
//! 4460 points, 67 keyframes, 34605 observations, unit unknown
//! ```
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use std::error::Error;

use slam_bridge::{Scale, read_map};

fn main() -> Result<(), Box<dyn Error>> {
    let Some(path) = std::env::args_os().nth(1) else {
        println!("usage: 01_read_map MAP");
        return Ok(());
    };
    let map = read_map(path)?;
    let observations: usize = map.points.iter().map(|point| point.observers.len()).sum();
    let unit = match map.scale {
        Scale::Unknown => "unknown".to_owned(),
        Scale::MetersPerUnit(meters) => format!("{meters} m"),
    };
    let (points, keyframes) = (map.points.len(), map.keyframes.len());
    println!("{points} points, {keyframes} keyframes, {observations} observations, unit {unit}");
    Ok(())
}
