//! A point from two rays, with its covariance.

use nalgebra::{Isometry3, Matrix2x3, Matrix3, Point3, Vector2, Vector3};

/// A triangulated point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangulated {
    /// In the first camera's frame, in units of the translation.
    pub point: Point3<f64>,
    /// Angle between the two rays, radians: the smaller, the less certain the depth.
    pub angle: f64,
    /// Covariance of the point when each ray coordinate has variance 1 (multiply by (σ pixels / focal)²).
    pub covariance: Matrix3<f64>,
    /// Root mean square of the four reprojection residuals on the planes z = 1.
    pub residual: f64,
}

/// Intersects two rays (z = 1): nearest point of both, then two Gauss-Newton steps on the reprojection error.
///
/// `None` when the rays are parallel within 1e-5 radians, or the point lies behind a camera or at infinity.
///
/// ```
/// use edge_slam::nalgebra::{Isometry3, Vector3};
/// use edge_slam::two_view::triangulate;
/// let motion = Isometry3::translation(-0.5, 0.0, 0.0); // the second camera stands half a unit to the right
/// let found = triangulate(&Vector3::new(0.0, 0.0, 1.0), &Vector3::new(-0.1, 0.0, 1.0), &motion);
/// assert!(found.is_some_and(|found| (found.point.z - 5.0).abs() < 1e-9));
/// ```
#[must_use]
pub fn triangulate(
    first: &Vector3<f64>,
    second: &Vector3<f64>,
    second_from_first: &Isometry3<f64>,
) -> Option<Triangulated> {
    let a = first.try_normalize(0.0)?;
    let b = second_from_first
        .rotation
        .inverse_transform_vector(&second.try_normalize(0.0)?);
    let centre = second_from_first
        .inverse_transform_point(&Point3::origin())
        .coords;
    let cosine = a.dot(&b);
    let angle = a.cross(&b).norm().atan2(cosine);
    let sine_square = 1.0 - cosine * cosine;
    if !(sine_square > 1e-10) {
        return None;
    }
    let along = (centre.dot(&a) - centre.dot(&b) * cosine) / sine_square;
    let other = (centre.dot(&a) * cosine - centre.dot(&b)) / sine_square;
    let mut point = Point3::from((a * along + centre + b * other) * 0.5);
    for _ in 0..2 {
        let (normal, gradient, _) = normal_equations(&point, first, second, second_from_first)?;
        point -= normal.try_inverse()? * gradient;
    }
    let (normal, _, square) = normal_equations(&point, first, second, second_from_first)?;
    let covariance = normal.try_inverse()?;
    let residual = (0.25 * square).sqrt();
    residual.is_finite().then_some(Triangulated {
        point,
        angle,
        covariance,
        residual,
    })
}

type Equations = (Matrix3<f64>, Vector3<f64>, f64);

fn normal_equations(
    point: &Point3<f64>,
    first: &Vector3<f64>,
    second: &Vector3<f64>,
    motion: &Isometry3<f64>,
) -> Option<Equations> {
    let rotation = motion.rotation.to_rotation_matrix();
    let (r, j) = residual(point, first)?;
    let (s, k) = residual(&(motion * point), second)?;
    let k = k * rotation.matrix();
    Some((
        j.tr_mul(&j) + k.tr_mul(&k),
        j.tr_mul(&r) + k.tr_mul(&s),
        r.norm_squared() + s.norm_squared(),
    ))
}

/// Difference on the plane z = 1 and its derivative by the point.
fn residual(point: &Point3<f64>, ray: &Vector3<f64>) -> Option<(Vector2<f64>, Matrix2x3<f64>)> {
    if !(point.z > 1e-9) {
        return None;
    }
    let i = 1.0 / point.z;
    let (x, y) = (point.x * i, point.y * i);
    let difference = Vector2::new(x - ray.x / ray.z, y - ray.y / ray.z);
    Some((difference, Matrix2x3::new(i, 0.0, -x * i, 0.0, i, -y * i)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn exact_rays_meet(
            x in -2.0..2.0f64, y in -2.0..2.0f64, z in 2.0..9.0f64,
            shift in prop::array::uniform2(-1.0..1.0f64), turn in prop::array::uniform3(-0.2..0.2f64),
        ) {
            prop_assume!(shift[0].hypot(shift[1]) > 0.2);
            let motion = Isometry3::new(Vector3::new(shift[0], shift[1], 0.0), turn.into());
            let point = Point3::new(x, y, z);
            let seen = motion * point;
            let found = triangulate(&(point.coords / z), &(seen.coords / seen.z), &motion).unwrap();
            prop_assert!((found.point - point).norm() < 1e-6 * z);
            prop_assert!(found.residual < 1e-9);
            prop_assert!(found.covariance.symmetric_eigenvalues().min() > 0.0);
        }
    }

    proptest! {
        #[test]
        fn slopes_are_the_derivatives(
            p in prop::array::uniform3(-1.0..1.0f64), ray in prop::array::uniform2(-0.6..0.6f64),
        ) {
            let (point, ray) = (Point3::new(p[0], p[1], 3.0 + p[2]), Vector3::new(2.0 * ray[0], 2.0 * ray[1], 2.0));
            let (_, slope) = residual(&point, &ray).unwrap();
            for k in 0..3 {
                let mut step = Vector3::zeros();
                step[k] = 1e-6;
                let ahead = residual(&(point + step), &ray).unwrap().0;
                let behind = residual(&(point - step), &ray).unwrap().0;
                prop_assert!(((ahead - behind) / 2e-6 - slope.column(k)).norm() < 1e-8);
            }
        }

        #[test]
        fn the_gradient_of_both_views_is_the_derivative(
            p in prop::array::uniform3(-1.0..1.0f64), x in prop::array::uniform4(-0.4..0.4f64),
            shift in prop::array::uniform3(-0.5..0.5f64), turn in prop::array::uniform3(-0.3..0.3f64),
        ) {
            // The second view's slope is chained with the rotation, so half of this would be wrong without it.
            let point = Point3::new(p[0], p[1], 4.0 + p[2]);
            let [first, second] = [[x[0], x[1]], [x[2], x[3]]].map(|[x, y]| Vector3::new(x, y, 1.0));
            let motion = Isometry3::new(shift.into(), turn.into());
            let at = |point: &Point3<f64>| normal_equations(point, &first, &second, &motion).unwrap();
            let (normal, gradient, _) = at(&point);
            let eyes = |point: &Point3<f64>| {
                let (a, b) = (residual(point, &first).unwrap().0, residual(&(motion * point), &second).unwrap().0);
                nalgebra::Vector4::new(a.x, a.y, b.x, b.y)
            };
            let mut slopes = nalgebra::Matrix4x3::zeros();
            for k in 0..3 {
                let mut step = Vector3::zeros();
                step[k] = 1e-6;
                let (ahead, behind) = (point + step, point - step);
                // Half the derivative of the sum of squares.
                prop_assert!(((at(&ahead).2 - at(&behind).2) / 4e-6 - gradient[k]).abs() < 1e-8);
                slopes.set_column(k, &((eyes(&ahead) - eyes(&behind)) / 2e-6));
            }
            prop_assert!((slopes.tr_mul(&slopes) - normal).norm() < 1e-8);
        }

        #[test]
        fn the_covariance_is_that_of_the_derivative_by_the_rays(
            p in prop::array::uniform3(-1.0..1.0f64), turn in prop::array::uniform3(-0.2..0.2f64),
        ) {
            let (point, motion) = (Point3::new(p[0], p[1], 4.0 + p[2]), Isometry3::new(Vector3::new(0.8, 0.1, 0.2), turn.into()));
            let seen = motion * point;
            let rays = [point.coords / point.z, seen.coords / seen.z];
            let found = triangulate(&rays[0], &rays[1], &motion).unwrap();
            let mut numeric = Matrix3::zeros();
            for k in 0..4 {
                let moved = |by: f64| {
                    let mut rays = rays;
                    rays[k / 2][k % 2] += by;
                    triangulate(&rays[0], &rays[1], &motion).unwrap().point
                };
                let slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                numeric += slope * slope.transpose();
            }
            prop_assert!((numeric - found.covariance).norm() < 1e-4 * found.covariance.norm());
        }
    }

    #[test]
    fn the_covariance_predicts_the_scatter() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        let motion = Isometry3::translation(-0.5, 0.0, 0.0);
        let point = Point3::new(0.2, 0.1, 4.0);
        let clean = [point.coords / 4.0, (motion * point).coords / 4.0];
        let truth = triangulate(&clean[0], &clean[1], &motion).unwrap();
        let sigma = 0.001;
        let (mut sum, n) = (0.0, 4000);
        for _ in 0..n {
            // Uniform noise of standard deviation sigma.
            let mut noise = || (rng.random::<f64>() - 0.5) * sigma * 12_f64.sqrt();
            let mut rays = clean;
            for ray in &mut rays {
                ray.x += noise();
                ray.y += noise();
            }
            let found = triangulate(&rays[0], &rays[1], &motion).unwrap();
            sum += (found.point.z - 4.0).powi(2);
        }
        let expected = truth.covariance[(2, 2)] * sigma * sigma;
        assert!((sum / f64::from(n) / expected - 1.0).abs() < 0.1);
    }

    #[test]
    fn parallel_and_backward_rays_do_not_meet() {
        let motion = Isometry3::translation(-0.5, 0.0, 0.0);
        let ahead = Vector3::new(0.0, 0.0, 1.0);
        assert!(triangulate(&ahead, &ahead, &motion).is_none());
        assert!(triangulate(&ahead, &Vector3::new(0.1, 0.0, 1.0), &motion).is_none());
        assert!(triangulate(&ahead, &Vector3::new(f64::NAN, 0.0, 1.0), &motion).is_none());
    }
}
