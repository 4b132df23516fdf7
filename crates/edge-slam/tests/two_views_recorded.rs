//! Two views of real cameras: alignment brings matches nearer to the true motion, and a turn is not taken for travel.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test file")]
#![cfg(feature = "image-files")]

mod shared;

use edge_slam::camera::Camera;
use edge_slam::evaluation::TimedPose;
use edge_slam::feature::{AlignConfig, Features, OrbExtractor, align_matches, match_descriptors};
use edge_slam::image::GrayImage;
use edge_slam::nalgebra::{Isometry3, Point2};
use edge_slam::odometry::OdometryConfig;
use edge_slam::sequence::ImageSequence;
use edge_slam::two_view::{TwoView, TwoViewConfig, essential_of, estimate_two_view, sampson};
use rand::SeedableRng;
use shared::shared;
use slam_bridge::read_tum;

struct Recorded {
    sequence: ImageSequence,
    camera: Camera,
    truth: Vec<TimedPose>,
    extractor: OrbExtractor,
}

struct View {
    image: GrayImage,
    features: Features,
    world_from_camera: Isometry3<f64>,
}

/// Matched pixels without lens distortion.
type Pairs = (Vec<Point2<f64>>, Vec<Point2<f64>>);

impl Recorded {
    fn open(name: &str, truth: &str) -> Option<Self> {
        let folder = shared(&["data", name])?;
        let sequence = ImageSequence::open(&folder).unwrap();
        let truth = std::fs::read(folder.join(truth)).unwrap();
        let config = OdometryConfig::default();
        Some(Self {
            camera: sequence.camera.unwrap(),
            truth: read_tum(&truth[..]).unwrap(),
            extractor: OrbExtractor::new(config.orb).unwrap(),
            sequence,
        })
    }

    fn view(&self, index: usize) -> View {
        let loaded = self.sequence.load(index).unwrap().unwrap();
        let away = |pose: &&TimedPose| (pose.time - loaded.time).abs();
        let nearest = self.truth.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        View {
            features: self.extractor.extract(&loaded.image.view()),
            image: loaded.image,
            world_from_camera: nearest.unwrap().pose,
        }
    }

    fn pairs(&self, a: &View, b: &View, align: bool) -> Pairs {
        let matches = match_descriptors(
            &a.features.descriptors,
            &b.features.descriptors,
            &OdometryConfig::default().matching,
        );
        let mut config = AlignConfig::default();
        if !align {
            config.max_shift = -1.0;
        }
        let images = [&a.image.view(), &b.image.view()];
        let keypoints = [&a.features.keypoints[..], &b.features.keypoints[..]];
        let pixel = |place: [f64; 2]| self.camera.undistort(&Point2::from(place)).unwrap();
        align_matches(images, keypoints, &matches, &config)
            .iter()
            .map(|m| (pixel(m.first), pixel(m.second)))
            .unzip()
    }

    fn estimate(&self, (first, second): &Pairs) -> Option<TwoView> {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
        let config = TwoViewConfig::default();
        estimate_two_view(first, second, &self.camera.pinhole, &config, rng).ok()
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn alignment_brings_matches_nearer_to_a_common_motion() {
    let Some(recorded) = Recorded::open("seven_scenes_redkitchen_part1", "groundtruth_tum.txt")
    else {
        return;
    };
    let [mut raw, mut aligned, mut trusted] = [0; 3];
    let mut errors = Vec::new();
    for start in (0..240).step_by(20) {
        let (a, b) = (recorded.view(start), recorded.view(start + 20));
        let truth = b.world_from_camera.inv_mul(&a.world_from_camera);
        for (align, near) in [(false, &mut raw), (true, &mut aligned)] {
            let pairs = recorded.pairs(&a, &b, align);
            let found = recorded.estimate(&pairs).unwrap();
            let essential = essential_of(&found.second_from_first);
            let ray = |pixel: &Point2<f64>| recorded.camera.pinhole.ray(pixel);
            let half_a_pixel = 0.5 / recorded.camera.pinhole.mean_focal();
            let is_near = |(a, b): &(&Point2<f64>, &Point2<f64>)| {
                sampson(&essential, &ray(a), &ray(b)).abs() < half_a_pixel
            };
            *near += pairs.0.iter().zip(&pairs.1).filter(is_near).count();
            if align && found.is_confident() {
                trusted += 1;
                let turn = found.second_from_first.rotation.angle_to(&truth.rotation);
                errors.push(turn.to_degrees());
            }
        }
    }
    println!("{raw} near, aligned {aligned}, {trusted} trusted, {errors:?} degrees");
    assert!(10 * aligned > 11 * raw, "{aligned} {raw}");
    assert!(trusted >= 8, "{trusted}");
    assert!(median(errors) < 2.0);
}

#[test]
fn a_turning_camera_is_never_trusted() {
    let Some(recorded) = Recorded::open("tum_fr1_rpy_part1", "groundtruth.txt") else {
        return;
    };
    let mut turns = 0;
    for start in (1..236).step_by(13) {
        let a = recorded.view(start);
        for gap in [2, 5, 8] {
            let b = recorded.view(start + gap);
            let truth = b.world_from_camera.inv_mul(&a.world_from_camera);
            if truth.translation.vector.norm() < 0.01 {
                turns += 1;
                let found = recorded.estimate(&recorded.pairs(&a, &b, true));
                let is_trusted = found.is_some_and(|found| found.is_confident());
                assert!(!is_trusted, "frames {start} and {}", start + gap);
            }
        }
    }
    assert!(turns >= 10, "{turns}");
}
