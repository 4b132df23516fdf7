//! Odometry fused with telemetry that is SIMULATED: made from a true path with noise.
#![allow(clippy::unwrap_used, reason = "a test file")]

use edge_slam::fusion::{AttitudeSample, EkfConfig, FlightSample, FusionError};
use edge_slam::nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use edge_slam::odometry::{TelemetryFusion, Tracked};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use slam_bridge::TrackingState;

fn noise(rng: &mut Pcg64, sigma: f64) -> Vector3<f64> {
    let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
    Vector3::new(normal(), normal(), normal()) * sigma
}

/// A flight in a circle of 1 m with changing height: position and attitude (roll, pitch, yaw) at a time.
fn truth(t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let turn = 0.4 * t;
    let position = Vector3::new(turn.sin(), 1.0 - turn.cos(), 0.2 * (0.5 * t).sin());
    (position, Vector3::new(0.03 * t.sin(), 0.02, turn))
}

fn tracked(pose: Option<Isometry3<f64>>) -> Tracked {
    Tracked {
        state: if pose.is_some() {
            TrackingState::Tracking
        } else {
            TrackingState::Lost
        },
        world_from_camera: pose,
        inliers: 200,
        is_keyframe: false,
    }
}

/// Flies 20 s at 30 frames and 10 samples a second; the odometry's unit is `unit` metres, and where `gap` says
/// so it is lost and then begins a new epoch. Gives the rmse of fused and of dead-reckoned position.
fn fly(unit: f64, is_metric: bool, gap: bool) -> (f64, f64, f64) {
    let rng = &mut Pcg64::seed_from_u64(3);
    let config = TelemetryFusion::turning();
    let camera = TelemetryFusion::looking_ahead();
    let mut fusion = TelemetryFusion::new(config, camera, 0.0, truth(0.0).1).unwrap();
    let (mut square, mut reckoned_square, mut reckoned) = (0.0, 0.0, Vector3::zeros());
    let bias = Vector3::new(0.01, -0.03, 0.02);
    for step in 1..=600_u32 {
        let t = f64::from(step) / 30.0;
        let (position, attitude) = truth(t);
        if step % 3 == 0 {
            let velocity = (truth(t).0 - truth(t - 0.1).0) / 0.1;
            let level = Rotation3::from_axis_angle(&Vector3::z_axis(), -attitude.z);
            let velocity = level * velocity + bias + noise(rng, 0.05);
            let angles = attitude + noise(rng, 1_f64.to_radians());
            let battery = 0.9 - t / 100.0;
            let sample = FlightSample {
                time: t,
                velocity,
                battery,
            };
            fusion
                .telemetry(&sample, Some(&AttitudeSample { angles }))
                .unwrap();
            reckoned += level.inverse() * velocity * 0.1;
        }
        // The odometry's world is its first camera.
        let pose = |(p, a): (Vector3<f64>, Vector3<f64>)| {
            let rotation = Rotation3::from_euler_angles(a.x, a.y, a.z) * camera;
            Isometry3::from_parts(
                Translation3::from(p),
                UnitQuaternion::from_rotation_matrix(&rotation),
            )
        };
        let second = gap && t > 10.0;
        let begin = if second { 12.0 } else { 0.0 };
        let mut seen = pose(truth(begin)).inv_mul(&pose((position, attitude)));
        // Another epoch has another unit.
        let unit = if second { 2.0 * unit } else { unit };
        seen.translation.vector /= unit;
        seen.translation.vector += noise(rng, 0.003);
        let lost = gap && (10.0..12.0).contains(&t);
        let found = tracked((!lost).then_some(seen));
        let fused = fusion
            .observe(t, &found, u64::from(second), is_metric)
            .unwrap();
        square += (fused.state.position - position).norm_squared() / 600.0;
        reckoned_square += (reckoned - position).norm_squared() / 600.0;
    }
    let scale = fusion.ekf().state().scale();
    (square.sqrt(), reckoned_square.sqrt(), scale)
}

#[test]
fn metric_odometry_beats_dead_reckoning() {
    let (fused, reckoned, scale) = fly(1.0, true, false);
    assert!(fused < 0.06 && fused < 0.5 * reckoned, "{fused} {reckoned}");
    assert!((scale - 1.0).abs() < 0.05, "{scale}");
}

#[test]
fn an_unknown_unit_is_learnt() {
    let (fused, reckoned, scale) = fly(1.7, false, false);
    assert!(
        fused < 0.15 && fused < reckoned,
        "{fused} {reckoned} {scale}"
    );
    assert!((scale / 1.7 - 1.0).abs() < 0.1, "{scale}");
}

#[test]
fn a_gap_and_a_new_unit_are_bridged() {
    let (fused, reckoned, scale) = fly(1.7, false, true);
    assert!(fused < 0.15 && fused < reckoned, "{fused} {reckoned}");
    assert!((scale / 3.4 - 1.0).abs() < 0.15, "{scale}");
}

#[test]
fn samples_out_of_order_and_numbers_that_are_none_are_errors() {
    let camera = TelemetryFusion::looking_ahead();
    let config = EkfConfig::default();
    let mut fusion = TelemetryFusion::new(config, camera, 5.0, Vector3::zeros()).unwrap();
    let sample = |time, x| FlightSample {
        time,
        velocity: Vector3::new(x, 0.0, 0.0),
        battery: 1.0,
    };
    assert!(matches!(
        fusion.telemetry(&sample(4.0, 0.0), None),
        Err(FusionError::TimeBackwards { .. })
    ));
    assert!(fusion.telemetry(&sample(6.0, f64::NAN), None).is_err());
    fusion.telemetry(&sample(6.0, 1.0), None).unwrap();
    let late = fusion.observe(5.5, &tracked(Some(Isometry3::identity())), 0, true);
    assert!(late.is_err());
    let fused = fusion.observe(7.0, &tracked(None), 0, true).unwrap();
    assert!((fused.state.position.x - 2.0).abs() < 1e-9 && fused.outcome.is_none());
}
