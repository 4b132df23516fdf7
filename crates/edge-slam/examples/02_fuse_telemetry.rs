//! Problem: where is a drone that reports its velocity, with a camera that measures its place once a second?
//! Input:   a made-up flight of 20 s whose velocity is 10 % too great, as the battery drains.
//! Output:  error with and without the camera's fixes, and the standard deviation that the filter claims.
//!
//! cargo run -p edge-slam --example 02_fuse_telemetry
#![allow(clippy::print_stdout, reason = "an example")]

use edge_slam::fusion::{Ekf, EkfConfig, FlightSample, FusionError, VisualPose};
use edge_slam::nalgebra::Vector3;

fn main() -> Result<(), FusionError> {
    for with_camera in [false, true] {
        let start = Vector3::zeros();
        let mut ekf = Ekf::new(EkfConfig::default(), 0.0, start, start)?;
        let mut truth = start;
        for step in 1..=200 {
            let time = f64::from(step) * 0.1;
            let velocity = Vector3::new(0.5, 0.2 * (0.5 * time).sin(), 0.0);
            truth += velocity * 0.1;
            let battery = 0.9 - time / 100.0;
            ekf.predict(&FlightSample {
                time,
                velocity: velocity * 1.1,
                battery,
            })?;
            if with_camera && step % 10 == 0 {
                let attitude = Vector3::zeros();
                let pose = VisualPose {
                    position: truth,
                    attitude,
                    distance: 0.5,
                    inliers: 120,
                };
                ekf.update_visual(&pose)?;
            }
        }
        println!(
            "camera {with_camera}: off by {:.3} m, claimed deviation {:.3} m",
            (ekf.state().position - truth).norm(),
            ekf.covariance()[(0, 0)].sqrt()
        );
    }
    Ok(())
}
