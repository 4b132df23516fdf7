//! Relative pose of two views from matched pixels, or the reason why there is none.
//!
//! 1. RANSAC over five-point samples, Sampson distances, truncated squares; every new best is polished.
//! 2. Competing models: a homography and a pure rotation. The homography's share of the scores of Mur-Artal et
//!    al. 2015, and the share of inliers that a rotation explains, say what the scene allows.
//! 3. The loss may have several minima; the lowest of them (see `minima.rs`).
//! 4. Of the four motions of E the one with most points in front of both cameras; a last polish on its inliers.
//! 5. The motion counts as general only if parallax is left when the best rotation is taken out, if parts of the
//!    image agree about the direction, and if no other minimum explains the matches as well.

use nalgebra::{Isometry3, Point2};
use rand::Rng;

use super::config::check;
use super::essential::essential_of;
use super::matches::Matches;
use super::ransac::Schedule;
use super::verdict::Rivals;
use super::{Triangulated, TwoViewConfig, TwoViewError};
use crate::camera::PinholeCamera;

/// What the two views allow to say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Geometry {
    /// Rotation and translation direction are determined.
    General,
    /// One plane explains the matches: rotation and direction are given, but a mirrored twin may be the truth.
    Planar,
    /// The camera only turned (or everything is far away): the rotation is good, there is no translation.
    PureRotation,
    /// Too little parallax or too few points in front: the rotation is fair, the direction is not to be trusted.
    Weak,
}

/// Motion between two views.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoView {
    /// What the views allow to say; trust the translation only if [`Geometry::General`].
    pub geometry: Geometry,
    /// Takes points of the first camera to the second; translation of length 1, or 0 for a pure rotation.
    pub second_from_first: Isometry3<f64>,
    /// Indices of the matches that agree, ascending.
    pub inliers: Vec<usize>,
    /// Their points in the first camera's frame, index by index; `None` behind a camera or without parallax.
    pub points: Vec<Option<Triangulated>>,
    /// Median angle between the rays of the inliers, radians.
    pub parallax: f64,
    /// Median angle left between the rays of the inliers after the rotation that explains them best, radians.
    pub residual_parallax: f64,
    /// Standard deviation of the translation's direction along its worst axis, radians: from how much parts of the
    /// image disagree (see [`direction_deviation`](super::direction_deviation)); infinite when undetermined.
    pub direction_sigma: f64,
    /// How clearly the matches speak for this pose and against the next best direction of travel: a standard score, infinite
    /// without a rival (Vuong 1989).
    pub margin: f64,
    /// S_H / (S_H + S_E).
    pub homography_share: f64,
    /// Share of the inliers that a rotation alone explains.
    pub rotation_share: f64,
    /// Samples drawn for the essential matrix.
    pub samples: usize,
}

impl TwoView {
    /// Whether the translation can be trusted.
    #[must_use]
    pub fn is_confident(&self) -> bool {
        self.geometry == Geometry::General
    }
}

/// Estimates the motion between two views from matched, undistorted pixels.
///
/// Cost: a few milliseconds for 1,000 matches. The generator decides the samples; the same seed gives the same
/// result.
///
/// # Errors
/// [`TwoViewError`]: bad input, or fewer than `min_inliers` matches agree.
///
/// ```
/// use edge_slam::camera::PinholeCamera;
/// use edge_slam::nalgebra::{Isometry3, Point3, Vector3};
/// use edge_slam::two_view::{TwoViewConfig, estimate_two_view};
/// use rand::SeedableRng;
/// let camera = PinholeCamera::new(500.0, 500.0, 320.0, 240.0)?;
/// let motion = Isometry3::new(Vector3::new(0.4, 0.0, 0.1), Vector3::new(0.0, 0.05, 0.0));
/// let (mut first, mut second) = (Vec::new(), Vec::new());
/// for k in 0..199_u32 {
///     let place = |step: u32| f64::from(k * step % 199) / 99.5 - 1.0;
///     let point = Point3::new(place(37), place(53), 4.0 + place(29));
///     first.extend(camera.project(&point));
///     second.extend(camera.project(&(motion * point)));
/// }
/// let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
/// let found = estimate_two_view(&first, &second, &camera, &TwoViewConfig::default(), rng)?;
/// assert!(found.is_confident());
/// let direction = motion.translation.vector.normalize(); // how far, two views do not say
/// assert!((found.second_from_first.translation.vector - direction).norm() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn estimate_two_view(
    first: &[Point2<f64>],
    second: &[Point2<f64>],
    camera: &PinholeCamera,
    config: &TwoViewConfig,
    rng: &mut impl Rng,
) -> Result<TwoView, TwoViewError> {
    check(first, second, config)?;
    let rays = |pixels: &[Point2<f64>]| pixels.iter().map(|pixel| camera.ray(pixel)).collect();
    let matches = Matches {
        first: rays(first),
        second: rays(second),
        sigma: config.threshold / camera.mean_focal(),
    };
    let schedule = Schedule {
        most: config.max_samples,
        confidence: config.confidence,
    };
    let too_few = |inliers| TwoViewError::TooFewInliers {
        inliers,
        needed: config.min_inliers,
    };
    let essential = matches.search_essential(schedule, rng).ok_or(too_few(0))?;
    let pose = matches.best_pose(&essential.model).ok_or(too_few(0))?;
    let lowest = matches.lowest_minimum(matches.polish_pose(pose).0);
    let pose = matches
        .best_pose(&essential_of(&lowest.pose))
        .ok_or(too_few(0))?;
    let (pose, inliers) = matches.polish_pose(pose);
    if inliers.len() < config.min_inliers {
        return Err(too_few(inliers.len()));
    }
    let rivals = Rivals {
        margin: lowest.margin,
        homography_share: matches.homography_share(&essential_of(&pose), schedule, rng),
        rotation: matches.search_rotation(schedule, rng),
    };
    let mut found = matches.weigh(pose, inliers, &rivals);
    found.samples = essential.samples;
    found.geometry = matches.geometry(&found, config);
    if let (Geometry::PureRotation, Some(rotation)) = (found.geometry, rivals.rotation) {
        found.second_from_first = Isometry3::from_parts(Default::default(), rotation);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, Vector3};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    fn camera() -> PinholeCamera {
        PinholeCamera::new(500.0, 500.0, 320.0, 240.0).unwrap()
    }

    /// Matches of `count` points, `outliers` of them random, with half a pixel of noise.
    fn views(
        motion: &Isometry3<f64>,
        count: usize,
        outliers: usize,
        depth: impl Fn(f64, f64, f64) -> f64,
    ) -> (Vec<Point2<f64>>, Vec<Point2<f64>>) {
        let rng = &mut Pcg64::seed_from_u64(7);
        let mut pairs = (Vec::new(), Vec::new());
        while pairs.0.len() < count {
            let (x, y) = (rng.random::<f64>() - 0.5, 0.8 * (rng.random::<f64>() - 0.5));
            let z = depth(x, y, rng.random());
            let point = Point3::new(x * z, y * z, z);
            let (Some(a), Some(mut b)) = (
                camera().project(&point),
                camera().project(&(motion * point)),
            ) else {
                continue;
            };
            if pairs.0.len() < outliers {
                b = Point2::new(640.0 * rng.random::<f64>(), 480.0 * rng.random::<f64>());
            }
            let mut noise =
                || nalgebra::Vector2::new(rng.random::<f64>() - 0.5, rng.random::<f64>() - 0.5);
            pairs.0.push(a + noise());
            pairs.1.push(b + noise());
        }
        pairs
    }

    fn estimate(pairs: &(Vec<Point2<f64>>, Vec<Point2<f64>>)) -> Result<TwoView, TwoViewError> {
        let rng = &mut Pcg64::seed_from_u64(1);
        estimate_two_view(
            &pairs.0,
            &pairs.1,
            &camera(),
            &TwoViewConfig::default(),
            rng,
        )
    }

    #[test]
    fn a_general_scene_with_half_outliers_is_solved() {
        let motion = Isometry3::new(Vector3::new(0.5, 0.1, -0.1), Vector3::new(0.05, -0.1, 0.03));
        let pairs = views(&motion, 300, 150, |_, _, r| 2.0 + 4.0 * r);
        let found = estimate(&pairs).unwrap();
        assert_eq!(found.geometry, Geometry::General);
        assert!(
            found
                .second_from_first
                .rotation
                .angle_to(&motion.rotation)
                .to_degrees()
                < 0.3
        );
        let direction = motion.translation.vector.normalize();
        assert!(
            found
                .second_from_first
                .translation
                .vector
                .angle(&direction)
                .to_degrees()
                < 2.0
        );
        assert!((140..180).contains(&found.inliers.len()));
        assert!(found.points.iter().filter(|p| p.is_some()).count() * 10 > found.inliers.len() * 9);
        assert_eq!(found, estimate(&pairs).unwrap());
    }

    #[test]
    fn a_turn_is_told_from_a_move() {
        let motion = Isometry3::new(Vector3::zeros(), Vector3::new(0.02, 0.15, 0.05));
        let found = estimate(&views(&motion, 200, 60, |_, _, r| 2.0 + 4.0 * r)).unwrap();
        assert_eq!(
            found.geometry,
            Geometry::PureRotation,
            "{} {}",
            found.rotation_share,
            found.inliers.len()
        );
        assert!(!found.is_confident());
        assert!(
            found
                .second_from_first
                .rotation
                .angle_to(&motion.rotation)
                .to_degrees()
                < 0.1
        );
        assert_eq!(found.second_from_first.translation.vector.norm(), 0.0);
    }

    #[test]
    fn no_turn_is_ever_trusted() {
        let rng = &mut Pcg64::seed_from_u64(31);
        for trial in 0..40 {
            let mut unit = || rng.random::<f64>() - 0.5;
            let turn = Vector3::new(0.3 * unit(), 0.6 * unit(), 0.3 * unit());
            // A few millimetres at a depth of metres, as when a hand turns a camera.
            let shift = Vector3::new(unit(), unit(), unit()).normalize() * 0.004;
            let pairs = views(&Isometry3::new(shift, turn), 200, 40, |_, _, r| {
                1.5 + 3.0 * r
            });
            let rng = &mut Pcg64::seed_from_u64(trial);
            let config = TwoViewConfig::default();
            let found = estimate_two_view(&pairs.0, &pairs.1, &camera(), &config, rng);
            assert!(
                !found.is_ok_and(|found| found.is_confident()),
                "{trial} {turn}"
            );
        }
    }

    #[test]
    fn each_sign_of_a_turn_withdraws_the_trust() {
        let motion = Isometry3::new(Vector3::new(0.5, 0.1, -0.1), Vector3::new(0.05, -0.1, 0.03));
        let pairs = views(&motion, 300, 60, |_, _, r| 2.0 + 4.0 * r);
        let run = |config: &TwoViewConfig| {
            let rng = &mut Pcg64::seed_from_u64(1);
            estimate_two_view(&pairs.0, &pairs.1, &camera(), config, rng).unwrap()
        };
        let config = TwoViewConfig::default();
        let found = run(&config);
        assert!(found.is_confident());
        assert!(found.residual_parallax > 1_f64.to_radians());
        assert!(found.residual_parallax < found.parallax);
        assert!(found.direction_sigma < 2_f64.to_radians());
        let min_residual_parallax = 1.01 * found.residual_parallax;
        let strict = TwoViewConfig {
            min_residual_parallax,
            ..config
        };
        assert_eq!(run(&strict).geometry, Geometry::Weak);
        let max_direction_sigma = 0.99 * found.direction_sigma;
        let strict = TwoViewConfig {
            max_direction_sigma,
            ..config
        };
        assert_eq!(run(&strict).geometry, Geometry::Weak);
    }

    #[test]
    fn a_wall_is_planar() {
        let motion = Isometry3::new(Vector3::new(0.6, 0.0, 0.2), Vector3::new(0.0, -0.1, 0.0));
        let found = estimate(&views(&motion, 200, 40, |x, y, _| 4.0 + x + 0.5 * y)).unwrap();
        assert_eq!(found.geometry, Geometry::Planar);
    }

    #[test]
    fn limits_that_are_no_numbers_are_refused() {
        type Field = fn(&mut TwoViewConfig) -> &mut f64;
        // A turn: with NaN for a limit it would pass for a general motion.
        let motion = Isometry3::new(Vector3::zeros(), Vector3::new(0.02, 0.15, 0.05));
        let pairs = views(&motion, 60, 0, |_, _, r| 2.0 + 4.0 * r);
        let fields: [(&str, Field); 11] = [
            ("threshold", |c| &mut c.threshold),
            ("confidence", |c| &mut c.confidence),
            ("min_in_front", |c| &mut c.min_in_front),
            ("min_inlier_share", |c| &mut c.min_inlier_share),
            ("min_parallax", |c| &mut c.min_parallax),
            ("planar_share", |c| &mut c.planar_share),
            ("min_residual_parallax", |c| &mut c.min_residual_parallax),
            ("residual_per_turn", |c| &mut c.residual_per_turn),
            ("max_direction_sigma", |c| &mut c.max_direction_sigma),
            ("min_margin", |c| &mut c.min_margin),
            ("rotation_share", |c| &mut c.rotation_share),
        ];
        for (field, at) in fields {
            let mut config = TwoViewConfig::default();
            assert!(config.validate().is_ok());
            *at(&mut config) = f64::NAN;
            let rng = &mut Pcg64::seed_from_u64(1);
            match estimate_two_view(&pairs.0, &pairs.1, &camera(), &config, rng) {
                Err(TwoViewError::Parameter { name, .. }) => assert_eq!(name, field),
                other => panic!("{field}: {other:?}"),
            }
        }
        for (samples, inliers) in [(0, 20), (500, 5)] {
            let config = TwoViewConfig {
                max_samples: samples,
                min_inliers: inliers,
                ..TwoViewConfig::default()
            };
            assert!(config.validate().is_err(), "{samples} {inliers}");
        }
    }

    #[test]
    fn nonsense_is_an_error() {
        assert!(matches!(
            estimate(&(Vec::new(), Vec::new())),
            Err(TwoViewError::TooFewInliers {
                inliers: 0,
                needed: 20
            })
        ));
        let same = vec![Point2::new(3.0, 4.0); 50];
        assert!(estimate(&(same.clone(), same.clone())).is_err());
        let line: Vec<_> = (0..50)
            .map(|k| Point2::new(f64::from(k) * 9.0, 100.0))
            .collect();
        assert!(
            estimate(&(line.clone(), line.clone())).is_err_and(|_| true)
                || !estimate(&(line.clone(), line)).unwrap().is_confident()
        );
        let mut nan = same.clone();
        nan[3].x = f64::NAN;
        assert!(matches!(
            estimate(&(nan, same.clone())),
            Err(TwoViewError::NonFinite { index: 3 })
        ));
        assert!(estimate(&(same, Vec::new())).is_err());
    }
}
