//! The frame against which others are measured.

use nalgebra::{Isometry3, Point2, Point3};

use super::sight::Sight;
use crate::camera::PinholeCamera;
use crate::feature::Match;
use crate::image::{GrayImage, Pyramid};
use crate::pnp::Observation;
use crate::two_view::{Triangulated, triangulate};

/// A frame with points in its own camera frame.
#[derive(Debug, Clone)]
pub(super) struct Keyframe {
    pub(super) sight: Sight,
    pub(super) world_from_camera: Isometry3<f64>,
    /// Index of each point in the map, where it has one.
    pub(super) in_map: Vec<Option<usize>>,
    /// Most inliers that a frame had against this keyframe.
    pub(super) most_inliers: usize,
    /// Angle under which each point was triangulated, radians; infinite where depth was measured, 0 where there is no point.
    pub(super) angles: Vec<f64>,
    /// For the alignment of matches.
    pub(super) image: Option<GrayImage>,
    /// For KLT: the image, and where each feature was seen last.
    pub(super) pyramid: Option<Pyramid>,
    pub(super) seen_at: Vec<[f64; 2]>,
}

impl Keyframe {
    pub(super) fn new(sight: Sight, world_from_camera: Isometry3<f64>) -> Self {
        let in_map = vec![None; sight.points.len()];
        let measured = |point: &Option<_>| if point.is_some() { f64::INFINITY } else { 0.0 };
        Self {
            angles: sight.points.iter().map(measured).collect(),
            image: None,
            sight,
            world_from_camera,
            in_map,
            most_inliers: 0,
            pyramid: None,
            seen_at: Vec::new(),
        }
    }

    pub(super) fn known_points(&self) -> usize {
        self.sight.points.iter().flatten().count()
    }

    /// What a frame sees of the points; the second part names the match of each observation.
    pub(super) fn observations(
        &self,
        frame: &Sight,
        matches: &[Match],
        scale_factor: f64,
    ) -> (Vec<Observation>, Vec<usize>) {
        let seen = |(index, found): (usize, &Match)| {
            let point = self.sight.points[found.first]?;
            let sigma = frame.sigma(found.second, scale_factor);
            Some((
                Observation {
                    point,
                    pixel: frame.pixels[found.second],
                    sigma,
                },
                index,
            ))
        };
        matches.iter().enumerate().filter_map(seen).unzip()
    }

    /// Matched pixels of both frames that are finite, with the match of each.
    pub(super) fn pixel_pairs(
        &self,
        frame: &Sight,
        matches: &[Match],
    ) -> (Vec<Point2<f64>>, Vec<Point2<f64>>, Vec<usize>) {
        let mut pairs = (Vec::new(), Vec::new(), Vec::new());
        for (index, found) in matches.iter().enumerate() {
            let (a, b) = (self.sight.pixels[found.first], frame.pixels[found.second]);
            if [a.x, a.y, b.x, b.y].iter().all(|value| value.is_finite()) {
                pairs.0.push(a);
                pairs.1.push(b);
                pairs.2.push(index);
            }
        }
        pairs
    }

    /// Gives the new keyframe the points of this one that it sees, and triangulates what is matched but unknown.
    ///
    /// Depth of the new frame's own sensor, where known, stays.
    pub(super) fn hand_over(
        &self,
        next: &mut Keyframe,
        matches: &[Match],
        agreeing: &[usize],
        camera: &PinholeCamera,
        least_angle: f64,
    ) {
        let next_from_this = next.world_from_camera.inv_mul(&self.world_from_camera);
        for &index in agreeing {
            let Match { first, second, .. } = matches[index];
            let Some(point) = self.sight.points[first] else {
                continue;
            };
            if next.sight.points[second].is_none() {
                next.set_point(second, next_from_this * point, self.angles[first]);
            }
            next.in_map[second] = self.in_map[first];
        }
        for Match { first, second, .. } in matches {
            if next.sight.points[*second].is_some() || self.sight.points[*first].is_some() {
                continue;
            }
            let (a, b) = (&self.sight.pixels[*first], &next.sight.pixels[*second]);
            if let Some(found) = meet(a, b, &next_from_this, camera, least_angle) {
                next.set_point(*second, next_from_this * found.point, found.angle);
            }
        }
    }

    /// Triangulates with a frame whose pose is known: what has no point yet, and again what it shows from farther aside than the frame that
    /// gave the point. Measured depth stays.
    pub(super) fn deepen(
        &mut self,
        frame: &Sight,
        matches: &[Match],
        frame_from_this: &Isometry3<f64>,
        camera: &PinholeCamera,
        least_angle: f64,
    ) {
        for Match { first, second, .. } in matches {
            let least = least_angle.max(FARTHER * self.angles[*first]);
            let (a, b) = (&self.sight.pixels[*first], &frame.pixels[*second]);
            if let Some(found) = meet(a, b, frame_from_this, camera, least) {
                self.set_point(*first, found.point, found.angle);
            }
        }
    }

    /// Gives a feature its point in this camera's frame, seen under an angle of so many radians.
    pub(super) fn set_point(&mut self, feature: usize, point: Point3<f64>, angle: f64) {
        self.sight.points[feature] = Some(point);
        self.angles[feature] = angle;
    }
}

/// A point is triangulated again under an angle so many times greater: its depth is then better by as much.
const FARTHER: f64 = 1.5;

/// What two features have in common, in the first frame, when angle and reprojection (2 pixels) are good.
fn meet(
    first: &Point2<f64>,
    second: &Point2<f64>,
    second_from_first: &Isometry3<f64>,
    camera: &PinholeCamera,
    least_angle: f64,
) -> Option<Triangulated> {
    let found = triangulate(&camera.ray(first), &camera.ray(second), second_from_first)?;
    let good = found.angle >= least_angle && found.residual * camera.mean_focal() < 2.0;
    good.then_some(found)
}
