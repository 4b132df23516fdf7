//! No public entry panics, whatever pixels, depths, matches and poses it is given.
#![allow(clippy::unwrap_used, reason = "a test file")]

use edge_slam::Frame;
use edge_slam::camera::{Camera, PinholeCamera, RadialTangential, UndistortionMap};
use edge_slam::depth::{DepthImage, fit_depth};
use edge_slam::edge::{
    CannyConfig, JunctionConfig, canny, find_junctions, lift_chain, lift_junction, trace_chains,
};
use edge_slam::evaluation::{
    AlignBy, Alignment, ApeConfig, RpeConfig, TimedPose, absolute_pose_error, map_accuracy,
    relative_pose_error,
};
use edge_slam::feature::KltConfig;
use edge_slam::image::GrayImage;
use edge_slam::nalgebra::{Isometry3, Point2, Point3, Vector3};
use edge_slam::odometry::{Odometry, OdometryConfig, Tracker};
use edge_slam::pnp::{Observation, PnpConfig, refine_pose};
use edge_slam::two_view::{
    TwoViewConfig, essential_from_five, estimate_two_view, refine_relative_pose, triangulate,
};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_pcg::Pcg64;

fn camera() -> PinholeCamera {
    PinholeCamera::new(80.0, 80.0, 40.0, 30.0).unwrap()
}

/// Numbers of every kind: usual ones, huge ones, infinite ones and NaN.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![8 => -100.0..100.0f64, 1 => prop::num::f64::ANY, 1 => Just(f64::NAN), 1 => Just(0.0)]
}

/// Constant, saturated, striped or random pixels of any size.
fn image() -> impl Strategy<Value = GrayImage> {
    let pixels = prop_oneof![
        any::<u8>().prop_map(|grey| vec![grey; 80 * 60]),
        (1usize..9).prop_map(|k| (0..80 * 60)
            .map(|i| if i / k % 2 == 0 { 0 } else { 255 })
            .collect()),
        prop::collection::vec(any::<u8>(), 80 * 60),
    ];
    (1usize..80, 1usize..60, pixels)
        .prop_map(|(w, h, pixels)| GrayImage::new(pixels, w, h).unwrap())
}

fn depth_of(image: &GrayImage, value: f32) -> DepthImage {
    let (width, height) = (image.width(), image.height());
    let pixel = |i: usize| {
        if i.is_multiple_of(3) {
            value
        } else {
            1.0 + (i % 7) as f32
        }
    };
    DepthImage::new((0..width * height).map(pixel).collect(), width, height).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn images_and_depths(images in prop::collection::vec(image(), 1..4), value in any::<f32>()) {
        let lens = RadialTangential { k1: 0.2, k2: -0.9, p1: 0.0, p2: 0.01, k3: 1.1 };
        let camera = Camera { pinhole: camera(), distortion: lens };
        let config = OdometryConfig::default();
        let traced = OdometryConfig { tracker: Tracker::Klt(KltConfig::default()), ..config };
        let mut odometries = [config, traced].map(|config| Odometry::new(camera, config).unwrap());
        let rng = &mut Pcg64::seed_from_u64(1);
        for (time, image) in images.iter().enumerate() {
            let depth = depth_of(image, value);
            let view = image.view();
            let edges = canny(&view, &CannyConfig::default()).unwrap();
            let chains = trace_chains(&edges, 2);
            let config = JunctionConfig { shortest_run: 3.0, ..Default::default() };
            for junction in find_junctions(&edges, &chains, Some(&depth), &config) {
                let _ = lift_junction(&junction, &camera, &depth, &config);
            }
            for chain in &chains {
                prop_assert!(lift_chain(chain, &camera, &depth).len() <= chain.points.len());
            }
            let map = UndistortionMap::new(&camera, image.width(), image.height());
            let _ = map.apply(&view);
            // A depth image of another size than the frame's is no reason to panic either.
            let other = depth_of(&images[0], value);
            for depth in [None, Some(&depth), Some(&other)] {
                let frame = Frame { time: time as f64, image: view, depth };
                for odometry in &mut odometries {
                    let pose = odometry.track(&frame, depth, rng).world_from_camera;
                    prop_assert!(pose.is_none_or(|p| p.translation.vector.iter().all(|v| v.is_finite())));
                }
            }
        }
    }

    #[test]
    fn matches_and_points(numbers in prop::collection::vec(number(), 240), repeated in any::<bool>()) {
        let pixel = |k: usize| Point2::new(numbers[k % 240], numbers[(7 * k + 1) % 240]);
        let first: Vec<_> = (0..60).map(|k| if repeated { pixel(k % 2) } else { pixel(k) }).collect();
        let second: Vec<_> = (0..60).map(|k| pixel(k + 3)).collect();
        let rng = &mut Pcg64::seed_from_u64(1);
        let config = TwoViewConfig { min_inliers: 6, ..Default::default() };
        let _ = estimate_two_view(&first, &second, &camera(), &config, rng);
        let ray = |k: usize| Vector3::new(numbers[k], numbers[k + 1], numbers[k + 2]);
        let motion = Isometry3::new(ray(0), ray(3));
        let rays: [Vector3<f64>; 5] = core::array::from_fn(|k| ray(3 * k));
        let others: [Vector3<f64>; 5] = core::array::from_fn(|k| ray(3 * k + 20));
        let _ = essential_from_five(&rays, &others);
        let _ = refine_relative_pose(&motion, &rays, &others, 0.01, 5);
        let _ = triangulate(&rays[0], &others[0], &motion);
        let observations: Vec<_> = (0..40)
            .map(|k| Observation { point: Point3::from(ray(5 * k)), pixel: pixel(k), sigma: numbers[k] })
            .collect();
        let _ = refine_pose(&observations, &camera(), &motion, &PnpConfig::default());
    }

    #[test]
    fn trajectories_maps_and_depth_pairs(numbers in prop::collection::vec(number(), 60)) {
        let vector = |k: usize| Vector3::new(numbers[k % 60], numbers[(k + 7) % 60], numbers[(k + 13) % 60]);
        let pose = |k: usize| TimedPose { time: numbers[k], pose: Isometry3::new(vector(k), vector(k + 1)) };
        let truth: Vec<_> = (0..30).map(pose).collect();
        let estimate: Vec<_> = (20..60).map(pose).collect();
        for alignment in [Alignment::None, Alignment::Se3, Alignment::Sim3] {
            for align_by in [AlignBy::Positions, AlignBy::Poses] {
                let config = ApeConfig { alignment, align_by, max_difference: 5.0 };
                let _ = absolute_pose_error(&estimate, &truth, &config);
            }
        }
        let config = RpeConfig { max_difference: 5.0, ..Default::default() };
        let _ = relative_pose_error(&estimate, &truth, &config);
        let points: Vec<[f64; 3]> = (0..30).map(|k| vector(k).into()).collect();
        let _ = map_accuracy(&points, &points[5..], 0.5);
        let _ = fit_depth(&numbers[..30], &numbers[30..]);
    }
}
