//! Other minima of the robust Sampson loss, and how clearly the lowest lies below them.
//!
//! When a camera turns and moves a little, a wrong direction of travel with a somewhat wrong turn explains the matches almost as well
//! as the true ones: the loss has a second minimum, often a hundred degrees away (Oliensis 2005), and a random sample of five
//! matches may end there. So refinement also starts from directions spread over the half sphere, and the lowest minimum wins.
//!
//! ```text
//! margin = Σ d / √(Σ d²)      d = ρ(match under the rival) − ρ(match under the winner)
//! ```
//!
//! The standard score of Vuong's test between two models (1989): near 0, the matches cannot tell which one is true.

use nalgebra::{Isometry3, Matrix3, Vector3};

use super::essential::essential_of;
use super::matches::Matches;
use super::refine::refine_relative_pose;
use super::sampson;

/// Directions from which refinement starts: the cube's faces and corners, one of each opposite pair.
const STARTS: [[f64; 3]; 7] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, -1.0],
];
/// Minima whose directions are nearer to each other are one.
const SAME: f64 = 0.26;
/// Most matches that the search among minima looks at; all decide in the end.
const MOST: usize = 150;

/// The lowest minimum, and how clearly it is that.
pub(super) struct Lowest {
    pub(super) pose: Isometry3<f64>,
    /// Standard score against the next minimum elsewhere; infinite where there is none.
    pub(super) margin: f64,
}

impl Matches {
    /// Looks for minima other than that of `pose`.
    pub(super) fn lowest_minimum(&self, pose: Isometry3<f64>) -> Lowest {
        let sigma = 0.5 * self.sigma;
        let step = self.first.len().div_ceil(MOST).max(1);
        let part: Vec<usize> = (0..self.first.len()).step_by(step).collect();
        let (first, second) = self.pick(&part);
        let mut minima = vec![pose];
        for start in STARTS {
            let mut trial = pose;
            trial.translation.vector = Vector3::from(start).normalize();
            let near = refine_relative_pose(&trial, &first, &second, 4.0 * sigma, 6);
            let found = refine_relative_pose(&near, &first, &second, sigma, 6);
            if minima.iter().all(|known| apart(known, &found) > SAME) {
                minima.push(found);
            }
        }
        for minimum in &mut minima[1..] {
            *minimum = refine_relative_pose(minimum, &self.first, &self.second, sigma, 10);
        }
        self.judge(&minima)
    }

    fn judge(&self, minima: &[Isometry3<f64>]) -> Lowest {
        let losses = minima.iter().map(|pose| self.losses(&essential_of(pose)));
        let losses: Vec<Vec<f64>> = losses.collect();
        let total = |k: &usize| losses[*k].iter().sum::<f64>();
        let best = (0..minima.len()).min_by(|a, b| total(a).total_cmp(&total(b)));
        let best = best.unwrap_or(0);
        let score = |k: usize| {
            let differences = losses[k].iter().zip(&losses[best]).map(|(a, b)| a - b);
            let (sum, squares) =
                differences.fold((0.0, 0.0), |(sum, squares), d| (sum + d, squares + d * d));
            if squares > 0.0 {
                sum / squares.sqrt()
            } else {
                0.0
            }
        };
        let elsewhere = |k: &usize| apart(&minima[*k], &minima[best]) > SAME;
        let margin = (0..minima.len()).filter(elsewhere).map(score);
        Lowest {
            pose: minima[best],
            margin: margin.fold(f64::INFINITY, f64::min),
        }
    }

    fn losses(&self, essential: &Matrix3<f64>) -> Vec<f64> {
        let sigma = 0.5 * self.sigma;
        let loss = |(a, b)| (sampson(essential, a, b) / sigma).powi(2).ln_1p();
        self.first.iter().zip(&self.second).map(loss).collect()
    }
}

/// Angle between two directions of travel whose signs are not known, radians.
fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    let (a, b) = (&a.translation.vector, &b.translation.vector);
    a.cross(b).norm().atan2(a.dot(b).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use rand::{RngExt, SeedableRng};

    /// Matches of a camera that sinks and turns a little before a wall with some relief: the case of a wrong twin.
    fn matches(motion: &Isometry3<f64>) -> Matches {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(4);
        let (mut first, mut second) = (Vec::new(), Vec::new());
        while first.len() < 250 {
            let mut unit = || rng.random::<f64>() - 0.5;
            let (x, y, z) = (1.1 * unit(), 0.8 * unit(), 2.0 + 0.8 * unit());
            let point = motion * Point3::new(x * z, y * z, z);
            let noise = Vector3::new(unit(), unit(), 0.0) * 2e-3;
            first.push(Vector3::new(x, y, 1.0));
            second.push(point.coords / point.z + noise);
        }
        Matches {
            first,
            second,
            sigma: 1.0 / 585.0,
        }
    }

    #[test]
    fn a_wrong_minimum_is_left_for_the_true_one() {
        let motion = Isometry3::new(
            Vector3::new(-0.05, 0.08, -0.04),
            Vector3::new(0.02, 0.01, 0.0),
        );
        let matches = matches(&motion);
        let direction = motion.translation.vector;
        let off = |pose: &Isometry3<f64>| {
            let angle = pose.translation.vector.angle(&direction).to_degrees();
            angle.min(180.0 - angle)
        };
        let mut twins = 0;
        for start in STARTS {
            let mut wrong = motion;
            wrong.translation.vector = Vector3::from(start).normalize();
            let (a, b) = (&matches.first, &matches.second);
            let stuck = refine_relative_pose(&wrong, a, b, 0.5 * matches.sigma, 50);
            twins += usize::from(off(&stuck) > 30.0);
            let found = matches.lowest_minimum(stuck);
            assert!(off(&found.pose) < 10.0, "{start:?}: {}", off(&found.pose));
            assert!(found.margin > 1.0, "{start:?}: {}", found.margin);
        }
        assert!(twins > 0, "no start ended at a wrong minimum");
    }

    #[test]
    fn a_turn_says_nothing_about_the_direction() {
        let motion = Isometry3::new(Vector3::zeros(), Vector3::new(0.03, 0.08, 0.01));
        let matches = matches(&motion);
        let mut start = motion;
        start.translation.vector = Vector3::x();
        assert!(matches.lowest_minimum(start).margin < 3.0);
    }
}
