//! Wrong matches: points that stand where no surface is.

use nalgebra::Vector3;
use rand::{Rng, RngExt};

use crate::random::{normal3, uniform};

/// How a wrong point went wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Outlier {
    /// On the viewing ray, at 0.12 to 0.78 or 1.2 to 2.5 times the true distance.
    AlongRay,
    /// Near other wrong points, in a small clump.
    Clump,
    /// Anywhere in front of the camera.
    Gross,
}

/// Draws wrong points; keeps where the current clump is.
#[derive(Debug, Clone, Default)]
pub(crate) struct Outliers {
    clump: Option<(Vector3<f64>, u32)>,
}

impl Outliers {
    /// With chance `rate`, the wrong place of a point that truly lies at `ray` from the camera, as a ray too, and how
    /// it went wrong.
    pub(crate) fn draw(
        &mut self,
        ray: Vector3<f64>,
        center: Vector3<f64>,
        rate: f64,
        rng: &mut impl Rng,
    ) -> Option<(Vector3<f64>, Outlier)> {
        if rng.random::<f64>() >= rate {
            return None;
        }
        let kind = rng.random::<f64>();
        Some(if kind < 0.75 {
            (ray * wrong_depth(rng), Outlier::AlongRay)
        } else if kind < 0.9 {
            (self.in_clump(ray, center, rng), Outlier::Clump)
        } else {
            let direction = (ray.normalize() + normal3(rng) * 0.2).normalize();
            (direction * uniform(rng, 0.3, 8.0), Outlier::Gross)
        })
    }

    /// A place near the current clump, which holds four to twelve points and then moves on.
    fn in_clump(
        &mut self,
        ray: Vector3<f64>,
        center: Vector3<f64>,
        rng: &mut impl Rng,
    ) -> Vector3<f64> {
        let (place, left) = match self.clump {
            Some((place, left)) if left > 0 => (place, left),
            _ => (center + ray * wrong_depth(rng), rng.random_range(4..=12)),
        };
        self.clump = Some((place, left - 1));
        place + normal3(rng) * 0.04 - center
    }
}

/// A wrong depth relative to the true one. On the kitchen map 59 % of the wrong points are too near, by factors spread
/// evenly from 0.12 to 0.78; the others are too far by 1.2 and an exponential tail.
fn wrong_depth(rng: &mut impl Rng) -> f64 {
    if rng.random::<f64>() < 0.59 {
        uniform(rng, 0.12, 0.78)
    } else {
        let tail = -0.2 * (1.0 - rng.random::<f64>()).ln();
        (1.2 + tail).min(2.5)
    }
}
