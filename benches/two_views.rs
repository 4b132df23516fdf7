//! Cost of the steps from two pictures to their relative motion: features, matches, alignment, pose.
//!
//! The pictures show smoothed noise at four depths, seen by a camera that moved to the right. Matching is run with and
//! without predicted places and by two indices, alignment with the patch that is the default and with a smaller one.

#![allow(clippy::expect_used, reason = "inputs are made here and must be good")]
#![allow(
    missing_docs,
    reason = "criterion_group! writes a public function without one"
)]

use criterion::{Criterion, criterion_group, criterion_main};
use edge_slam::camera::PinholeCamera;
use edge_slam::feature::{
    AlignConfig, Features, GuidedConfig, MatchConfig, MultiIndex, OrbExtractor, Prediction,
    Vocabulary, VocabularyConfig, align_matches, match_by_node, match_descriptors, match_guided,
    match_indexed,
};
use edge_slam::image::{GrayImage, gaussian_blur};
use edge_slam::nalgebra::Point2;
use edge_slam::odometry::OdometryConfig;
use edge_slam::two_view::{TwoViewConfig, estimate_two_view};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const WIDTH: usize = 640;
const HEIGHT: usize = 480;
/// Shifts of four strips, pixels.
const DISPARITIES: [usize; 4] = [8, 14, 20, 30];

fn pictures() -> [GrayImage; 2] {
    let rng = &mut Pcg64::seed_from_u64(1);
    let wide = WIDTH + 64;
    let noise = (0..wide * HEIGHT).map(|_| if rng.random() { 30 } else { 220 });
    let noise = GrayImage::new(noise.collect(), wide, HEIGHT).expect("as many as pixels");
    let texture = gaussian_blur(&noise.view(), 1.5, 3);
    [false, true].map(|moved| {
        let pixel = |i: usize| {
            let (x, y) = (i % WIDTH, i / WIDTH);
            let shift = DISPARITIES[y * DISPARITIES.len() / HEIGHT];
            texture.pixels()[y * wide + x + if moved { shift } else { 0 }]
        };
        GrayImage::new((0..WIDTH * HEIGHT).map(pixel).collect(), WIDTH, HEIGHT)
            .expect("as many as pixels")
    })
}

/// Every feature is expected at the mean shift, twelve pixels off at most.
fn predictions(features: &Features) -> Vec<Prediction> {
    let pairs = features.keypoints.iter().zip(&features.descriptors);
    let predict = |(k, &descriptor): (&edge_slam::feature::Keypoint, _)| Prediction {
        descriptor,
        place: [f64::from(k.x) - 18.0, f64::from(k.y)],
        octave: k.octave,
    };
    pairs.map(predict).collect()
}

fn steps(c: &mut Criterion) {
    let images = pictures();
    let extractor = OrbExtractor::new(OdometryConfig::default().orb).expect("defaults");
    let features = images.each_ref().map(|i| extractor.extract(&i.view()));
    let [a, b] = features.each_ref();
    let config = MatchConfig::default();
    let matches = match_descriptors(&a.descriptors, &b.descriptors, &config);
    let views = images.each_ref().map(GrayImage::view);
    let align = |config: &AlignConfig| {
        let keypoints = [&a.keypoints[..], &b.keypoints[..]];
        align_matches([&views[0], &views[1]], keypoints, &matches, config)
    };
    let mut group = c.benchmark_group("two_views");
    group.bench_function("features", |bench| {
        bench.iter(|| extractor.extract(&views[0]));
    });
    group.bench_function("matches of all pairs", |bench| {
        bench.iter(|| match_descriptors(&a.descriptors, &b.descriptors, &config));
    });
    let rng = &mut Pcg64::seed_from_u64(1);
    let descriptors = [&a.descriptors[..], &b.descriptors[..]];
    let words = VocabularyConfig::default();
    let vocabulary = Vocabulary::train(&descriptors, &words, rng).expect("descriptors");
    group.bench_function(
        "matches by node of a vocabulary, indices included",
        |bench| {
            bench.iter(|| {
                let [first, second] = descriptors.map(|side| vocabulary.direct_index(side, 1));
                match_by_node(&first, &second, &config)
            });
        },
    );
    group.bench_function("matches by multi-index, indices included", |bench| {
        bench.iter(|| {
            let [first, second] = descriptors.map(MultiIndex::new);
            match_indexed(&first, &second, &config)
        });
    });
    let predictions = predictions(a);
    group.bench_function("matches near predicted places", |bench| {
        let guided = GuidedConfig::default();
        bench.iter(|| match_guided(&predictions, &b.keypoints, &b.descriptors, &guided));
    });
    for radius in [7, 4] {
        let mut config = AlignConfig::default();
        config.patch.radius = radius;
        group.bench_function(format!("alignment, radius {radius}"), |bench| {
            bench.iter(|| align(&config));
        });
    }
    let places = align(&AlignConfig::default());
    let side = |place: fn(&edge_slam::feature::AlignedMatch) -> [f64; 2]| -> Vec<Point2<f64>> {
        places.iter().map(|p| Point2::from(place(p))).collect()
    };
    let (first, second) = (side(|p| p.first), side(|p| p.second));
    let camera = PinholeCamera::new(500.0, 500.0, 320.0, 240.0).expect("a camera");
    group.bench_function("pose", |bench| {
        bench.iter(|| {
            let rng = &mut Pcg64::seed_from_u64(1);
            estimate_two_view(&first, &second, &camera, &TwoViewConfig::default(), rng)
        });
    });
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
