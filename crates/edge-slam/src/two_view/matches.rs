//! Matched rays, and the searches for what explains them: essential matrix, homography, rotation.

use nalgebra::{Isometry3, Matrix3, UnitQuaternion, Vector3};
use rand::Rng;

use super::essential::{candidate_poses, essential_of};
use super::homography::{homography_from_points, transfer};
use super::ransac::{Best, Schedule, search};
use super::refine::refine_relative_pose;
use super::rotation::fit_rotation;
use super::{essential_from_five, sampson};

/// Matched rays (z = 1) and the inlier threshold in their unit.
pub(super) struct Matches {
    pub(super) first: Vec<Vector3<f64>>,
    pub(super) second: Vec<Vector3<f64>>,
    pub(super) sigma: f64,
}

impl Matches {
    pub(super) fn search_essential(
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

    pub(super) fn inliers(&self, model: &Matrix3<f64>, thresholds: f64) -> Vec<usize> {
        let near = |&i: &usize| {
            sampson(model, &self.first[i], &self.second[i]).abs() < thresholds * self.sigma
        };
        (0..self.first.len()).filter(near).collect()
    }

    pub(super) fn pick(&self, indices: &[usize]) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        indices
            .iter()
            .map(|&i| (self.first[i], self.second[i]))
            .unzip()
    }

    /// The candidate with most points in front of both cameras.
    pub(super) fn best_pose(&self, model: &Matrix3<f64>) -> Option<Isometry3<f64>> {
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
    pub(super) fn polish_pose(&self, mut pose: Isometry3<f64>) -> (Isometry3<f64>, Vec<usize>) {
        for _ in 0..3 {
            let (a, b) = self.pick(&self.inliers(&essential_of(&pose), 3.0));
            pose = refine_relative_pose(&pose, &a, &b, 0.5 * self.sigma, 10);
        }
        (pose, self.inliers(&essential_of(&pose), 1.0))
    }

    pub(super) fn search_rotation(
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
    pub(super) fn homography_share(
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
pub(super) fn is_in_front(
    pose: &Isometry3<f64>,
    first: &Vector3<f64>,
    second: &Vector3<f64>,
) -> bool {
    let a = pose.rotation * first;
    let t = pose.translation.vector;
    let (aa, ab, bb) = (a.dot(&a), a.dot(second), second.dot(second));
    let (at, bt) = (a.dot(&t), second.dot(&t));
    // Least squares of λ a + t = μ b; the determinant aa bb − ab² is never negative.
    ab * bt - bb * at > 0.0 && aa * bt - ab * at > 0.0
}
