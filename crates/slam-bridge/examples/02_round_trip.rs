//! Builds a map of two points and one keyframe, writes its three tables, reads them back.
//!
//! `cargo run -p slam-bridge --example 02_round_trip` prints the three tables and `the same map`.
#![expect(clippy::print_stdout, reason = "an example talks to the terminal")]

use std::error::Error;

use slam_bridge::nalgebra::Isometry3;
use slam_bridge::{
    KeyFrame, KeyFrameId, Map, Scale, read_keyframes, read_observations, read_ply, write_keyframes,
    write_observations, write_ply,
};

fn main() -> Result<(), Box<dyn Error>> {
    let mut map = Map::from_positions([[0.0, 0.0, 2.0], [0.5, 0.0, 3.0]]);
    map.scale = Scale::MetersPerUnit(1.25);
    map.keyframes = vec![KeyFrame {
        id: KeyFrameId(0),
        time: Some(0.0),
        world_from_camera: Isometry3::translation(0.0, 0.0, -1.0),
    }];
    map.points[0].observers = vec![KeyFrameId(0)];

    let (mut points, mut keyframes, mut observations) = (Vec::new(), Vec::new(), Vec::new());
    write_ply(&map, &mut points)?;
    write_keyframes(&map.keyframes, &mut keyframes)?;
    write_observations(&map, &mut observations)?;
    for table in [&points, &keyframes, &observations] {
        println!("{}", String::from_utf8_lossy(table));
    }

    let mut again = read_ply(points.as_slice())?;
    again.keyframes = read_keyframes(keyframes.as_slice())?;
    read_observations(observations.as_slice(), &mut again)?;
    println!(
        "{}",
        if again == map {
            "the same map"
        } else {
            "another map"
        }
    );
    Ok(())
}
