//! Observations turned round: which points each camera sees, at which range, in which direction.

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
    pub(super) fn new(cloud: &Cloud, views: &'a Views) -> Option<Self> {
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
        seen.iter()
            .any(|points| !points.is_empty())
            .then_some(Self {
                views,
                cameras,
                seen,
            })
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
