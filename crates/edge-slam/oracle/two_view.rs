//! Matches pairs of images and estimates their relative pose, for the comparison in `two_view.py`.
//!
//! Usage: two_view FX FY CX CY FIRST SECOND [FIRST SECOND...]; prints per pair "pair N microseconds T geometry G
//! parallax P homography H rotation R", the 12 numbers of the motion (row by row, zeros when refused), and N lines
//! "x1 y1 x2 y2".
#![allow(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measuring program"
)]

mod cpu_time;

use std::error::Error;
use std::time::Instant;

use cpu_time::cpu_seconds;
use edge_slam::camera::{Camera, PinholeCamera, RadialTangential};
use edge_slam::feature::{Features, MatchConfig, OrbExtractor, match_descriptors};
use edge_slam::nalgebra::{Matrix4, Point2};
use edge_slam::odometry::OdometryConfig;
use edge_slam::sequence::decode_gray;
use edge_slam::two_view::{TwoView, TwoViewConfig, estimate_two_view};
use rand::SeedableRng;

fn main() -> Result<(), Box<dyn Error>> {
    let origin = Instant::now();
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (numbers, paths) = arguments.split_at(9.min(arguments.len()));
    let n: Vec<f64> = numbers
        .iter()
        .map(|text| text.parse())
        .collect::<Result<_, _>>()?;
    let [fx, fy, cx, cy, k1, k2, p1, p2, k3] = n[..] else {
        return Err("usage".into());
    };
    let distortion = RadialTangential { k1, k2, p1, p2, k3 };
    let camera = Camera {
        pinhole: PinholeCamera::new(fx, fy, cx, cy)?,
        distortion,
    };
    let extractor = OrbExtractor::new(OdometryConfig::default().orb)?;
    let features = |path: &String| -> Result<Features, Box<dyn Error>> {
        Ok(extractor.extract(&decode_gray(&std::fs::read(path)?)?.view()))
    };
    for pair in paths.chunks_exact(2) {
        let (a, b) = (features(&pair[0])?, features(&pair[1])?);
        let matches = match_descriptors(&a.descriptors, &b.descriptors, &MatchConfig::default());
        let pixel = |f: &Features, i: usize| {
            let k = &f.keypoints[i];
            camera
                .undistort(&Point2::new(f64::from(k.x), f64::from(k.y)))
                .unwrap_or_default()
        };
        let first: Vec<_> = matches.iter().map(|m| pixel(&a, m.first)).collect();
        let second: Vec<_> = matches.iter().map(|m| pixel(&b, m.second)).collect();
        let estimate = || {
            let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
            estimate_two_view(
                &first,
                &second,
                &camera.pinhole,
                &TwoViewConfig::default(),
                rng,
            )
        };
        let start = cpu_seconds(origin);
        let mut found = estimate();
        for _ in 1..8 {
            found = estimate();
        }
        let micros = (cpu_seconds(origin) - start) / 8.0 * 1e6;
        print!("pair {} microseconds {micros:.0} ", matches.len());
        print_motion(found.ok().as_ref());
        for (p, q) in first.iter().zip(&second) {
            println!("{:.4} {:.4} {:.4} {:.4}", p.x, p.y, q.x, q.y);
        }
    }
    Ok(())
}

/// The rest of the pair's line, and the line of the motion.
fn print_motion(found: Option<&TwoView>) {
    let motion = match found {
        Some(f) => {
            let parallax = f.parallax.to_degrees();
            println!(
                "geometry {:?} parallax {parallax:.3} homography {:.3} rotation {:.3}",
                f.geometry, f.homography_share, f.rotation_share
            );
            f.second_from_first.to_homogeneous()
        }
        None => {
            println!("geometry None parallax 0 homography 0 rotation 0");
            Matrix4::zeros()
        }
    };
    let numbers: Vec<String> = (0..12)
        .map(|k| format!("{:.9}", motion[(k / 4, k % 4)]))
        .collect();
    println!("{}", numbers.join(" "));
}
