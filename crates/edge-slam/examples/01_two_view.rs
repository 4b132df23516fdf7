//! Problem: how did a camera move between two views, and can the answer be trusted?
//! Input:   200 matched pixels of a made-up room, a quarter of them wrong.
//! Output:  rotation, direction of travel and the kind of geometry; then the same for a camera that only turned.
//!
//! cargo run -p edge-slam --example 01_two_view
#![allow(clippy::print_stdout, reason = "an example")]

use std::error::Error;

use edge_slam::camera::PinholeCamera;
use edge_slam::nalgebra::{Isometry3, Point2, Point3, Vector3};
use edge_slam::two_view::{TwoViewConfig, estimate_two_view};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn main() -> Result<(), Box<dyn Error>> {
    let camera = PinholeCamera::new(500.0, 500.0, 320.0, 240.0)?;
    let turn = Vector3::new(0.02, -0.1, 0.01);
    for (name, travel) in [
        ("moved", Vector3::new(0.4, 0.0, 0.1)),
        ("turned", Vector3::zeros()),
    ] {
        let motion = Isometry3::new(travel, turn);
        let (first, second) = matches(&camera, &motion);
        let rng = &mut Pcg64::seed_from_u64(1);
        let found = estimate_two_view(&first, &second, &camera, &TwoViewConfig::default(), rng)?;
        let pose = found.second_from_first;
        println!(
            "{name}: {:?}, {} of {} matches, rotation off by {:.3} degrees, direction {:.2?}",
            found.geometry,
            found.inliers.len(),
            first.len(),
            pose.rotation.angle_to(&motion.rotation).to_degrees(),
            pose.translation.vector.as_slice(),
        );
    }
    Ok(())
}

fn matches(
    camera: &PinholeCamera,
    motion: &Isometry3<f64>,
) -> (Vec<Point2<f64>>, Vec<Point2<f64>>) {
    let rng = &mut Pcg64::seed_from_u64(2);
    let mut pairs = (Vec::new(), Vec::new());
    while pairs.0.len() < 200 {
        let mut unit = || rng.random::<f64>() - 0.5;
        let point = Point3::new(4.0 * unit(), 3.0 * unit(), 4.0 + 3.0 * unit());
        let (a, b) = (camera.project(&point), camera.project(&(motion * point)));
        if let (Some(a), Some(b)) = (a, b) {
            let wrong = pairs.0.len() % 4 == 0;
            let b = if wrong {
                Point2::new(640.0 * unit(), 480.0 * unit())
            } else {
                b
            };
            pairs.0.push(a);
            pairs.1.push(b);
        }
    }
    pairs
}
