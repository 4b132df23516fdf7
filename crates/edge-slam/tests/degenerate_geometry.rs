//! Points that leave something open: fewer than needed, repeated, on a line, in a plane, mirrored, at infinity, at the image's edge.
#![allow(clippy::unwrap_used, reason = "a test file")]

use edge_slam::camera::PinholeCamera;
use edge_slam::depth::fit_depth;
use edge_slam::evaluation::{Alignment, align_points};
use edge_slam::feature::{KltConfig, klt_pyramid, track_points};
use edge_slam::image::GrayImage;
use edge_slam::nalgebra::{Isometry3, Matrix3, Point2, Point3, Vector3};
use edge_slam::two_view::{
    TwoViewConfig, TwoViewError, essential_from_five, essential_of, estimate_two_view,
    homography_from_points, triangulate,
};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn flat(point: &Point3<f64>) -> Vector3<f64> {
    point.coords / point.z
}

/// Rays of five points in both views.
fn five(points: [Point3<f64>; 5], motion: &Isometry3<f64>) -> [[Vector3<f64>; 5]; 2] {
    [
        points.map(|p| flat(&p)),
        points.map(|p| flat(&(motion * p))),
    ]
}

/// Distance of the nearest solution from the true matrix, up to sign.
fn nearest(points: [Point3<f64>; 5], motion: &Isometry3<f64>) -> f64 {
    let [first, second] = five(points, motion);
    let truth = essential_of(motion);
    let truth = truth * (core::f64::consts::SQRT_2 / truth.norm());
    let off = |e: &Matrix3<f64>| (e - truth).norm().min((e + truth).norm());
    let found = essential_from_five(&first, &second);
    found.iter().map(off).fold(f64::INFINITY, f64::min)
}

#[test]
fn five_points_of_a_plane_are_enough_for_the_essential_matrix() {
    let rng = &mut Pcg64::seed_from_u64(12);
    let mut missed = 0;
    for _ in 0..200 {
        let mut unit = || rng.random::<f64>() * 2.0 - 1.0;
        let motion = Isometry3::new(
            Vector3::new(unit(), unit(), unit()).normalize(),
            Vector3::new(unit(), unit(), unit()) * 0.3,
        );
        let points = [(); 5].map(|()| {
            let (x, y) = (unit(), unit());
            Point3::new(x, y, 4.0 + 0.4 * x - 0.2 * y)
        });
        missed += usize::from(nearest(points, &motion) > 1e-5);
    }
    assert!(missed <= 20, "{missed} of 200");
}

proptest! {
    #[test]
    fn five_repeated_or_collinear_points_give_finite_matrices_or_none(
        x in prop::collection::vec(-1.0..1.0f64, 10), which in 0_usize..3,
    ) {
        let motion = Isometry3::new(Vector3::new(0.5, 0.1, 0.2), Vector3::new(0.05, -0.1, 0.02));
        let points = core::array::from_fn(|k| match which {
            // One point twice, two points only, a line.
            0 => Point3::new(x[k % 4], x[(k + 1) % 4], 3.0 + x[(k + 2) % 4]),
            1 => Point3::new(x[k % 2], x[k % 2 + 2], 3.0 + x[k % 2 + 4]),
            _ => Point3::new(x[k], 0.3 * x[k], 3.0 + 0.5 * x[k]),
        });
        let [first, second] = five(points, &motion);
        for e in essential_from_five(&first, &second) {
            prop_assert!((e.norm() - core::f64::consts::SQRT_2).abs() < 1e-9);
            for (a, b) in first.iter().zip(&second) {
                prop_assert!(b.dot(&(e * a)).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn a_homography_needs_four_points_of_which_no_three_are_in_a_line(
        h in prop::array::uniform9(-0.2..0.2f64), at in prop::array::uniform4(-1.0..1.0f64), along in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let turn = Matrix3::from_row_slice(&h) + Matrix3::identity();
        let map = |p: &Vector3<f64>| { let q = turn * p; q / q.z };
        let line = along.map(|s| Vector3::new(at[0] + s, at[1] - 0.7 * s, 1.0));
        let points = [line[0], line[1], line[2], Vector3::new(at[2] + 3.0, at[3], 1.0)];
        prop_assert!(homography_from_points(&points, &points.map(|p| map(&p))).is_none());
        // One of four twice.
        let points = [line[0], line[0], Vector3::new(0.3, 2.0, 1.0), Vector3::new(at[2] + 3.0, at[3], 1.0)];
        prop_assert!(homography_from_points(&points, &points.map(|p| map(&p))).is_none());
    }
}

#[test]
fn points_that_stay_give_the_homography_that_does_nothing() {
    let points: Vec<_> = (0..12)
        .map(|k| Vector3::new(f64::from(k % 4) - 1.5, f64::from(k / 4) * 0.7, 1.0))
        .collect();
    let found = homography_from_points(&points, &points).unwrap();
    assert!((found / found[(2, 2)] - Matrix3::identity()).norm() < 1e-9);
}

#[test]
fn too_few_repeated_collinear_or_planar_matches_are_no_general_motion() {
    let camera = PinholeCamera::new(500.0, 500.0, 320.0, 240.0).unwrap();
    let motion = Isometry3::new(Vector3::new(0.4, 0.1, 0.0), Vector3::new(0.0, 0.05, 0.02));
    let run = |points: &[Point3<f64>]| {
        let pixels = |motion: Isometry3<f64>| -> Vec<Point2<f64>> {
            points
                .iter()
                .map(|p| camera.project(&(motion * p)).unwrap())
                .collect()
        };
        let rng = &mut Pcg64::seed_from_u64(2);
        let (first, second) = (pixels(Isometry3::identity()), pixels(motion));
        estimate_two_view(&first, &second, &camera, &TwoViewConfig::default(), rng)
    };
    let place = |k: u32| f64::from(k * 37 % 101) / 50.0 - 1.0;
    for count in 0..5 {
        let few: Vec<_> = (0..count)
            .map(|k| Point3::new(place(k), place(k + 9), 3.0 + place(k + 40)))
            .collect();
        let inliers = 0;
        let expected = TwoViewError::TooFewInliers {
            inliers,
            needed: 20,
        };
        assert_eq!(run(&few), Err(expected));
    }
    let repeated: Vec<_> = (0..200)
        .map(|k| Point3::new(place(k % 4), place(k % 4 + 9), 3.0 + place(k % 4 + 40)))
        .collect();
    let line: Vec<_> = (0..200)
        .map(|k| Point3::new(place(k), 0.4 * place(k), 3.0 + 0.5 * place(k)))
        .collect();
    let plane: Vec<_> = (0..200)
        .map(|k| Point3::new(place(k), place(k * 3 + 1), 3.0 + 0.5 * place(k)))
        .collect();
    for (name, points) in [("repeated", repeated), ("line", line), ("plane", plane)] {
        let found = run(&points);
        assert!(!found.is_ok_and(|found| found.is_confident()), "{name}");
    }
}

#[test]
fn what_is_at_infinity_or_behind_is_not_triangulated() {
    let ray = |x: f64| Vector3::new(x, 0.0, 1.0);
    let right = Isometry3::translation(-0.5, 0.0, 0.0);
    // The second camera is half a unit to the right: what is ahead lies farther left in it.
    assert!((triangulate(&ray(0.0), &ray(-0.1), &right).unwrap().point.z - 5.0).abs() < 1e-9);
    for second in [0.0, 1e-6, -1e-6, 0.1, f64::INFINITY] {
        assert!(
            triangulate(&ray(0.0), &ray(second), &right).is_none(),
            "{second}"
        );
    }
    // Without travel, every pair of rays meets in the camera.
    for second in [0.0, 0.1, -0.3] {
        assert!(triangulate(&ray(0.0), &ray(second), &Isometry3::identity()).is_none());
    }
    // In front of the first, behind the second camera.
    let turned = Isometry3::rotation(Vector3::new(0.0, core::f64::consts::PI, 0.0));
    assert!(triangulate(&ray(0.1), &ray(0.2), &(turned * right)).is_none());
    // Far away it is said how little is known.
    let far = triangulate(&ray(0.0), &ray(-5e-5), &right).unwrap();
    assert!((far.point.z / 1e4 - 1.0).abs() < 1e-3);
    assert!(far.covariance[(2, 2)].sqrt() > 1e7);
}

#[test]
fn a_mirrored_cloud_is_met_by_a_rotation_and_not_by_a_mirror() {
    let rng = &mut Pcg64::seed_from_u64(8);
    let cloud: Vec<[f64; 3]> = (0..30).map(|_| rng.random()).collect();
    let mirrored: Vec<[f64; 3]> = cloud.iter().map(|[x, y, z]| [*x, *y, -z]).collect();
    for alignment in [Alignment::Se3, Alignment::Sim3] {
        let found = align_points(&cloud, &mirrored, alignment).unwrap();
        let turn = found.motion.rotation.to_rotation_matrix();
        assert!((turn.matrix().determinant() - 1.0).abs() < 1e-12);
        let off = |(a, b): (&[f64; 3], &[f64; 3])| {
            (found.apply(&Point3::from(*a)) - Point3::from(*b)).norm()
        };
        let worst = cloud.iter().zip(&mirrored).map(off).fold(0.0, f64::max);
        assert!(worst > 0.1 && found.scale > 0.0, "{worst}");
    }
    // A line in space, and one that is only nearly a line.
    let line = |bend: f64| -> Vec<[f64; 3]> {
        (0..20)
            .map(f64::from)
            .map(|k| [k, 2.0 * k, bend * k * k - 0.5 * k])
            .collect()
    };
    assert!(align_points(&line(0.0), &line(0.0), Alignment::Sim3).is_err());
    assert!(align_points(&line(1e-3), &line(1e-3), Alignment::Sim3).is_ok());
}

#[test]
fn tracked_points_near_the_edge_are_found_or_lost_but_never_outside() {
    let pixel = |i: usize, dx: f64| {
        let (x, y) = ((i % 120) as f64 - dx, (i / 120) as f64);
        (128.0 + 60.0 * (0.31 * x + 0.1 * y).sin() + 50.0 * (0.27 * y).cos()).round() as u8
    };
    let image = |dx: f64| {
        let pixels = (0..120 * 90).map(|i| pixel(i, dx)).collect();
        klt_pyramid(&GrayImage::new(pixels, 120, 90).unwrap().view())
    };
    let points: Vec<[f64; 2]> = (0..=24)
        .flat_map(|k| (0..=18).map(move |j| [5.0 * f64::from(k), 5.0 * f64::from(j)]))
        .chain([
            [-3.0, 40.0],
            [119.5, 89.5],
            [1e9, 1e9],
            [60.0, f64::INFINITY],
        ])
        .collect();
    for dx in [0.0, 2.5, -4.0] {
        let found = track_points(&image(0.0), &image(dx), &points, &[], &KltConfig::default());
        let mut tracked = 0;
        for (point, place) in points.iter().zip(&found) {
            let Some([x, y]) = place else { continue };
            tracked += 1;
            // A patch of 15 pixels fits.
            assert!(
                (7.0..=112.0).contains(x) && (7.0..=82.0).contains(y),
                "{x} {y}"
            );
            assert!(
                (x - point[0] - dx).abs() < 0.1 && (y - point[1]).abs() < 0.1,
                "{point:?} {place:?}"
            );
        }
        assert!(tracked > 200, "{tracked}");
        // A patch that needs pixels beyond the edge is lost.
        let inside = |p: &[f64; 2]| p[0] >= 8.0 && p[1] >= 8.0 && p[0] <= 110.0 && p[1] <= 80.0;
        assert!(
            points
                .iter()
                .zip(&found)
                .all(|(p, f)| f.is_none() || inside(p))
        );
    }
}

#[test]
fn a_depth_that_says_nothing_or_the_opposite_does_not_pass() {
    let truth: Vec<f64> = (0..60).map(|k| 1.0 + 0.05 * f64::from(k)).collect();
    let fit = |predicted: &[f64]| fit_depth(predicted, &truth).unwrap();
    let constant = fit(&[2.0; 60]);
    assert!(constant.correlation.abs() < 1e-9 && !constant.passes(0.5));
    let opposite: Vec<f64> = truth.iter().map(|d| 3.0 / d).collect();
    let opposite = fit(&opposite);
    assert!(opposite.correlation < -0.99 && !opposite.passes(0.5) && opposite.scale > 0.0);
    // Just under half of the pairs are wrong, all to one side.
    let half: Vec<f64> = (0..60)
        .map(|k| if k % 9 < 4 { 0.01 } else { 2.0 * truth[k] })
        .collect();
    let half = fit(&half);
    assert!((half.scale - 0.5).abs() < 0.01, "{half:?}");
    // A constant truth is no correlation either, but a scale.
    let flat = fit_depth(&truth, &[2.0; 60]).unwrap();
    assert!(flat.correlation.abs() < 1e-9 && flat.scale > 0.0);
    let few = fit_depth(&truth[..19], &truth[..19]);
    assert!(few.is_err() && fit_depth(&truth[..20], &truth[..20]).is_ok());
}
