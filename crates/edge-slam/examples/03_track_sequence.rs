//! Problem: where was the camera in each frame of a recorded sequence?
//! Input:   a folder (TUM layout, or color/ and depth/), "depth" or "mono", optionally nine camera numbers.
//! Output:  the trajectory on standard output in TUM format; a summary with times on standard error.
//!
//! cargo run --release -p edge-slam --example 03_track_sequence -- FOLDER depth > trajectory.txt
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::disallowed_methods,
    reason = "a program"
)]

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use edge_slam::camera::{Camera, PinholeCamera, RadialTangential};
use edge_slam::evaluation::TimedPose;
use edge_slam::odometry::{Odometry, OdometryConfig};
use edge_slam::sequence::ImageSequence;
use rand::SeedableRng;
use slam_bridge::write_tum;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, mode, numbers @ ..] = &arguments[..] else {
        println!("usage: 03_track_sequence FOLDER depth|mono [fx fy cx cy k1 k2 p1 p2 k3]");
        return Ok(());
    };
    let sequence = ImageSequence::open(Path::new(folder))?;
    let numbers: Vec<f64> = numbers
        .iter()
        .map(|n| n.parse())
        .collect::<Result<_, _>>()?;
    let camera = match numbers[..] {
        [fx, fy, cx, cy, k1, k2, p1, p2, k3] => {
            let distortion = RadialTangential { k1, k2, p1, p2, k3 };
            Camera {
                pinhole: PinholeCamera::new(fx, fy, cx, cy)?,
                distortion,
            }
        }
        _ => sequence
            .camera
            .ok_or("the folder names no camera: give nine numbers")?,
    };
    let mut odometry = Odometry::new(camera, OdometryConfig::default())?;
    let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
    let (mut trajectory, mut millis, mut keyframes) = (Vec::new(), Vec::new(), 0);
    for index in 0..sequence.len() {
        let Some(loaded) = sequence.load(index)? else {
            break;
        };
        let depth = loaded.depth.as_ref().filter(|_| mode == "depth");
        let start = Instant::now();
        let tracked = odometry.track(&loaded.frame(), depth, rng);
        millis.push(start.elapsed().as_secs_f64() * 1e3);
        keyframes += usize::from(tracked.is_keyframe);
        if let Some(pose) = tracked.world_from_camera {
            trajectory.push(TimedPose {
                time: loaded.time,
                pose,
            });
        }
    }
    write_tum(&trajectory, std::io::stdout().lock())?;
    millis.sort_by(f64::total_cmp);
    let at = |share: usize| {
        millis
            .get(millis.len() * share / 100)
            .copied()
            .unwrap_or(0.0)
    };
    eprintln!(
        "{} of {} frames tracked, {keyframes} keyframes, {} map points, epoch {}, {:.1} ms median, {:.1} ms 95 %",
        trajectory.len(),
        sequence.len(),
        odometry.current_map().points.len(),
        odometry.current_map().epoch,
        at(50),
        at(95)
    );
    Ok(())
}
