//! Decodes the video and writes five pictures, one a second, as PNG files (needs the feature `video`).
//!
//! Input: `--drone ADDRESS:PORT` for a real drone; without it an emulated one in this process. Output: the files'
//! names in the folder for temporary files, and what the stream lost.

#![allow(clippy::print_stdout)]

mod emulated;

use emulated::{Flown, with_drone};
use std::fs::File;
use std::io::BufWriter;
use std::time::Duration;
use tello_sdk::video::{Decoder, Picture};
use tello_sdk::{Command, Drone, DroneConfig, VideoConfig, VideoStream};

fn main() -> Flown {
    with_drone(film)
}

fn film(config: DroneConfig) -> Flown {
    let stream = VideoStream::open(VideoConfig {
        drone: Some(config.drone.ip()),
        ..VideoConfig::default()
    })?;
    let drone = Drone::connect(config)?;
    drone.execute(Command::StreamOn)?;
    let mut decoder = Decoder::new()?;
    let (mut decoded, mut written) = (0_u32, 0);
    while written < 5 {
        let unit = stream
            .next(Duration::from_secs(5))
            .ok_or("no video for five seconds")?;
        let Some(picture) = decoder.decode(&unit) else {
            continue;
        };
        if decoded.is_multiple_of(30) {
            write(&picture, written)?;
            written += 1;
        }
        decoded += 1;
    }
    drone.execute(Command::StreamOff)?;
    println!("{:?}", stream.counters().0);
    Ok(())
}

fn write(picture: &Picture, number: u32) -> Flown {
    let path = std::env::temp_dir().join(format!("tello-{number}.png"));
    let file = BufWriter::new(File::create(&path)?);
    let mut encoder = png::Encoder::new(file, picture.width as u32, picture.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&picture.rgb)?;
    println!("{}", path.display());
    Ok(())
}
