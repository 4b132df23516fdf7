//! What two views allow to say: weighs a pose against its rivals, a rotation and a homography.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::essential::essential_of;
use super::homography::transfer;
use super::matches::{Matches, is_in_front};
use super::rotation::fit_rotation_robustly;
use super::uncertainty::direction_deviation;
use super::{Geometry, TwoView, TwoViewConfig, triangulate};

/// Simpler explanations of the same matches.
pub(super) struct Rivals {
    pub(super) homography_share: f64,
    /// Against another direction of travel.
    pub(super) margin: f64,
    /// The rotation that most matches agree with.
    pub(super) rotation: Option<UnitQuaternion<f64>>,
}

impl Matches {
    /// Everything that is known about a pose but its kind, which is left [`Geometry::Weak`].
    pub(super) fn weigh(
        &self,
        pose: Isometry3<f64>,
        inliers: Vec<usize>,
        rivals: &Rivals,
    ) -> TwoView {
        let explained = |r| self.explained_by(&r, &inliers);
        let triangulated = |&i: &usize| triangulate(&self.first[i], &self.second[i], &pose);
        let (first, second) = self.pick(&inliers);
        let turn = fit_rotation_robustly(&first, &second).unwrap_or(pose.rotation);
        TwoView {
            geometry: Geometry::Weak,
            second_from_first: pose,
            points: inliers.iter().map(triangulated).collect(),
            parallax: median_angle(&pose.rotation, &first, &second),
            residual_parallax: median_angle(&turn, &first, &second),
            direction_sigma: self.direction_sigma(&pose),
            homography_share: rivals.homography_share,
            rotation_share: rivals.rotation.map_or(0.0, explained),
            samples: 0,
            margin: rivals.margin,
            inliers,
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    pub(super) fn geometry(&self, found: &TwoView, config: &TwoViewConfig) -> Geometry {
        let pose = &found.second_from_first;
        let in_front = |&&i: &&usize| is_in_front(pose, &self.first[i], &self.second[i]);
        let count = found.inliers.len() as f64;
        let front_share = found.inliers.iter().filter(in_front).count() as f64 / count;
        let inlier_share = count / self.first.len() as f64;
        let bent = config.residual_per_turn * pose.rotation.angle();
        let is_weak = front_share < config.min_in_front
            || inlier_share < config.min_inlier_share
            || found.inliers.len() < config.min_confident_inliers
            || found.parallax < config.min_parallax
            || found.residual_parallax < config.min_residual_parallax + bent
            || found.direction_sigma > config.max_direction_sigma
            || found.margin < config.min_margin;
        if found.rotation_share > config.rotation_share {
            Geometry::PureRotation
        } else if is_weak {
            Geometry::Weak
        } else if found.homography_share > config.planar_share {
            Geometry::Planar
        } else {
            Geometry::General
        }
    }

    /// From the matches and the loss that [`Matches::polish_pose`] minimised.
    fn direction_sigma(&self, pose: &Isometry3<f64>) -> f64 {
        let (first, second) = self.pick(&self.inliers(&essential_of(pose), 3.0));
        direction_deviation(pose, &first, &second, 0.5 * self.sigma)
    }

    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    fn explained_by(&self, rotation: &UnitQuaternion<f64>, inliers: &[usize]) -> f64 {
        let matrix = rotation.to_rotation_matrix();
        let limit = 4.0 * self.sigma * self.sigma;
        let near =
            |&&i: &&usize| transfer(matrix.matrix(), &self.first[i], &self.second[i]) < limit;
        inliers.iter().filter(near).count() as f64 / inliers.len() as f64
    }
}

fn median_angle(
    rotation: &UnitQuaternion<f64>,
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
) -> f64 {
    let angle = |(a, b): (&Vector3<f64>, &Vector3<f64>)| (rotation * a).angle(b);
    let mut angles: Vec<f64> = first.iter().zip(second).map(angle).collect();
    angles.sort_by(f64::total_cmp);
    angles.get(angles.len() / 2).copied().unwrap_or(0.0)
}
