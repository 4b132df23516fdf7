//! Observations turned round: which points each camera sees, at which range, in which direction.

use super::error::OutlierError;
use crate::points::{Cloud, median, scaled, squared_distance};
use crate::views::Views;

/// Cameras in the cloud's scaled units, with the points each of them sees.
pub(super) struct Sight<'a> {
    pub(super) views: &'a Views,
    pub(super) cameras: Vec<[f64; 3]>,
    pub(super) seen: Vec<Vec<u32>>,
}

impl<'a> Sight<'a> {
    /// `None` when no point has an observer.
    pub(super) fn new(cloud: &Cloud, views: &'a Views) -> Result<Option<Self>, OutlierError> {
        let cameras: Vec<[f64; 3]> = views
            .viewpoints()
            .iter()
            .map(|&c| scaled(c, cloud.unit))
            .collect();
        let mut seen = vec![Vec::new(); cameras.len()];
        for v in 0..cloud.len() {
            for &camera in views.row(v) {
                seen[camera as usize].push(v as u32);
            }
        }
        for (viewpoint, camera) in cameras.iter().enumerate() {
            let times = camera.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            if times > FARTHEST && !seen[viewpoint].is_empty() {
                return Err(OutlierError::FarCamera { viewpoint, times });
            }
        }
        let any = seen.iter().any(|points| !points.is_empty());
        Ok(any.then_some(Self {
            views,
            cameras,
            seen,
        }))
    }

    /// The median distance to the observing cameras; NaN for a point without any.
    pub(super) fn range(&self, cloud: &Cloud, v: usize) -> f64 {
        let mut distances: Vec<f64> = (self.views.row(v).iter())
            .map(|&c| squared_distance(cloud.points[v], self.cameras[c as usize]).sqrt())
            .collect();
        if distances.is_empty() {
            f64::NAN
        } else {
            median(&mut distances)
        }
    }

    /// The angle that the directions from which a point is seen span, as twice the largest from their mean,
    /// radians; 0 with fewer than two observers.
    pub(super) fn parallax(&self, cloud: &Cloud, v: usize) -> f64 {
        let row = self.views.row(v);
        if row.len() < 2 {
            return 0.0;
        }
        let direction = |&camera: &u32| self.bearing(cloud, camera as usize, v).0;
        let mut mean = [0.0; 3];
        for [x, y, z] in row.iter().map(direction) {
            mean = [mean[0] + x, mean[1] + y, mean[2] + z];
        }
        let length = squared_distance(mean, [0.0; 3]).sqrt();
        if length <= 0.0 {
            return core::f64::consts::PI;
        }
        let mean = mean.map(|x| x / length);
        let farthest = (row.iter().map(direction))
            .map(|d| squared_distance(d, mean))
            .fold(0.0, f64::max);
        4.0 * (farthest.sqrt() / 2.0).min(1.0).asin()
    }

    /// Unit direction and distance from a camera; the direction is zero for a point at the camera.
    pub(super) fn bearing(&self, cloud: &Cloud, camera: usize, v: usize) -> ([f64; 3], f64) {
        let (c, p) = (self.cameras[camera], cloud.points[v]);
        let range = squared_distance(p, c).sqrt();
        let scale = if range > 0.0 { 1.0 / range } else { 0.0 };
        (
            [
                (p[0] - c[0]) * scale,
                (p[1] - c[1]) * scale,
                (p[2] - c[2]) * scale,
            ],
            range,
        )
    }
}

/// Squares of distances to cameras farther away, in sizes of the cloud, could overflow.
const FARTHEST: f64 = 1e100;
