//! Uniform samples of the ellipsoid of points that can still lie on a shorter path.
//!
//! A path of length c from focus to focus stays inside { x : |x − start| + |x − goal| ≤ c }. A sample of the unit ball is
//! stretched to the half axes c/2 and √(c² − |start goal|²)/2 and mirrored onto the line of the foci (a Householder
//! reflection: the ball has no handedness, so no rotation matrix is needed).
//!
//! Reference: Gammell, Srinivasa, Barfoot, "Informed RRT*", IROS 2014, arXiv 1404.2334, Algorithm 2.

use rand::{Rng, RngExt};

use crate::bounds::Bounds;
use crate::euclid::distance;

/// Draws of the ellipsoid that may miss the bounds before the bounds are sampled instead.
const TRIES: usize = 32;

/// A point of the bounds inside the ellipsoid with the given foci and path length `longest`, nearly always: where the two
/// hardly meet, it is any point of the bounds.
pub(crate) fn sample_ellipsoid<const D: usize>(
    start: &[f64; D],
    goal: &[f64; D],
    longest: f64,
    bounds: &Bounds<D>,
    rng: &mut impl Rng,
) -> [f64; D] {
    let gap = distance(start, goal);
    let along = longest / 2.0;
    let across = (longest * longest - gap * gap).max(0.0).sqrt() / 2.0;
    for _ in 0..TRIES {
        let mut point = unit_ball(rng);
        for (axis, value) in point.iter_mut().enumerate() {
            *value *= if axis == 0 { along } else { across };
        }
        if gap > 0.0 {
            mirror_onto(&mut point, start, goal, gap);
        }
        for (axis, value) in point.iter_mut().enumerate() {
            *value += (start[axis] + goal[axis]) / 2.0;
        }
        if bounds.contains(&point) {
            return point;
        }
    }
    bounds.sample(rng)
}

/// Reflects space so that the first axis falls onto the direction from `start` to `goal`.
fn mirror_onto<const D: usize>(point: &mut [f64; D], start: &[f64; D], goal: &[f64; D], gap: f64) {
    // The reflection's normal is e1 − direction.
    let normal: [f64; D] = std::array::from_fn(|axis| {
        let direction = (goal[axis] - start[axis]) / gap;
        if axis == 0 {
            1.0 - direction
        } else {
            -direction
        }
    });
    let squared: f64 = normal.iter().map(|value| value * value).sum();
    if squared < f64::EPSILON {
        return;
    }
    let dot: f64 = normal.iter().zip(point.iter()).map(|(n, p)| n * p).sum();
    for (value, n) in point.iter_mut().zip(normal) {
        *value -= 2.0 * dot / squared * n;
    }
}

/// A uniform point of the unit ball: a direction of normal deviates, a radius u^(1/D).
fn unit_ball<const D: usize>(rng: &mut impl Rng) -> [f64; D] {
    let direction: [f64; D] = std::array::from_fn(|_| normal_deviate(rng));
    let norm = distance(&direction, &[0.0; D]);
    let radius = rng.random::<f64>().powf(1.0 / D.max(1) as f64);
    if norm > 0.0 {
        direction.map(|value| value * radius / norm)
    } else {
        direction
    }
}

/// Box and Muller 1958.
fn normal_deviate(rng: &mut impl Rng) -> f64 {
    let (u, v): (f64, f64) = (rng.random(), rng.random());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg64;

    use super::*;

    #[test]
    fn samples_lie_inside_and_fill_the_ellipsoid() -> Result<(), crate::BoundsError> {
        let bounds = Bounds::new([-10.0; 3], [10.0; 3])?;
        let (start, goal, longest) = ([-1.0, 0.5, 2.0], [1.0, 2.0, 0.5], 4.0);
        let mut rng = Pcg64::new(3, 3);
        let (mut inner, mut mean) = (0, [0.0; 3]);
        for _ in 0..4000 {
            let point = sample_ellipsoid(&start, &goal, longest, &bounds, &mut rng);
            let way = distance(&start, &point) + distance(&point, &goal);
            assert!(way <= longest + 1e-9, "{way}");
            for axis in 0..3 {
                mean[axis] += (point[axis] - (start[axis] + goal[axis]) / 2.0) / 4000.0;
            }
            // Volume goes with (c² − gap²) c, so this share is known.
            inner += usize::from(way <= 3.5);
        }
        let gap = distance(&start, &goal);
        let volume = |c: f64| c * (c * c - gap * gap);
        let expected = volume(3.5) / volume(longest);
        assert!((f64::from(inner as u32) / 4000.0 - expected).abs() < 0.03);
        assert!(mean.iter().all(|value| value.abs() < 0.05), "{mean:?}");
        Ok(())
    }

    #[test]
    fn degenerate_ellipsoids_are_sampled_too() -> Result<(), crate::BoundsError> {
        let bounds = Bounds::new([0.0; 2], [1.0; 2])?;
        let mut rng = Pcg64::new(4, 4);
        let segment = sample_ellipsoid(&[0.2, 0.5], &[0.8, 0.5], 0.6, &bounds, &mut rng);
        assert!((segment[1] - 0.5).abs() < 1e-12);
        let circle = sample_ellipsoid(&[0.5; 2], &[0.5; 2], 0.2, &bounds, &mut rng);
        assert!(distance(&circle, &[0.5; 2]) <= 0.1 + 1e-12);
        Ok(())
    }
}
