//! The error of a triangulated point: information of its rays, and a fixed draw that shrinks with every further view.

use nalgebra::{Matrix3, Vector3};

/// Information about a point's place, collected from the rays that see it, 1/m².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Information {
    matrix: Matrix3<f64>,
    mean_ray: Vector3<f64>,
    range: f64,
    views: f64,
}

impl Information {
    /// Adds a view along `ray` (camera to point, metres) with a bearing error of `bearing_noise` rad: everything across
    /// the ray is known to `range · noise`, nothing along it.
    pub(crate) fn add_view(&mut self, ray: Vector3<f64>, bearing_noise: f64) {
        let range = ray.norm().max(1e-6);
        let direction = ray / range;
        let lateral = (range * bearing_noise).max(1e-8);
        let across = Matrix3::identity() - direction * direction.transpose();
        self.matrix += across / (lateral * lateral);
        self.mean_ray += direction;
        self.range += range;
        self.views += 1.0;
    }

    /// The error of the point, metres: the square root of the covariance times `draw` (three standard normal numbers,
    /// the same for a point for ever), and a part along the mean ray that no number of views removes.
    pub(crate) fn error(
        &self,
        draw: Vector3<f64>,
        floor_draw: f64,
        depth_floor: f64,
    ) -> Vector3<f64> {
        if self.views == 0.0 {
            return Vector3::zeros();
        }
        let range = self.range / self.views;
        let eigen = self.matrix.symmetric_eigen();
        let mut error = Vector3::zeros();
        for axis in 0..3 {
            // A ray bundle without parallax knows nothing along it: cap at the range itself.
            let deviation = eigen.eigenvalues[axis].max(0.0).sqrt().recip().min(range);
            let direction = eigen.eigenvectors.column(axis);
            error += direction * (direction.dot(&draw) * deviation);
        }
        let along = self
            .mean_ray
            .try_normalize(1e-9)
            .unwrap_or_else(Vector3::zeros);
        error + along * (floor_draw * depth_floor * range)
    }

    /// Mean viewing direction, unit length.
    pub(crate) fn viewing_direction(&self) -> Option<Vector3<f64>> {
        self.mean_ray.try_normalize(1e-9)
    }
}

/// Angle at `point` between the rays from two camera centres, rad.
pub(crate) fn parallax(point: Vector3<f64>, a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    let (a, b) = (point - a, point - b);
    a.cross(&b).norm().atan2(a.dot(&b))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Information, parallax};

    #[test]
    fn two_rays_err_along_depth_as_range_squared_over_baseline() {
        let noise = 1e-3;
        for (range, baseline) in [(2.0, 0.1), (4.0, 0.1), (4.0, 0.3)] {
            let mut information = Information::default();
            information.add_view(Vector3::new(0.5 * baseline, 0.0, range), noise);
            information.add_view(Vector3::new(-0.5 * baseline, 0.0, range), noise);
            let error = information.error(Vector3::z(), 0.0, 0.0);
            let textbook = core::f64::consts::SQRT_2 * noise * range * range / baseline;
            assert!(
                (error.z.abs() / textbook - 1.0).abs() < 0.01,
                "{error} {textbook}"
            );
            let aside = information.error(Vector3::x(), 0.0, 0.0);
            assert!(aside.norm() < 0.8 * noise * range);
        }
    }

    #[test]
    fn a_turn_on_the_spot_has_no_parallax() {
        let point = Vector3::new(3.0, 1.0, 0.0);
        assert_eq!(parallax(point, Vector3::zeros(), Vector3::zeros()), 0.0);
        let half = parallax(
            point,
            Vector3::new(0.0, 0.0, 0.1),
            Vector3::new(0.0, 0.0, -0.1),
        );
        assert!((half - 2.0 * (0.1 / 10.0_f64.sqrt()).atan()).abs() < 1e-12);
    }
}
