//! kornia's ORB and Canny for the comparison in `peers.py`, printed as `oracle/orb.rs` and `oracle/canny.rs` print ours.
//!
//! Usage: kornia-peer orb kornia COUNT IMAGE... | kornia-peer canny l1|l2 LOW HIGH OUT_FOLDER IMAGE...
//! One thread: everything runs on the only one of a rayon pool, so that its processor time is all there is.

#[path = "../../cpu_time.rs"]
mod cpu_time;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use cpu_time::mean_cpu_seconds;
use edge_slam::sequence::decode_gray;
use kornia_image::{Image, ImageSize};
use kornia_imgproc::canny::canny;
use kornia_imgproc::features::OrbDetector;

type Failure = Box<dyn Error + Send + Sync>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    pool.install(|| match arguments.first().map(String::as_str) {
        Some("orb") => orb(&arguments[2..]),
        Some("canny") => edges(&arguments[1..]),
        _ => Err("orb or canny?".into()),
    })
}

fn read(path: &str) -> Result<Image<u8, 1>, Failure> {
    let image = decode_gray(&std::fs::read(path)?).map_err(|error| error.to_string())?;
    let size = ImageSize {
        width: image.width(),
        height: image.height(),
    };
    Ok(Image::new(size, image.pixels().to_vec())?)
}

fn orb(arguments: &[String]) -> Result<(), Failure> {
    let [count, paths @ ..] = arguments else {
        return Err("COUNT is missing".into());
    };
    let origin = Instant::now();
    let detector = OrbDetector {
        n_keypoints: count.parse()?,
        ..OrbDetector::default()
    };
    for path in paths {
        let image = read(path)?;
        let (found, mean) = mean_cpu_seconds(origin, 10, || detector.detect_and_extract_u8(&image));
        let found = found?;
        println!("features {} microseconds {:.0}", found.len(), mean * 1e6);
        let places = found.keypoints_xy.iter().zip(&found.octaves);
        for ((place, octave), bytes) in places.zip(&found.descriptors) {
            let word = |k: usize| u64::from_le_bytes(std::array::from_fn(|b| bytes[8 * k + b]));
            let [x, y] = place;
            println!("{x} {y} {octave} {} {} {} {}", word(0), word(1), word(2), word(3));
        }
    }
    Ok(())
}

fn edges(arguments: &[String]) -> Result<(), Failure> {
    let [norm, low, high, folder, paths @ ..] = arguments else {
        return Err("canny l1|l2 LOW HIGH OUT_FOLDER IMAGE...".into());
    };
    let origin = Instant::now();
    let (low, high) = (low.parse()?, high.parse()?);
    for (index, path) in paths.iter().enumerate() {
        let image = read(path)?;
        let mut edges = Image::from_size_val(image.size(), 0)?;
        let (result, mean) = mean_cpu_seconds(origin, 50, || {
            canny(&image, &mut edges, low, high, norm == "l2")
        });
        result?;
        println!("{:.0}", mean * 1e6);
        let mut bytes = format!("P5\n{} {}\n255\n", image.width(), image.height()).into_bytes();
        bytes.extend_from_slice(edges.as_slice());
        std::fs::write(Path::new(folder).join(format!("{index:04}.pgm")), bytes)?;
    }
    Ok(())
}
