//! The filter against a simulated flight: consistency, scale, wrapping, gates and bad input.
#![allow(clippy::unwrap_used, reason = "a test file")]

use edge_slam::fusion::{
    AnchoredOdometry, AttitudeSample, Ekf, EkfConfig, FlightSample, FusionError, ProcessNoise,
    VelocityFrame, VisualPose,
};
use edge_slam::nalgebra::{Rotation3, SVector, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn normal(rng: &mut Pcg64) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (core::f64::consts::TAU * v).cos()
}

fn noise(rng: &mut Pcg64, sigma: f64) -> Vector3<f64> {
    Vector3::new(normal(rng), normal(rng), normal(rng)) * sigma
}

fn rotation(a: &Vector3<f64>) -> Rotation3<f64> {
    Rotation3::from_euler_angles(a.x, a.y, a.z)
}

/// A flight in circles whose true motion has the noise that the filter assumes; returns the squared
/// Mahalanobis error of position and attitude at its end.
fn nees(seed: u64) -> f64 {
    let rng = &mut Pcg64::seed_from_u64(seed);
    let config = EkfConfig {
        initial_scale_sigma: 0.0,
        ..Default::default()
    };
    let process = ProcessNoise {
        log_scale: 0.0,
        ..config.process
    };
    let config = EkfConfig { process, ..config };
    let start = Vector3::new(0.0, 0.0, 3.0);
    let mut position = noise(rng, 0.01);
    let mut attitude = start + noise(rng, 1_f64.to_radians());
    let mut ekf = Ekf::new(config, 0.0, Vector3::zeros(), start).unwrap();
    let (dt, mut fixed_at) = (0.1, 0.0);
    for step in 1..=200 {
        let time = f64::from(step) * dt;
        let velocity = Vector3::new(0.5, 0.1 * time.sin(), 0.05);
        let battery = 1.0 - time / 60.0;
        let q = process.covariance(battery, time - fixed_at, dt);
        position += rotation(&attitude) * velocity * dt + noise(rng, q[(0, 0)].sqrt());
        attitude += noise(rng, q[(3, 3)].sqrt());
        ekf.predict(&FlightSample {
            time,
            velocity,
            battery,
        })
        .unwrap();
        let sigma = config.attitude_sigma;
        let error = Vector3::new(
            normal(rng) * sigma.x,
            normal(rng) * sigma.y,
            normal(rng) * sigma.z,
        );
        ekf.update_attitude(&AttitudeSample {
            angles: attitude + error,
        })
        .unwrap();
        if step % 5 == 0 {
            let pose = VisualPose {
                position: position + noise(rng, config.visual_sigma),
                attitude: attitude + noise(rng, config.visual_angle_sigma),
                distance: 0.0,
                inliers: 100,
            };
            if ekf.update_visual(&pose).unwrap().accepted {
                fixed_at = time;
            }
        }
    }
    let wrap = |a: f64| a.sin().atan2(a.cos());
    let p = ekf.state().position - position;
    let a = (ekf.state().attitude - attitude).map(wrap);
    let error = SVector::from([p.x, p.y, p.z, a.x, a.y, a.z]);
    let covariance = ekf.covariance().fixed_view::<6, 6>(0, 0).into_owned();
    error.dot(&(covariance.try_inverse().unwrap() * error))
}

/// With the default gates.
#[test]
fn the_error_is_as_great_as_the_covariance_says() {
    // χ² with 300 degrees of freedom, 95 % band, over 50 runs.
    let mean = (0..50).map(nees).sum::<f64>() / 50.0;
    assert!((253.9 / 50.0..349.9 / 50.0).contains(&mean), "{mean}");
}

/// The same with odometry of an unknown unit since the start: position, attitude and scale, after `steps` of 0.1 s.
fn nees_with_scale(seed: u64, steps: u32, scale_sigma: f64, gate: f64) -> f64 {
    let rng = &mut Pcg64::seed_from_u64(seed);
    let config = EkfConfig {
        initial_scale_sigma: scale_sigma,
        visual_gate: gate,
        velocity_frame: VelocityFrame::World,
        ..Default::default()
    };
    let mut position = noise(rng, 0.01);
    let mut attitude = noise(rng, 1_f64.to_radians());
    let mut log_scale = scale_sigma * normal(rng);
    let zero = Vector3::zeros();
    let mut ekf = Ekf::new(config, 0.0, zero, zero).unwrap();
    let (dt, mut fixed_at) = (0.1, 0.0);
    for step in 1..=steps {
        let time = f64::from(step) * dt;
        let velocity = Vector3::new(0.5 * (0.4 * time).cos(), 0.5 * (0.3 * time).sin(), 0.05);
        let q = config.process.covariance(0.9, time - fixed_at, dt);
        position += velocity * dt + noise(rng, q[(0, 0)].sqrt());
        attitude += noise(rng, q[(3, 3)].sqrt());
        log_scale += normal(rng) * q[(6, 6)].sqrt();
        let sample = FlightSample {
            time,
            velocity,
            battery: 0.9,
        };
        ekf.predict(&sample).unwrap();
        if step % 5 == 0 {
            let sigma = config
                .visual_sigma
                .hypot(config.visual_drift * position.norm());
            let odometry = AnchoredOdometry {
                anchor_position: zero,
                anchor_rotation: Rotation3::identity(),
                displacement: (position + noise(rng, sigma)) / log_scale.exp(),
                attitude: attitude + noise(rng, config.visual_angle_sigma),
                inliers: 100,
            };
            if ekf.update_odometry(&odometry).unwrap().accepted {
                fixed_at = time;
            }
        }
    }
    let state = ekf.state();
    let (p, a) = (state.position - position, state.attitude - attitude);
    let error = SVector::from([p.x, p.y, p.z, a.x, a.y, a.z, state.log_scale - log_scale]);
    error.dot(&(ekf.covariance().try_inverse().unwrap() * error))
}

/// Without the gate: with it the filter is a little too sure of itself, which is printed (and said in the README), not asserted.
#[test]
fn with_an_unknown_scale_the_error_is_as_great_as_well() {
    // χ² with 350 degrees of freedom, 95 % band, over 50 runs.
    let band = 300.1 / 50.0..403.7 / 50.0;
    let gate = EkfConfig::default().visual_gate;
    for (steps, sigma) in [20, 200]
        .into_iter()
        .flat_map(|steps| [0.05, 0.2, 0.5].map(|sigma| (steps, sigma)))
    {
        let mean = |runs: u32, gate| {
            let nees = |seed| nees_with_scale(u64::from(seed), steps, sigma, gate);
            (0..runs).map(nees).sum::<f64>() / f64::from(runs)
        };
        let all = mean(50, f64::INFINITY);
        let more = [f64::INFINITY, gate].map(|gate| mean(300, gate));
        println!(
            "{steps} steps, log scale known to {sigma}: {all:.2}, over 300 runs {more:.2?} without and with the gate"
        );
        assert!(band.contains(&all), "{steps} {sigma}: {all}");
    }
}

#[test]
fn an_unknown_scale_is_learnt_from_velocities() {
    let rng = &mut Pcg64::seed_from_u64(9);
    let config = EkfConfig {
        velocity_frame: VelocityFrame::World,
        ..Default::default()
    };
    let mut ekf = Ekf::new(config, 0.0, Vector3::zeros(), Vector3::zeros()).unwrap();
    let (dt, scale) = (0.1, 1.6_f64);
    let mut position = Vector3::zeros();
    let (mut anchor, mut anchor_truth) = (Vector3::zeros(), Vector3::zeros());
    for step in 1..=600 {
        let time = f64::from(step) * dt;
        let velocity = Vector3::new((0.3 * time).cos(), (0.3 * time).sin(), 0.0) * 0.5;
        position += velocity * dt;
        let measured = velocity + noise(rng, 0.05);
        ekf.predict(&FlightSample {
            time,
            velocity: measured,
            battery: 1.0,
        })
        .unwrap();
        if step % 10 == 0 {
            let odometry = AnchoredOdometry {
                anchor_position: anchor,
                anchor_rotation: Rotation3::identity(),
                displacement: (position - anchor_truth + noise(rng, 0.005)) / scale,
                attitude: Vector3::zeros(),
                inliers: 100,
            };
            ekf.update_odometry(&odometry).unwrap();
            if step % 50 == 0 {
                (anchor, anchor_truth) = (ekf.state().position, position);
            }
        }
    }
    assert!(
        (ekf.state().scale() / scale - 1.0).abs() < 0.1,
        "{}",
        ekf.state().scale()
    );
}

#[test]
fn yaw_wraps_at_half_a_turn() {
    let start = Vector3::new(0.0, 0.0, 179_f64.to_radians());
    let mut ekf = Ekf::new(EkfConfig::default(), 0.0, Vector3::zeros(), start).unwrap();
    let sample = FlightSample {
        time: 1.0,
        velocity: Vector3::zeros(),
        battery: 0.5,
    };
    ekf.predict(&sample).unwrap();
    let angles = Vector3::new(0.0, 0.0, -178_f64.to_radians());
    assert!(
        ekf.update_attitude(&AttitudeSample { angles })
            .unwrap()
            .accepted
    );
    let yaw = ekf.state().attitude.z.to_degrees();
    assert!(!(-178.0..=179.0).contains(&yaw), "{yaw}");
}

#[test]
fn angles_stay_within_half_a_turn_on_either_side() {
    use core::f64::consts::PI;
    let sigma = 1_f64.to_radians();
    for start in [PI, -PI, 3.5, -9.0, 40.0] {
        let attitude = Vector3::new(start, 0.3, -start);
        let zero = Vector3::zeros();
        let mut ekf = Ekf::new(EkfConfig::default(), 0.0, zero, attitude).unwrap();
        let within = |ekf: &Ekf| {
            let a = ekf.state().attitude;
            assert!(a.x.abs() <= PI && a.z.abs() <= PI, "{start}: {a}");
            // The same rotation as was given.
            assert!(ekf.state().rotation().angle_to(&rotation(&attitude)) < 3.0 * sigma);
        };
        within(&ekf);
        // What is a whole turn away is no news, by attitude, pose and displacement.
        for turns in [-1.0, 0.0, 2.0] {
            let angles = attitude + Vector3::new(turns, 0.0, -turns) * 2.0 * PI;
            let told = ekf.update_attitude(&AttitudeSample { angles }).unwrap();
            assert!(told.accepted && told.distance < 1e-12, "{start} {turns}");
            let (position, distance, inliers) = (zero, 0.0, 100);
            let pose = VisualPose {
                position,
                attitude: angles,
                distance,
                inliers,
            };
            let told = ekf.update_visual(&pose).unwrap();
            assert!(told.accepted && told.distance < 1e-12, "{start} {turns}");
            let odometry = AnchoredOdometry {
                anchor_position: zero,
                anchor_rotation: Rotation3::identity(),
                displacement: zero,
                attitude: angles,
                inliers,
            };
            let told = ekf.update_odometry(&odometry).unwrap();
            assert!(told.accepted && told.distance < 1e-12, "{start} {turns}");
            within(&ekf);
        }
        // A degree beyond half a turn ends beyond it.
        let angles = attitude + Vector3::new(sigma, 0.0, -sigma);
        assert!(
            ekf.update_attitude(&AttitudeSample { angles })
                .unwrap()
                .accepted
        );
        within(&ekf);
    }
}

#[test]
fn outliers_are_rejected_until_the_filter_doubts_itself() {
    let mut ekf = Ekf::new(
        EkfConfig::default(),
        0.0,
        Vector3::zeros(),
        Vector3::zeros(),
    )
    .unwrap();
    let far = VisualPose {
        position: Vector3::new(3.0, 0.0, 0.0),
        attitude: Vector3::zeros(),
        distance: 0.0,
        inliers: 100,
    };
    let before = ekf.covariance()[(0, 0)];
    for _ in 0..3 {
        assert!(!ekf.update_visual(&far).unwrap().accepted);
    }
    assert!((ekf.covariance()[(0, 0)] / before - 10.0).abs() < 1e-9);
    let tries = (0..60)
        .take_while(|_| !ekf.update_visual(&far).unwrap().accepted)
        .count();
    assert!(tries < 30, "{tries}");
    assert!((ekf.state().position.x - 3.0).abs() < 0.5);
}

#[test]
fn bad_samples_change_nothing() {
    let mut ekf = Ekf::new(
        EkfConfig::default(),
        1.0,
        Vector3::zeros(),
        Vector3::zeros(),
    )
    .unwrap();
    let copy = ekf.clone();
    let sample = |time, x| FlightSample {
        time,
        velocity: Vector3::new(x, 0.0, 0.0),
        battery: 0.5,
    };
    assert!(matches!(
        ekf.predict(&sample(0.5, 0.0)),
        Err(FusionError::TimeBackwards { .. })
    ));
    assert!(matches!(
        ekf.predict(&sample(2.0, f64::NAN)),
        Err(FusionError::NonFinite { .. })
    ));
    // Finite numbers whose product is not.
    assert!(matches!(
        ekf.predict(&sample(1e200, 1e200)),
        Err(FusionError::NonFinite { .. })
    ));
    let steep = AttitudeSample {
        angles: Vector3::new(0.0, 1.57, 0.0),
    };
    assert!(matches!(
        ekf.update_attitude(&steep),
        Err(FusionError::GimbalLock { .. })
    ));
    let nan = AttitudeSample {
        angles: Vector3::new(0.0, f64::NAN, 0.0),
    };
    assert!(ekf.update_attitude(&nan).is_err());
    assert!(ekf.set_scale(-1.0, 0.1).is_err());
    assert_eq!(ekf, copy);
    let config = EkfConfig {
        visual_sigma: 0.0,
        ..Default::default()
    };
    assert!(Ekf::new(config, 0.0, Vector3::zeros(), Vector3::zeros()).is_err());
}
