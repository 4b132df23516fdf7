//! Writes the ORB features of images as text, for the comparison in `peers.py`.
//!
//! Usage: orb balanced|spread|strongest COUNT IMAGE... ; prints per image a line "features N microseconds T" and N lines
//! "x y octave w0 w1 w2 w3". The time is that on the processor, the mean of several.
#![allow(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measuring program"
)]

mod cpu_time;

use std::error::Error;
use std::time::Instant;

use cpu_time::mean_cpu_seconds;
use edge_slam::feature::{OrbConfig, OrbExtractor, Selection};
use edge_slam::sequence::decode_gray;

fn main() -> Result<(), Box<dyn Error>> {
    let origin = Instant::now();
    let mut arguments = std::env::args().skip(1);
    let selection = match arguments.next().as_deref() {
        Some("spread") => Selection::Spread,
        Some("balanced") => Selection::Balanced,
        Some("strongest") => Selection::Strongest,
        _ => return Err("balanced, spread or strongest?".into()),
    };
    let features = arguments.next().ok_or("COUNT is missing")?.parse()?;
    let extractor = OrbExtractor::new(OrbConfig {
        features,
        selection,
        ..Default::default()
    })?;
    for path in arguments {
        let image = decode_gray(&std::fs::read(path)?)?;
        let (found, mean) = mean_cpu_seconds(origin, 10, || extractor.extract(&image.view()));
        println!(
            "features {} microseconds {:.0}",
            found.keypoints.len(),
            mean * 1e6
        );
        for (k, d) in found.keypoints.iter().zip(&found.descriptors) {
            println!(
                "{} {} {} {} {} {} {}",
                k.x, k.y, k.octave, d.0[0], d.0[1], d.0[2], d.0[3]
            );
        }
    }
    Ok(())
}
