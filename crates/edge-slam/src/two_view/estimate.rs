//! Relative pose of two views from matched pixels, or the reason why there is none.
//!
//! 1. RANSAC over five-point samples, Sampson distances, truncated squares; every new best is polished.
//! 2. Competing models: a homography and a pure rotation. The homography's share of the scores of Mur-Artal et
//!    al. 2015, and the share of inliers that a rotation explains, say what the scene allows.
//! 3. Of the four motions of E the one with most points in front of both cameras; a last polish on its inliers.

use nalgebra::{Isometry3, Matrix3, Point2, UnitQuaternion, Vector3};
use rand::Rng;

use super::essential::{candidate_poses, essential_of};
use super::homography::{homography_from_points, transfer};
use super::ransac::{Best, Schedule, search};
use super::refine::refine_relative_pose;
use super::rotation::fit_rotation;
use super::{Triangulated, essential_from_five, sampson, triangulate};
use crate::camera::PinholeCamera;

/// Parameters of [`estimate_two_view`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoViewConfig {
    /// Sampson distance up to which a match is an inlier, pixels, > 0. Default 1.
    pub threshold: f64,
    /// Probability of having drawn a clean sample, in (0, 1). Default 0.999.
    pub confidence: f64,
    /// Most samples drawn, >= 1. Default 500.
    pub max_samples: usize,
    /// Fewest inliers of a pose, >= 6. Default 20.
    pub min_inliers: usize,
    /// Fewest inliers of a pose that is trusted. Default 50 (Mur-Artal et al. 2015 ask for as many points).
    pub min_confident_inliers: usize,
    /// Least share of inliers in front of both cameras, 0..=1. Default 0.7.
    pub min_in_front: f64,
    /// Least share of all matches that must be inliers, 0..=1. Default 0.4: with fewer, outliers that agree by
    /// chance choose the direction.
    pub min_inlier_share: f64,
    /// Least median angle between matched rays, radians, >= 0. Default 1.5 degrees: of pairs of a hand-held
    /// sequence with a true baseline under 1 cm, those above are rare.
    pub min_parallax: f64,
    /// Homography scores above this share call the scene planar, 0..=1. Default 0.45 (Mur-Artal et al. 2015).
    pub planar_share: f64,
    /// A rotation that explains this share of the inliers, within twice the threshold, is the whole motion,
    /// 0..=1. Default 0.8.
    pub rotation_share: f64,
}

impl Default for TwoViewConfig {
    fn default() -> Self {
        Self {
            threshold: 1.0,
            confidence: 0.999,
            max_samples: 500,
            min_inliers: 20,
            min_confident_inliers: 50,
            min_in_front: 0.7,
            min_inlier_share: 0.4,
            min_parallax: 1.5_f64.to_radians(),
            planar_share: 0.45,
            rotation_share: 0.8,
        }
    }
}

/// Why no relative pose was estimated.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TwoViewError {
    /// The two slices differ in length.
    #[error("{first} pixels of the first view cannot be matched with {second} of the second")]
    LengthMismatch {
        /// Pixels of the first view.
        first: usize,
        /// Pixels of the second view.
        second: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("match {index} has a coordinate that is not finite")]
    NonFinite {
        /// Which match.
        index: usize,
    },
    /// Not enough matches agree.
    #[error(
        "{inliers} matches agree with one motion, {needed} are needed; take frames that overlap more"
    )]
    TooFewInliers {
        /// Matches that agree.
        inliers: usize,
        /// Matches needed.
        needed: usize,
    },
    /// A parameter is outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Parameter {
        /// Field of the configuration.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
}

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
    let (pose, inliers) = matches.polish_pose(pose);
    if inliers.len() < config.min_inliers {
        return Err(too_few(inliers.len()));
    }
    let homography_share = matches.homography_share(&essential_of(&pose), schedule, rng);
    let rotation = matches.search_rotation(schedule, rng);
    Ok(matches.judge(
        pose,
        inliers,
        homography_share,
        rotation,
        essential.samples,
        config,
    ))
}

fn check(
    first: &[Point2<f64>],
    second: &[Point2<f64>],
    config: &TwoViewConfig,
) -> Result<(), TwoViewError> {
    if first.len() != second.len() {
        return Err(TwoViewError::LengthMismatch {
            first: first.len(),
            second: second.len(),
        });
    }
    let usable = |p: &Point2<f64>| p.x.abs() < 1e9 && p.y.abs() < 1e9;
    if let Some(index) = first
        .iter()
        .zip(second)
        .position(|(a, b)| !(usable(a) && usable(b)))
    {
        return Err(TwoViewError::NonFinite { index });
    }
    let parameter = |name, value: f64, good: bool, range| {
        if good {
            Ok(())
        } else {
            Err(TwoViewError::Parameter { name, value, range })
        }
    };
    let TwoViewConfig {
        threshold,
        confidence,
        ..
    } = *config;
    #[expect(clippy::cast_precision_loss, reason = "only shown in a message")]
    let (samples, inliers) = (config.max_samples as f64, config.min_inliers as f64);
    parameter(
        "threshold",
        threshold,
        threshold > 0.0 && threshold < 1e6,
        "positive",
    )?;
    let probable = confidence > 0.0 && confidence < 1.0;
    parameter("confidence", confidence, probable, "between 0 and 1")?;
    parameter("max_samples", samples, config.max_samples > 0, "at least 1")?;
    parameter(
        "min_inliers",
        inliers,
        config.min_inliers >= 6,
        "at least 6",
    )
}

/// Matched rays (z = 1) and the inlier threshold in their unit.
struct Matches {
    first: Vec<Vector3<f64>>,
    second: Vec<Vector3<f64>>,
    sigma: f64,
}

impl Matches {
    fn search_essential(
        &self,
        schedule: Schedule,
        rng: &mut impl Rng,
    ) -> Option<Best<Matrix3<f64>>> {
        let square = self.sigma * self.sigma;
        search(
            self.first.len(),
            schedule,
            rng,
            |sample: &[usize; 5]| {
                essential_from_five(
                    &sample.map(|i| self.first[i]),
                    &sample.map(|i| self.second[i]),
                )
            },
            |model, i| sampson(model, &self.first[i], &self.second[i]).powi(2) / square,
            |model| self.polish_essential(model),
        )
    }

    /// A few steps of refinement on the inliers of a new best matrix.
    fn polish_essential(&self, model: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        let pose = candidate_poses(model)?[0];
        let (a, b) = self.pick(&self.inliers(model, 2.0));
        (a.len() >= 8).then(|| essential_of(&refine_relative_pose(&pose, &a, &b, self.sigma, 4)))
    }

    fn inliers(&self, model: &Matrix3<f64>, thresholds: f64) -> Vec<usize> {
        let near = |&i: &usize| {
            sampson(model, &self.first[i], &self.second[i]).abs() < thresholds * self.sigma
        };
        (0..self.first.len()).filter(near).collect()
    }

    fn pick(&self, indices: &[usize]) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        indices
            .iter()
            .map(|&i| (self.first[i], self.second[i]))
            .unzip()
    }

    /// The candidate with most points in front of both cameras.
    fn best_pose(&self, model: &Matrix3<f64>) -> Option<Isometry3<f64>> {
        let inliers = self.inliers(model, 1.0);
        let in_front = |pose: &Isometry3<f64>| {
            inliers
                .iter()
                .filter(|&&i| is_in_front(pose, &self.first[i], &self.second[i]))
                .count()
        };
        let candidates = candidate_poses(model)?;
        let counts = candidates.each_ref().map(in_front);
        (0..4)
            .max_by_key(|&k| (counts[k], 4 - k))
            .map(|k| candidates[k])
    }

    /// Alternates refinement and choice of inliers.
    fn polish_pose(&self, mut pose: Isometry3<f64>) -> (Isometry3<f64>, Vec<usize>) {
        for _ in 0..3 {
            let (a, b) = self.pick(&self.inliers(&essential_of(&pose), 3.0));
            pose = refine_relative_pose(&pose, &a, &b, 0.5 * self.sigma, 10);
        }
        (pose, self.inliers(&essential_of(&pose), 1.0))
    }

    fn search_rotation(
        &self,
        schedule: Schedule,
        rng: &mut impl Rng,
    ) -> Option<UnitQuaternion<f64>> {
        let square = 4.0 * self.sigma * self.sigma;
        let distance = |rotation: &UnitQuaternion<f64>, i: usize| {
            let turned = rotation * self.first[i];
            let (x, y) = (turned.x / turned.z, turned.y / turned.z);
            let near = (x - self.second[i].x).powi(2) + (y - self.second[i].y).powi(2);
            if turned.z > 0.0 {
                near / square
            } else {
                f64::INFINITY
            }
        };
        let refit = |rotation: &UnitQuaternion<f64>| {
            let near: Vec<usize> = (0..self.first.len())
                .filter(|&i| distance(rotation, i) < 4.0)
                .collect();
            let (a, b) = self.pick(&near);
            fit_rotation(&a, &b)
        };
        let fit = |sample: &[usize; 2]| {
            let (a, b) = self.pick(sample);
            fit_rotation(&a, &b).into_iter().collect()
        };
        search(self.first.len(), schedule, rng, fit, distance, refit).map(|best| best.model)
    }

    /// S_H / (S_H + S_E): both scores count how far inside their thresholds the matches are.
    fn homography_share(
        &self,
        essential: &Matrix3<f64>,
        schedule: Schedule,
        rng: &mut impl Rng,
    ) -> f64 {
        let square = self.sigma * self.sigma;
        let both = |h: &(Matrix3<f64>, Matrix3<f64>), i: usize| {
            let (a, b) = (&self.first[i], &self.second[i]);
            [transfer(&h.0, a, b) / square, transfer(&h.1, b, a) / square]
        };
        let with_inverse = |h: Matrix3<f64>| h.try_inverse().map(|inverse| (h, inverse));
        let fit = |indices: &[usize]| {
            let (a, b) = self.pick(indices);
            homography_from_points(&a, &b).and_then(with_inverse)
        };
        let schedule = Schedule {
            most: schedule.most.min(200),
            ..schedule
        };
        let best = search(
            self.first.len(),
            schedule,
            rng,
            |sample: &[usize; 4]| fit(sample).into_iter().collect(),
            |model, i| both(model, i).into_iter().fold(0.0, f64::max) / PLANE_LIMIT,
            |model| {
                let near =
                    |&i: &usize| both(model, i).into_iter().fold(0.0, f64::max) < PLANE_LIMIT;
                fit(&(0..self.first.len()).filter(near).collect::<Vec<_>>())
            },
        );
        let count = 0..self.first.len();
        let lines = count
            .clone()
            .flat_map(|i| self.line_distances(essential, i));
        let lines: f64 = lines.map(|d| gain(d, LINE_LIMIT)).sum();
        let plane = best.map_or(0.0, |best| {
            count
                .flat_map(|i| both(&best.model, i))
                .map(|d| gain(d, PLANE_LIMIT))
                .sum()
        });
        if plane + lines > 0.0 {
            plane / (plane + lines)
        } else {
            1.0
        }
    }

    /// Squared distances to the epipolar lines in both views, in thresholds.
    fn line_distances(&self, essential: &Matrix3<f64>, i: usize) -> [f64; 2] {
        let line = essential * self.first[i];
        let back = essential.tr_mul(&self.second[i]);
        let product = self.second[i].dot(&line).powi(2) / (self.sigma * self.sigma);
        [line, back].map(|l| product / (l.x * l.x + l.y * l.y).max(f64::MIN_POSITIVE))
    }

    fn judge(
        &self,
        pose: Isometry3<f64>,
        inliers: Vec<usize>,
        homography_share: f64,
        rotation: Option<UnitQuaternion<f64>>,
        samples: usize,
        config: &TwoViewConfig,
    ) -> TwoView {
        let rotation_share = rotation.map_or(0.0, |r| self.explained_by(&r, &inliers));
        let points: Vec<_> = inliers
            .iter()
            .map(|&i| triangulate(&self.first[i], &self.second[i], &pose))
            .collect();
        let parallax = self.median_parallax(&pose, &inliers);
        let in_front = inliers
            .iter()
            .filter(|&&i| is_in_front(&pose, &self.first[i], &self.second[i]))
            .count();
        #[expect(clippy::cast_precision_loss, reason = "small counts")]
        let front_share = in_front as f64 / inliers.len() as f64;
        #[expect(clippy::cast_precision_loss, reason = "small counts")]
        let inlier_share = inliers.len() as f64 / self.first.len() as f64;
        let geometry = if rotation_share > config.rotation_share {
            Geometry::PureRotation
        } else if front_share < config.min_in_front
            || parallax < config.min_parallax
            || inlier_share < config.min_inlier_share
            || inliers.len() < config.min_confident_inliers
        {
            Geometry::Weak
        } else if homography_share > config.planar_share {
            Geometry::Planar
        } else {
            Geometry::General
        };
        let second_from_first = match (geometry, rotation) {
            (Geometry::PureRotation, Some(r)) => Isometry3::from_parts(Default::default(), r),
            _ => pose,
        };
        TwoView {
            geometry,
            second_from_first,
            inliers,
            points,
            parallax,
            homography_share,
            rotation_share,
            samples,
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    fn explained_by(&self, rotation: &UnitQuaternion<f64>, inliers: &[usize]) -> f64 {
        let matrix = rotation.to_rotation_matrix();
        let limit = 4.0 * self.sigma * self.sigma;
        let near =
            |&&i: &&usize| transfer(matrix.matrix(), &self.first[i], &self.second[i]) < limit;
        inliers.iter().filter(near).count() as f64 / inliers.len() as f64
    }

    fn median_parallax(&self, pose: &Isometry3<f64>, inliers: &[usize]) -> f64 {
        let angle = |&i: &usize| (pose.rotation * self.first[i]).angle(&self.second[i]);
        let mut angles: Vec<f64> = inliers.iter().map(angle).collect();
        angles.sort_by(f64::total_cmp);
        angles.get(angles.len() / 2).copied().unwrap_or(0.0)
    }
}

/// 95 % points of χ² with one and two degrees of freedom.
const LINE_LIMIT: f64 = 3.84;
const PLANE_LIMIT: f64 = 5.99;

fn gain(square: f64, limit: f64) -> f64 {
    if square < limit {
        PLANE_LIMIT - square
    } else {
        0.0
    }
}

/// Whether the rays meet in front of both cameras: signs of the depths, without division.
fn is_in_front(pose: &Isometry3<f64>, first: &Vector3<f64>, second: &Vector3<f64>) -> bool {
    let a = pose.rotation * first;
    let t = pose.translation.vector;
    let (aa, ab, bb) = (a.dot(&a), a.dot(second), second.dot(second));
    let (at, bt) = (a.dot(&t), second.dot(&t));
    // Least squares of λ a + t = μ b; the determinant aa bb − ab² is never negative.
    ab * bt - bb * at > 0.0 && aa * bt - ab * at > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
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
    fn a_wall_is_planar() {
        let motion = Isometry3::new(Vector3::new(0.6, 0.0, 0.2), Vector3::new(0.0, -0.1, 0.0));
        let found = estimate(&views(&motion, 200, 40, |x, y, _| 4.0 + x + 0.5 * y)).unwrap();
        assert_eq!(found.geometry, Geometry::Planar);
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
        let rng = &mut Pcg64::seed_from_u64(1);
        let config = TwoViewConfig {
            threshold: f64::NAN,
            ..Default::default()
        };
        assert!(estimate_two_view(&[], &[], &camera(), &config, rng).is_err());
    }
}
