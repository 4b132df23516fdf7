//! Matches pairs of images and estimates their relative pose, for the comparison in `two_view.py`.
//!
//! Usage: two_view raw|aligned FX FY CX CY K1 K2 P1 P2 K3 FIRST SECOND [FIRST SECOND...]; prints per pair "pair N
//! microseconds T alignment A geometry G parallax P residual Q sigma S margin M homography H rotation R", the 12 numbers of the
//! motion (row by row, zeros when refused), and N lines "x1 y1 x2 y2" (undistorted pixels).
#![allow(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a measuring program"
)]

mod cpu_time;

use std::error::Error;
use std::time::Instant;

use cpu_time::mean_cpu_seconds;
use edge_slam::camera::{Camera, PinholeCamera, RadialTangential};
use edge_slam::feature::{
    AlignConfig, Features, Keypoint, MatchConfig, OrbExtractor, align_matches, match_descriptors,
};
use edge_slam::image::GrayImage;
use edge_slam::nalgebra::{Matrix4, Point2};
use edge_slam::odometry::OdometryConfig;
use edge_slam::sequence::decode_gray;
use edge_slam::two_view::{TwoView, TwoViewConfig, estimate_two_view};
use rand::SeedableRng;

fn main() -> Result<(), Box<dyn Error>> {
    let origin = Instant::now();
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (mode, rest) = arguments.split_first().ok_or("usage")?;
    let (numbers, paths) = rest.split_at(9.min(rest.len()));
    let camera = camera(numbers)?;
    let extractor = OrbExtractor::new(OdometryConfig::default().orb)?;
    let view = |path: &String| -> Result<(GrayImage, Features), Box<dyn Error>> {
        let image = decode_gray(&std::fs::read(path)?)?;
        let features = extractor.extract(&image.view());
        Ok((image, features))
    };
    for pair in paths.chunks_exact(2) {
        let (a, b) = (view(&pair[0])?, view(&pair[1])?);
        let matches =
            match_descriptors(&a.1.descriptors, &b.1.descriptors, &MatchConfig::default());
        let keypoints: [&[Keypoint]; 2] = [&a.1.keypoints, &b.1.keypoints];
        let mut config = AlignConfig::default();
        if mode == "raw" {
            config.max_shift = -1.0;
        }
        let (places, alignment) = mean_cpu_seconds(origin, 8, || {
            align_matches([&a.0.view(), &b.0.view()], keypoints, &matches, &config)
        });
        let pixel = |p: [f64; 2]| camera.undistort(&Point2::from(p)).unwrap_or_default();
        let first: Vec<_> = places.iter().map(|p| pixel(p.first)).collect();
        let second: Vec<_> = places.iter().map(|p| pixel(p.second)).collect();
        let (found, seconds) = mean_cpu_seconds(origin, 8, || {
            let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
            let config = TwoViewConfig::default();
            estimate_two_view(&first, &second, &camera.pinhole, &config, rng)
        });
        print!(
            "pair {} microseconds {:.0} alignment {:.0} ",
            places.len(),
            seconds * 1e6,
            alignment * 1e6
        );
        print_motion(found.ok().as_ref());
        for (p, q) in first.iter().zip(&second) {
            println!("{:.4} {:.4} {:.4} {:.4}", p.x, p.y, q.x, q.y);
        }
    }
    Ok(())
}

fn camera(numbers: &[String]) -> Result<Camera, Box<dyn Error>> {
    let n: Vec<f64> = numbers
        .iter()
        .map(|text| text.parse())
        .collect::<Result<_, _>>()?;
    let [fx, fy, cx, cy, k1, k2, p1, p2, k3] = n[..] else {
        return Err("usage".into());
    };
    Ok(Camera {
        pinhole: PinholeCamera::new(fx, fy, cx, cy)?,
        distortion: RadialTangential { k1, k2, p1, p2, k3 },
    })
}

/// The rest of the pair's line, and the line of the motion.
fn print_motion(found: Option<&TwoView>) {
    let motion = match found {
        Some(f) => {
            let [parallax, residual, sigma] =
                [f.parallax, f.residual_parallax, f.direction_sigma].map(f64::to_degrees);
            println!(
                "geometry {:?} parallax {parallax:.3} residual {residual:.3} sigma {sigma:.2} margin {:.2} homography {:.3} rotation {:.3}",
                f.geometry, f.margin, f.homography_share, f.rotation_share
            );
            f.second_from_first.to_homogeneous()
        }
        None => {
            println!(
                "geometry None parallax 0 residual 0 sigma 0 margin 0 homography 0 rotation 0"
            );
            Matrix4::zeros()
        }
    };
    let numbers: Vec<String> = (0..12)
        .map(|k| format!("{:.9}", motion[(k / 4, k % 4)]))
        .collect();
    println!("{}", numbers.join(" "));
}
