//! Problem: a sparse map of a room, as monocular SLAM leaves it, with the truth about every point.
//!
//! Run: `cargo run --release -p indoor-sim --example 01_room_cloud [WORLD] [SEED] [OUT.ply]`
//! Flies a scan (up and down while turning), prints statistics of the map, and writes the points in world metres.

#![allow(clippy::print_stdout, reason = "an example speaks to the terminal")]

use core::time::Duration;
use std::error::Error;
use std::fmt::Write as _;

use indoor_sim::slam_bridge::{SlamSource, TrackingState};
use indoor_sim::{SimConfig, Simulator, World};
use tello_sdk::{Command, Distance, Turn};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_else(|| "one-door-room".to_owned());
    let seed: u64 = args.next().map_or(Ok(1), |text| text.parse())?;
    let mut sim = Simulator::new(World::named(&name, seed)?, SimConfig::default(), seed)?;
    println!("{} landmarks", sim.world().landmarks().len());
    let (up, down) = (
        Command::Up(Distance::from_cm(40)?),
        Command::Down(Distance::from_cm(40)?),
    );
    let turn = Command::Clockwise(Turn::from_degrees(20)?);
    let (mut frames, mut good, mut tracked) = (0, 0, Vec::new());
    let scan = (0..18).flat_map(|step| [if step % 2 == 0 { &up } else { &down }, &turn]);
    for command in core::iter::once(&Command::TakeOff).chain(scan) {
        sim.send(command)?;
        while sim.poll_reply().is_none() {
            sim.advance(Duration::from_millis(100));
        }
        while let Some(update) = sim.slam().poll() {
            frames += 1;
            good += usize::from(update.state == TrackingState::Tracking);
            tracked.push(update.tracked_points);
        }
    }
    let map = sim.slam_ref().map();
    let Some(world_from_map) = sim.world_from_map() else {
        return Err("no map".into());
    };
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\n",
        map.points.len()
    );
    ply.push_str("property float x\nproperty float y\nproperty float z\nend_header\n");
    let mut errors = Vec::new();
    for point in &map.points {
        let place = world_from_map * point.position;
        writeln!(ply, "{:.4} {:.4} {:.4}", place.x, place.y, place.z)?;
        let truth = sim
            .slam_ref()
            .point_truth(point.id)
            .ok_or("every point has a truth")?;
        errors.push((place.coords - nalgebra::Vector3::from(truth.position)).norm());
    }
    errors.sort_by(f64::total_cmp);
    tracked.sort_unstable();
    println!(
        "{good} of {frames} frames tracked, {} points at the median",
        tracked[frames / 2]
    );
    println!(
        "{} points, {} keyframes",
        map.points.len(),
        map.keyframes.len()
    );
    let quantile = |share: f64| errors[((errors.len() - 1) as f64 * share) as usize];
    println!(
        "error: median {:.3} m, 90 % {:.3} m",
        quantile(0.5),
        quantile(0.9)
    );
    if let Some(path) = args.next() {
        std::fs::write(path, ply)?;
    }
    Ok(())
}
