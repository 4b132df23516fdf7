//! Writes the Canny edges of images as PGM files, for the comparison in `peers.py`.
//!
//! Usage: canny l1|l2 LOW HIGH OUT_FOLDER IMAGE... ; no smoothing. Prints microseconds of processor time per image, the mean of several.
#![allow(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measuring program"
)]

mod cpu_time;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use cpu_time::mean_cpu_seconds;
use edge_slam::edge::{CannyConfig, Norm, Thresholds, canny};
use edge_slam::sequence::decode_gray;

fn main() -> Result<(), Box<dyn Error>> {
    let origin = Instant::now();
    let mut arguments = std::env::args().skip(1);
    let mut next = || {
        arguments
            .next()
            .ok_or("usage: canny l1|l2 LOW HIGH OUT_FOLDER IMAGE...")
    };
    let norm = if next()? == "l1" { Norm::L1 } else { Norm::L2 };
    let thresholds = Thresholds::Fixed {
        low: next()?.parse()?,
        high: next()?.parse()?,
    };
    let folder = next()?;
    let config = CannyConfig {
        sigma: 0.0,
        thresholds,
        norm,
    };
    for (index, path) in arguments.enumerate() {
        let image = decode_gray(&std::fs::read(path)?)?;
        let (edges, mean) = mean_cpu_seconds(origin, 50, || canny(&image.view(), &config));
        let edges = edges?;
        println!("{:.0}", mean * 1e6);
        let (width, height) = (edges.width(), edges.height());
        let mut bytes = format!("P5\n{width} {height}\n255\n").into_bytes();
        let pixel = |i: usize| {
            if edges.is_edge(i % width, i / width) {
                255
            } else {
                0
            }
        };
        bytes.extend((0..width * height).map(pixel));
        std::fs::write(Path::new(&folder).join(format!("{index:04}.pgm")), bytes)?;
    }
    Ok(())
}
