//! A camera with its lens, and a table that turns its images into those of an ideal camera.

use nalgebra::{Point2, Vector2};

use super::{PinholeCamera, RadialTangential};
use crate::image::{GrayImage, GrayView};

/// A pinhole with a lens in front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Focal lengths and centre.
    pub pinhole: PinholeCamera,
    /// What the lens does; all zero for none.
    pub distortion: RadialTangential,
}

impl Camera {
    /// A camera without distortion.
    #[must_use]
    pub fn ideal(pinhole: PinholeCamera) -> Self {
        Self {
            pinhole,
            distortion: RadialTangential::default(),
        }
    }

    /// The pixel that an ideal camera would show instead; `None` where the lens model cannot be inverted.
    #[must_use]
    pub fn undistort(&self, pixel: &Point2<f64>) -> Option<Point2<f64>> {
        let ray = self.pinhole.ray(pixel);
        let ideal = self.distortion.undistort(&Vector2::new(ray.x, ray.y))?;
        Some(self.to_pixel(&ideal))
    }

    /// The pixel of the real image that shows what an ideal camera shows at `pixel`.
    #[must_use]
    pub fn distort(&self, pixel: &Point2<f64>) -> Point2<f64> {
        let ray = self.pinhole.ray(pixel);
        self.to_pixel(&self.distortion.distort(&Vector2::new(ray.x, ray.y)))
    }

    fn to_pixel(self, plane: &Vector2<f64>) -> Point2<f64> {
        let k = &self.pinhole;
        Point2::new(k.fx * plane.x + k.cx, k.fy * plane.y + k.cy)
    }
}

/// Where each pixel of the ideal image lies in the real one; compute once, apply to every frame.
#[derive(Debug, Clone, PartialEq)]
pub struct UndistortionMap {
    width: usize,
    height: usize,
    sources: Vec<[f32; 2]>,
}

impl UndistortionMap {
    /// The table for images of this size. Cost: O(pixels).
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        reason = "pixel coordinates"
    )]
    pub fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let place = |index: usize| {
            let ideal = Point2::new((index % width) as f64, (index / width) as f64);
            let real = camera.distort(&ideal);
            [real.x as f32, real.y as f32]
        };
        Self {
            width,
            height,
            sources: (0..width * height).map(place).collect(),
        }
    }

    /// The ideal camera's image; pixels that the real one does not show are 0. Cost: O(pixels).
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a mean of bytes"
    )]
    pub fn apply(&self, view: &GrayView<'_>) -> GrayImage {
        let mut output = GrayImage::filled(self.width, self.height, 0);
        for (pixel, source) in output.pixels_mut().iter_mut().zip(&self.sources) {
            let value = view.bilinear(f64::from(source[0]), f64::from(source[1]));
            *pixel = value.map_or(0, |v| v.round() as u8);
        }
        output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            pinhole: PinholeCamera::new(50.0, 50.0, 31.5, 23.5).unwrap(),
            distortion: RadialTangential {
                k1: 0.2,
                k2: -0.1,
                p1: 0.01,
                ..Default::default()
            },
        }
    }

    #[test]
    fn pixels_go_there_and_back() {
        let pixel = Point2::new(10.0, 40.0);
        let back = camera().distort(&camera().undistort(&pixel).unwrap());
        assert!((back - pixel).norm() < 1e-8);
    }

    #[test]
    fn a_distorted_ramp_becomes_straight() {
        let real = (0..64 * 48).map(|index| {
            let pixel = Point2::new(f64::from(index % 64), f64::from(index / 64));
            let ideal = camera().undistort(&pixel).unwrap();
            (ideal.x * 3.0 + 20.0).clamp(0.0, 255.0) as u8
        });
        let image = GrayImage::new(real.collect(), 64, 48).unwrap();
        let straight = UndistortionMap::new(&camera(), 64, 48).apply(&image.view());
        for x in 10..54 {
            let expected = x as f64 * 3.0 + 20.0;
            assert!((f64::from(straight.view().row(20)[x]) - expected).abs() < 2.5);
        }
        let empty = UndistortionMap::new(&camera(), 0, 0).apply(&image.view());
        assert_eq!(empty.pixels().len(), 1);
    }

    #[test]
    fn no_lens_changes_nothing() {
        let image = GrayImage::new((0..=255).collect(), 16, 16).unwrap();
        let ideal = Camera::ideal(camera().pinhole);
        assert_eq!(
            UndistortionMap::new(&ideal, 16, 16).apply(&image.view()),
            image
        );
    }
}
