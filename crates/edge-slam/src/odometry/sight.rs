//! What one frame shows: features, their undistorted pixels and their depths.

use nalgebra::{Point2, Point3};

use crate::camera::Camera;
use crate::depth::DepthImage;
use crate::feature::Features;

/// Features of a frame.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    pub(super) features: Features,
    /// Undistorted; NaN where the lens model cannot be inverted, so that no pose uses them.
    pub(super) pixels: Vec<Point2<f64>>,
    /// In the camera's frame, where depth is known.
    pub(super) points: Vec<Option<Point3<f64>>>,
}

impl Sight {
    pub(super) fn new(
        features: Features,
        depth: Option<&DepthImage>,
        camera: &Camera,
        farthest: f64,
    ) -> Self {
        let raw: Vec<Point2<f64>> = features
            .keypoints
            .iter()
            .map(|k| Point2::new(f64::from(k.x), f64::from(k.y)))
            .collect();
        let unseen = Point2::new(f64::NAN, f64::NAN);
        let pixels: Vec<_> = raw
            .iter()
            .map(|p| camera.undistort(p).unwrap_or(unseen))
            .collect();
        let lift = |(raw, pixel): (&Point2<f64>, &Point2<f64>)| {
            let z = depth?.bilinear(raw.x, raw.y).filter(|&z| z <= farthest)?;
            let point = Point3::from(camera.pinhole.ray(pixel) * z);
            point.iter().all(|value| value.is_finite()).then_some(point)
        };
        let points = raw.iter().zip(&pixels).map(lift).collect();
        Self {
            features,
            pixels,
            points,
        }
    }

    /// Adds another sight of the same frame.
    pub(super) fn append(&mut self, more: Self) {
        self.features.keypoints.extend(more.features.keypoints);
        self.features.descriptors.extend(more.features.descriptors);
        self.pixels.extend(more.pixels);
        self.points.extend(more.points);
    }

    /// Standard deviation of a keypoint's place, pixels: one pixel of its pyramid level.
    pub(super) fn sigma(&self, index: usize, scale_factor: f64) -> f64 {
        let octave = self.features.keypoints.get(index).map_or(0, |k| k.octave);
        scale_factor.powi(i32::from(octave))
    }
}
