//! How far the direction of travel may be off, errors of the camera model included.
//!
//! ```text
//! the image is cut into G = 12 parts of equal count; without part g the minimum moves by  δ_g = (H − H_g)⁻¹ g_g
//! covariance = (G − 1)/G Σ δ_g δ_gᵀ / κ²        κ = Σ ψ'(r) / Σ ψ(r)/r
//! ```
//!
//! H, g are the reweighted normal equations of the robust Sampson loss; κ makes up for H being steeper than the loss
//! (Huber 1981).
//!
//! The jackknife over groups (Shao & Tu 1995; one Newton step each). Errors of neighbouring matches depend on each other
//! (lens, rolling shutter, a moving object), which makes the inverse of H too hopeful; parts of the image that disagree
//! show it. An error that all parts share, such as a wrong focal length, stays unseen.

use nalgebra::{Isometry3, Matrix2, Matrix5, Vector3, Vector5};

use super::essential::essential_of;
use super::refine::normal_equations;
use super::sampson;

const COLUMNS: usize = 4;
const ROWS: usize = 3;

/// Standard deviation of the translation's direction along its worst axis, radians.
///
/// `pose` minimises the loss of [`refine_relative_pose`](super::refine_relative_pose) for these rays (z = 1) and this
/// `sigma`. Infinite for fewer than 24 matches, slices of different lengths, values that are not finite, and matches
/// that leave a degree of freedom open. Cost: O(n log n).
#[must_use]
pub fn direction_deviation(
    pose: &Isometry3<f64>,
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
    sigma: f64,
) -> f64 {
    let covariance = jackknife(pose, first, second, sigma);
    // Eigenvalues of what is not finite are sought without end.
    let finite = covariance.filter(|c| c.iter().all(|value| value.is_finite()));
    finite.map_or(f64::INFINITY, |covariance| {
        let square = covariance.symmetric_eigenvalues().max();
        if square.is_finite() {
            square.max(0.0).sqrt()
        } else {
            f64::INFINITY
        }
    })
}

fn jackknife(
    pose: &Isometry3<f64>,
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
    sigma: f64,
) -> Option<Matrix2<f64>> {
    if first.len() != second.len() || first.len() < 2 * COLUMNS * ROWS {
        return None;
    }
    let part = |indices: Vec<usize>| {
        let (a, b): (Vec<_>, Vec<_>) = indices.iter().map(|&i| (first[i], second[i])).unzip();
        let (normal, gradient, _) = normal_equations(pose, &a, &b, sigma);
        (normal, gradient)
    };
    let parts: Vec<(Matrix5<f64>, Vector5<f64>)> = parts_of(first).map(part).collect();
    let steepness = steepness(pose, first, second, sigma)?;
    let total: Matrix5<f64> = parts.iter().map(|(normal, _)| normal).sum();
    let mut covariance = Matrix2::zeros();
    for (normal, gradient) in &parts {
        let step = (total - normal).cholesky()?.solve(gradient);
        let slide = step.fixed_rows::<2>(3);
        covariance += slide * slide.transpose();
    }
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let count = parts.len() as f64;
    Some(covariance * ((count - 1.0) / count / steepness.powi(2)))
}

/// κ of Cauchy's loss; `None` when outliers make the loss a hill.
fn steepness(
    pose: &Isometry3<f64>,
    first: &[Vector3<f64>],
    second: &[Vector3<f64>],
    sigma: f64,
) -> Option<f64> {
    let essential = essential_of(pose);
    let (mut slopes, mut weights) = (0.0, 0.0);
    for (a, b) in first.iter().zip(second) {
        let square = (sampson(&essential, a, b) / sigma).powi(2);
        let weight = 1.0 / (1.0 + square);
        if weight > 0.0 {
            weights += weight;
            slopes += (1.0 - square) * weight * weight;
        }
    }
    let ratio = slopes / weights;
    (ratio > 0.05).then_some(ratio)
}

/// Columns of equal count, each cut into rows of equal count.
fn parts_of(rays: &[Vector3<f64>]) -> impl Iterator<Item = Vec<usize>> {
    let mut order: Vec<usize> = (0..rays.len()).collect();
    order.sort_by(|&i, &j| rays[i].x.total_cmp(&rays[j].x));
    (0..COLUMNS * ROWS).map(move |part| {
        let (column, row) = (part / ROWS, part % ROWS);
        let cut = |count: usize, k: usize, of: usize| count * k / of;
        let n = order.len();
        let mut strip = order[cut(n, column, COLUMNS)..cut(n, column + 1, COLUMNS)].to_vec();
        strip.sort_by(|&i, &j| rays[i].y.total_cmp(&rays[j].y));
        strip[cut(strip.len(), row, ROWS)..cut(strip.len(), row + 1, ROWS)].to_vec()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::two_view::refine_relative_pose;
    use nalgebra::{Point3, Vector2};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    const SIGMA: f64 = 0.001;

    /// Rays of 240 points with Gaussian noise. Points of one of 4 x 3 cells of the second view share an error as well.
    fn rays(motion: &Isometry3<f64>, shared: f64, rng: &mut Pcg64) -> [Vec<Vector3<f64>>; 2] {
        let mut unit = || rng.random::<f64>() - 0.5;
        let mut pair = || {
            let mut gauss = || (0..12).map(|_| unit()).sum::<f64>();
            Vector2::new(gauss(), gauss())
        };
        let errors: Vec<_> = (0..12).map(|_| pair() * shared).collect();
        let mut rays = [Vec::new(), Vec::new()];
        for _ in 0..240 {
            let [place, depth] = [pair(), pair()];
            let z = 3.0 + depth.x.clamp(-1.0, 1.0);
            let point = Point3::from(place.map(|x| 0.2 * x.clamp(-2.0, 2.0) * z).push(z));
            let seen = motion * point;
            rays[0].push(point.coords / z + (pair() * SIGMA).push(0.0));
            let seen = seen.coords / seen.z;
            let cell = |x: f64, n: f64| ((x + 0.4) / 0.8 * n).clamp(0.0, n - 1.0) as usize;
            let error = errors[cell(seen.x, 4.0) * 3 + cell(seen.y, 3.0)] + pair() * SIGMA;
            rays[1].push(seen + error.push(0.0));
        }
        rays
    }

    /// Means of eᵀ C⁻¹ e for the error e of the direction over many draws of the noise, for the C of the jackknife and
    /// that of the normal equations.
    fn consistency(shared: f64) -> [f64; 2] {
        let motion = Isometry3::new(Vector3::new(0.4, 0.1, 0.1), Vector3::new(0.02, -0.05, 0.01));
        let truth = motion.translation.vector.normalize();
        let rng = &mut Pcg64::seed_from_u64(3);
        let mut sums = [0.0, 0.0];
        for _ in 0..200 {
            let [first, second] = rays(&motion, shared, rng);
            let found = refine_relative_pose(&motion, &first, &second, SIGMA, 30);
            let covariance = jackknife(&found, &first, &second, SIGMA).unwrap();
            let (normal, _, [b1, b2]) = normal_equations(&found, &first, &second, SIGMA);
            let inverse = normal.try_inverse().unwrap();
            let error = truth - found.translation.vector;
            let error = Vector2::new(b1.dot(&error), b2.dot(&error));
            let square = |c: Matrix2<f64>| error.dot(&(c.try_inverse().unwrap() * error));
            sums[0] += square(covariance) / 200.0;
            sums[1] += square(inverse.fixed_view::<2, 2>(3, 3).into_owned()) / 200.0;
        }
        sums
    }

    #[test]
    fn the_deviation_is_that_of_the_errors() {
        // Hotelling's T² of two dimensions and eleven degrees of freedom has a mean of 2.75.
        let [jackknife, normal_equations] = consistency(0.0);
        assert!((2.0..4.0).contains(&jackknife), "{jackknife}");
        assert!((1.5..3.0).contains(&normal_equations));
        // Errors that neighbours share: only the jackknife sees them.
        let [jackknife, normal_equations] = consistency(3.0 * SIGMA);
        assert!((1.5..5.0).contains(&jackknife), "{jackknife}");
        assert!(normal_equations > 8.0, "{normal_equations}");
    }

    #[test]
    fn an_open_direction_is_infinitely_uncertain() {
        let motion = Isometry3::new(Vector3::x(), Vector3::zeros());
        let deviation = |first: &[Vector3<f64>], second: &[Vector3<f64>]| {
            direction_deviation(&motion, first, second, SIGMA)
        };
        let rng = &mut Pcg64::seed_from_u64(4);
        let [first, second] = rays(&motion, 0.0, rng);
        assert!(deviation(&first, &second).is_finite());
        assert!(deviation(&first[..23], &second[..23]).is_infinite());
        assert!(deviation(&first, &second[1..]).is_infinite());
        assert!(deviation(&[Vector3::z(); 50], &[Vector3::z(); 50]).is_infinite());
        let nan = vec![Vector3::from_element(f64::NAN); 50];
        assert!(deviation(&nan, &nan).is_infinite());
    }
}
