//! Polishes a relative pose: least squares of robust Sampson distances over rotation and translation direction.

use nalgebra::{Isometry3, Matrix3, Matrix5, Translation3, UnitQuaternion, Vector3, Vector5};

use super::essential::essential_of;
use super::sampson::{sampson, sampson_with_slopes};

/// Minimises Σ log(1 + (r/σ)²) over the five degrees of freedom, starting from `start`.
///
/// Rays have z = 1; `sigma` is in their unit, positive. The translation keeps length 1. Levenberg-Marquardt with
/// at most `iterations` accepted or rejected steps; never returns a pose of higher cost than the start's.
#[must_use]
pub fn refine_relative_pose(
    start: &Isometry3<f64>,
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
    sigma: f64,
    iterations: usize,
) -> Isometry3<f64> {
    let mut pose = *start;
    let Some(direction) = pose.translation.vector.try_normalize(1e-12) else {
        return pose;
    };
    pose.translation.vector = direction;
    let mut best = cost(&pose, first, second, sigma);
    let mut damping = 1e-3;
    for _ in 0..iterations {
        let (normal, gradient, tangents) = normal_equations(&pose, first, second, sigma);
        let mut damped = normal;
        (0..5).for_each(|k| damped[(k, k)] += damping * normal[(k, k)].max(1e-12));
        let Some(cholesky) = damped.cholesky() else {
            break;
        };
        let step = -cholesky.solve(&gradient);
        let trial = moved(&pose, &step, &tangents);
        let trial_cost = cost(&trial, first, second, sigma);
        if trial_cost < best {
            let gain = (best - trial_cost) / best;
            (pose, best) = (trial, trial_cost);
            damping = (damping * 0.2).max(1e-9);
            if gain < 1e-7 {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    pose
}

fn cost(pose: &Isometry3<f64>, first: &[Vector3<f64>], second: &[Vector3<f64>], sigma: f64) -> f64 {
    let essential = essential_of(pose);
    let term = |(a, b)| {
        let r = sampson(&essential, a, b) / sigma;
        (1.0 + r * r).ln()
    };
    first.iter().zip(second).map(term).sum()
}

/// R <- Exp(w) R and t <- t + tangent step, back to length 1.
fn moved(
    pose: &Isometry3<f64>,
    step: &Vector5<f64>,
    [b1, b2]: &[Vector3<f64>; 2],
) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(step[0], step[1], step[2]));
    let direction = pose.translation.vector + b1 * step[3] + b2 * step[4];
    let direction = direction
        .try_normalize(1e-12)
        .unwrap_or(pose.translation.vector);
    Isometry3::from_parts(Translation3::from(direction), turn * pose.rotation)
}

/// Derivatives of E with respect to the three turns and the two tangent directions of t.
fn essential_slopes(pose: &Isometry3<f64>) -> ([Matrix3<f64>; 5], [Vector3<f64>; 2]) {
    let t = pose.translation.vector;
    let rotation = *pose.rotation.to_rotation_matrix().matrix();
    let least = t.iamin();
    let mut axis = Vector3::zeros();
    axis[least] = 1.0;
    let b1 = t.cross(&axis).normalize();
    let b2 = t.cross(&b1);
    let turn = |k: usize| {
        let mut axis = Vector3::zeros();
        axis[k] = 1.0;
        t.cross_matrix() * axis.cross_matrix() * rotation
    };
    let slide = |b: &Vector3<f64>| b.cross_matrix() * rotation;
    (
        [turn(0), turn(1), turn(2), slide(&b1), slide(&b2)],
        [b1, b2],
    )
}

pub(super) fn normal_equations(
    pose: &Isometry3<f64>,
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
    sigma: f64,
) -> (Matrix5<f64>, Vector5<f64>, [Vector3<f64>; 2]) {
    let essential = essential_of(pose);
    let (slopes, tangents) = essential_slopes(pose);
    let (mut normal, mut gradient) = (Matrix5::zeros(), Vector5::zeros());
    for (a, b) in first.iter().zip(second) {
        let Some((value, slopes)) = sampson_with_slopes(&essential, &slopes, a, b) else {
            continue;
        };
        let r = value / sigma;
        let weight = 1.0 / (1.0 + r * r) / (sigma * sigma);
        let row = Vector5::from(slopes);
        normal += row * row.transpose() * weight;
        gradient += row * (value * weight);
    }
    (normal, gradient, tangents)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn slopes_of_the_matrix_are_derivatives(
            axis in prop::array::uniform3(-1.0..1.0f64), shift in prop::array::uniform3(-1.0..1.0f64),
        ) {
            prop_assume!(Vector3::from(shift).norm() > 0.1);
            let pose = Isometry3::new(Vector3::from(shift).normalize(), axis.into());
            let (slopes, tangents) = essential_slopes(&pose);
            for (k, slope) in slopes.iter().enumerate() {
                let mut step = Vector5::zeros();
                step[k] = 1e-6;
                let ahead = essential_of(&moved(&pose, &step, &tangents));
                let behind = essential_of(&moved(&pose, &-step, &tangents));
                prop_assert!(((ahead - behind) / 2e-6 - slope).norm() < 1e-8);
            }
        }
    }

    proptest! {
        #[test]
        fn the_gradient_is_the_derivative_of_the_loss(
            axis in prop::array::uniform3(-0.3..0.3f64), shift in prop::array::uniform3(-1.0..1.0f64),
            x in prop::collection::vec(prop::array::uniform4(-0.5..0.5f64), 8..20),
        ) {
            prop_assume!(Vector3::from(shift).norm() > 0.1);
            let pose = Isometry3::new(Vector3::from(shift).normalize(), axis.into());
            let ray = |x: f64, y: f64| Vector3::new(x, y, 1.0);
            let first: Vec<_> = x.iter().map(|x| ray(x[0], x[1])).collect();
            let second: Vec<_> = x.iter().map(|x| ray(x[2], x[3])).collect();
            let sigma = 0.1;
            let (_, gradient, tangents) = normal_equations(&pose, &first, &second, sigma);
            for k in 0..5 {
                let mut step = Vector5::zeros();
                step[k] = 1e-6;
                let at = |step: Vector5<f64>| cost(&moved(&pose, &step, &tangents), &first, &second, sigma);
                // The normal equations leave out the factor 2 of the square.
                let numeric = (at(step) - at(-step)) / 4e-6;
                prop_assert!((numeric - gradient[k]).abs() < 1e-4 * (1.0 + gradient.norm()), "{} {}", numeric, gradient[k]);
            }
        }
    }

    #[test]
    fn a_disturbed_pose_returns() {
        let truth = Isometry3::new(Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.1, -0.2, 0.05));
        let points: Vec<Point3<f64>> = (0..40)
            .map(|k| {
                let k = f64::from(k);
                Point3::new(
                    (k * 1.7).sin() * 2.0,
                    (k * 0.9).cos() * 1.5,
                    4.0 + (k * 2.3).sin(),
                )
            })
            .collect();
        let flat = |p: Point3<f64>| p.coords / p.z;
        let first: Vec<_> = points.iter().map(|&p| flat(p)).collect();
        let second: Vec<_> = points.iter().map(|p| flat(truth * p)).collect();
        let start = Isometry3::new(Vector3::new(0.7, 0.1, 0.7), Vector3::new(0.12, -0.17, 0.03));
        let found = refine_relative_pose(&start, &first, &second, 0.002, 50);
        assert!(found.rotation.angle_to(&truth.rotation) < 1e-6);
        assert!((found.translation.vector - truth.translation.vector).norm() < 1e-5);
        let none = refine_relative_pose(&start, &[], &[], 0.002, 50);
        assert!(none.rotation.angle_to(&start.rotation) < 1e-12);
    }
}
