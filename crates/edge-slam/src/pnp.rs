//! Pose of a camera from points it sees, refined from a guess (perspective-n-point).
//!
//! ```text
//! minimise over T   Σᵢ ρ( ‖π(T Xᵢ) − uᵢ‖² / σᵢ² )      ρ Huber, left update T ← (Exp(ω), v) T
//! ∂π/∂[v, ω] = J_π [ I | −p̂ ]                          p = T X
//! ```

use nalgebra::{
    Isometry3, Matrix2x6, Matrix6, Point2, Point3, Translation3, UnitQuaternion, Vector3, Vector6,
};

use crate::camera::PinholeCamera;

/// A map point and the pixel that shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// World frame.
    pub point: Point3<f64>,
    /// Undistorted pixel.
    pub pixel: Point2<f64>,
    /// Standard deviation of the pixel, pixels, positive: 1.2^octave for ORB.
    pub sigma: f64,
}

/// Parameters of [`refine_pose`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PnpConfig {
    /// Residual, in σ, beyond which the loss is linear, > 0. Default 2.45 (χ² 5.99 at two degrees of freedom).
    pub huber: f64,
    /// Residual, in σ, up to which an observation is an inlier, > 0. Default 2.45.
    pub inlier: f64,
    /// Most steps, in two rounds, the second without outliers. Default 20.
    pub iterations: usize,
    /// Fewest observations in front of the camera, and fewest inliers at the end, >= 4. Default 10.
    pub min_inliers: usize,
}

impl Default for PnpConfig {
    fn default() -> Self {
        Self {
            huber: 2.45,
            inlier: 2.45,
            iterations: 20,
            min_inliers: 10,
        }
    }
}

impl PnpConfig {
    /// Errs at the first field outside its range.
    ///
    /// # Errors
    /// [`PnpError::Parameter`].
    #[expect(clippy::cast_precision_loss, reason = "only shown in a message")]
    pub fn validate(&self) -> Result<(), PnpError> {
        let fewest = self.min_inliers as f64;
        let fields = [
            ("huber", self.huber, self.huber > 0.0, "positive"),
            ("inlier", self.inlier, self.inlier > 0.0, "positive"),
            ("min_inliers", fewest, self.min_inliers >= 4, "at least 4"),
        ];
        match fields.into_iter().find(|field| !field.2) {
            Some((name, value, _, range)) => Err(PnpError::Parameter { name, value, range }),
            None => Ok(()),
        }
    }
}

/// Why a pose was not refined.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PnpError {
    /// Not enough observations agree with one pose.
    #[error("{inliers} of {observations} observations agree with a pose, {needed} are needed")]
    TooFewInliers {
        /// Observations that agree.
        inliers: usize,
        /// Observations handed in.
        observations: usize,
        /// Observations needed.
        needed: usize,
    },
    /// The observations do not determine all six degrees of freedom.
    #[error("the observations do not determine the pose: all points lie on a line or in one place")]
    Singular,
    /// A parameter is outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Parameter {
        /// Field of the configuration.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
}

/// A refined pose.
#[derive(Debug, Clone, PartialEq)]
pub struct PnpPose {
    /// Takes world points to the camera.
    pub camera_from_world: Isometry3<f64>,
    /// Covariance of the left update [v, ω], from the inliers.
    pub covariance: Matrix6<f64>,
    /// Indices of the observations that agree, ascending.
    pub inliers: Vec<usize>,
    /// Root mean square residual of the inliers, in σ.
    pub rms: f64,
}

/// Refines a pose by Levenberg-Marquardt with Huber's loss, drops outliers half way, and tells its covariance.
///
/// Observations with a coordinate that is not finite or a σ that is not positive are outliers.
/// Cost: O(observations · iterations).
///
/// # Errors
/// [`PnpError`] when a parameter is outside its range, too few observations lie in front of the camera at the guess or agree at the
/// end, or they leave a degree of freedom open.
///
/// ```
/// use edge_slam::camera::PinholeCamera;
/// use edge_slam::nalgebra::{Isometry3, Point3, Vector3};
/// use edge_slam::pnp::{Observation, PnpConfig, refine_pose};
/// let camera = PinholeCamera::new(500.0, 500.0, 320.0, 240.0)?;
/// let truth = Isometry3::new(Vector3::new(0.1, 0.0, 0.2), Vector3::new(0.0, 0.1, 0.0));
/// let seen = |k: u32| {
///     let point = Point3::new(f64::from(k % 4) - 1.5, f64::from(k / 4) - 1.5, 4.0 + f64::from(k % 3));
///     let pixel = camera.project(&(truth * point))?;
///     Some(Observation { point, pixel, sigma: 1.0 })
/// };
/// let observations: Vec<_> = (0..16).filter_map(seen).collect();
/// let found = refine_pose(&observations, &camera, &Isometry3::identity(), &PnpConfig::default())?;
/// assert!((found.camera_from_world.translation.vector - truth.translation.vector).norm() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn refine_pose(
    observations: &[Observation],
    camera: &PinholeCamera,
    guess: &Isometry3<f64>,
    config: &PnpConfig,
) -> Result<PnpPose, PnpError> {
    config.validate()?;
    let problem = Problem {
        observations,
        camera,
        huber: config.huber,
    };
    let enough = |inliers: usize| match inliers >= config.min_inliers {
        true => Ok(()),
        false => Err(PnpError::TooFewInliers {
            inliers,
            observations: observations.len(),
            needed: config.min_inliers,
        }),
    };
    let usable = |&i: &usize| {
        let o = &observations[i];
        let finite = o
            .point
            .iter()
            .chain(o.pixel.iter())
            .all(|value| value.is_finite());
        finite && o.sigma > 0.0 && o.sigma.is_finite()
    };
    let all: Vec<usize> = (0..observations.len()).filter(usable).collect();
    enough(problem.inliers(guess, &all, f64::INFINITY).len())?;
    let rounds = config.iterations.div_ceil(2);
    let coarse = problem.minimise(guess, &all, rounds)?;
    let inliers = problem.inliers(&coarse, &all, 2.0 * config.inlier);
    let pose = problem.minimise(&coarse, &inliers, rounds)?;
    let inliers = problem.inliers(&pose, &all, config.inlier);
    enough(inliers.len())?;
    let (normal, _, square) = problem.normal_equations(&pose, &inliers);
    let covariance = normal.try_inverse();
    let determined = covariance.filter(|_| problem.is_determined(&pose, &inliers));
    let covariance = determined.ok_or(PnpError::Singular)?;
    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    let rms = (square / inliers.len() as f64).sqrt();
    Ok(PnpPose {
        camera_from_world: pose,
        covariance,
        inliers,
        rms,
    })
}

/// T <- (Exp(ω), v) T for a step [v, ω].
fn moved(pose: &Isometry3<f64>, step: &Vector6<f64>) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(step[3], step[4], step[5]));
    Isometry3::from_parts(Translation3::new(step[0], step[1], step[2]), turn) * pose
}

struct Problem<'a> {
    observations: &'a [Observation],
    camera: &'a PinholeCamera,
    huber: f64,
}

impl Problem<'_> {
    /// Residual over σ, and its Jacobian by [v, ω].
    fn residual(
        &self,
        pose: &Isometry3<f64>,
        index: usize,
    ) -> Option<(nalgebra::Vector2<f64>, Matrix2x6<f64>)> {
        let o = &self.observations[index];
        let p = pose * o.point;
        let residual = (self.camera.project(&p)? - o.pixel) / o.sigma;
        let by_point = self.camera.jacobian(&p) / o.sigma;
        let mut jacobian = Matrix2x6::zeros();
        jacobian.fixed_columns_mut::<3>(0).copy_from(&by_point);
        jacobian
            .fixed_columns_mut::<3>(3)
            .copy_from(&(-by_point * p.coords.cross_matrix()));
        Some((residual, jacobian))
    }

    fn minimise(
        &self,
        start: &Isometry3<f64>,
        chosen: &[usize],
        iterations: usize,
    ) -> Result<Isometry3<f64>, PnpError> {
        let mut pose = *start;
        let mut damping = 1e-4;
        let mut cost = self.cost(&pose, chosen);
        for _ in 0..iterations {
            let (normal, gradient, _) = self.normal_equations(&pose, chosen);
            let mut damped = normal;
            (0..6).for_each(|k| damped[(k, k)] *= 1.0 + damping);
            let step = -damped
                .cholesky()
                .ok_or(PnpError::Singular)?
                .solve(&gradient);
            let trial = moved(&pose, &step);
            let trial_cost = self.cost(&trial, chosen);
            if trial_cost <= cost {
                let gain = cost - trial_cost;
                (pose, cost) = (trial, trial_cost);
                damping = (damping * 0.2).max(1e-9);
                if gain <= 1e-9 * cost || step.norm() < 1e-9 {
                    break;
                }
            } else {
                damping *= 10.0;
            }
        }
        pose.rotation.renormalize();
        Ok(pose)
    }

    /// Huber's loss; a point behind the camera costs as much as one that is 100 σ off.
    fn cost(&self, pose: &Isometry3<f64>, chosen: &[usize]) -> f64 {
        let loss = |&i: &usize| {
            let r = self
                .residual(pose, i)
                .map_or(100.0, |(residual, _)| residual.norm());
            if r <= self.huber {
                0.5 * r * r
            } else {
                self.huber * (r - 0.5 * self.huber)
            }
        };
        chosen.iter().map(loss).sum()
    }

    fn normal_equations(
        &self,
        pose: &Isometry3<f64>,
        chosen: &[usize],
    ) -> (Matrix6<f64>, Vector6<f64>, f64) {
        let (mut normal, mut gradient, mut square) = (Matrix6::zeros(), Vector6::zeros(), 0.0);
        for &index in chosen {
            let Some((residual, jacobian)) = self.residual(pose, index) else {
                continue;
            };
            let r = residual.norm();
            let weight = if r <= self.huber { 1.0 } else { self.huber / r };
            normal += jacobian.tr_mul(&jacobian) * weight;
            gradient += jacobian.tr_mul(&residual) * weight;
            square += r * r;
        }
        (normal, gradient, square)
    }

    /// Whether the observations fix all six degrees of freedom by more than rounding: points on a line leave the turn about it open.
    /// Each counts the same, or one that is very near would hide what the others say.
    fn is_determined(&self, pose: &Isometry3<f64>, chosen: &[usize]) -> bool {
        let mut normal = Matrix6::zeros();
        for &index in chosen {
            if let Some((_, jacobian)) = self.residual(pose, index) {
                let unit = jacobian / jacobian.norm();
                normal += unit.tr_mul(&unit);
            }
        }
        let unit = normal.diagonal().map(f64::sqrt);
        let scaled = normal.component_div(&(unit * unit.transpose()));
        // Eigenvalues of what is not finite are sought without end.
        scaled.iter().all(|value| value.is_finite()) && scaled.symmetric_eigenvalues().min() > 1e-12
    }

    fn inliers(&self, pose: &Isometry3<f64>, all: &[usize], limit: f64) -> Vec<usize> {
        let near = |&i: &usize| {
            self.residual(pose, i)
                .is_some_and(|(r, _)| r.norm() <= limit)
        };
        all.iter().copied().filter(near).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};

    fn camera() -> PinholeCamera {
        PinholeCamera::new(500.0, 500.0, 320.0, 240.0).unwrap()
    }

    fn scene(truth: &Isometry3<f64>, outliers: usize) -> Vec<Observation> {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(11);
        let mut unit = || rng.random::<f64>() - 0.5;
        (0..100)
            .map(|k| {
                let p = Point3::new(3.0 * unit(), 2.0 * unit(), 4.0 + 2.0 * unit());
                let mut pixel = camera().project(&p).unwrap();
                pixel += nalgebra::Vector2::new(unit(), unit());
                if k < outliers {
                    pixel = Point2::new(320.0 + 600.0 * unit(), 240.0 + 400.0 * unit());
                }
                Observation {
                    point: truth.inverse() * p,
                    pixel,
                    sigma: 1.0,
                }
            })
            .collect()
    }

    #[test]
    fn a_disturbed_pose_returns_despite_outliers() {
        let truth = Isometry3::new(Vector3::new(0.3, -0.2, 0.5), Vector3::new(0.1, 0.7, -0.2));
        let guess = moved(&truth, &Vector6::new(0.1, -0.1, 0.1, 0.05, -0.05, 0.05));
        let found =
            refine_pose(&scene(&truth, 30), &camera(), &guess, &PnpConfig::default()).unwrap();
        let error = found.camera_from_world * truth.inverse();
        assert!(error.translation.vector.norm() < 0.01 && error.rotation.angle() < 0.003);
        assert!(found.inliers.len() >= 69 && found.rms < 1.0);
        assert!(found.covariance.symmetric_eigenvalues().min() > 0.0);
    }

    #[test]
    fn nonsense_is_an_error() {
        let config = PnpConfig::default();
        let identity = Isometry3::identity();
        assert!(refine_pose(&[], &camera(), &identity, &config).is_err());
        let same = Observation {
            point: Point3::new(0.0, 0.0, 2.0),
            pixel: Point2::new(320.0, 240.0),
            sigma: 1.0,
        };
        assert!(refine_pose(&[same; 50], &camera(), &identity, &config).is_err());
        let nan = Observation {
            point: Point3::new(f64::NAN, 0.0, 2.0),
            ..same
        };
        assert!(refine_pose(&[nan; 50], &camera(), &identity, &config).is_err());
    }

    #[test]
    fn points_on_a_line_leave_a_turn_open() {
        let truth = Isometry3::new(Vector3::new(0.1, 0.2, 0.0), Vector3::new(0.0, 0.1, 0.05));
        let seen = |point: Point3<f64>| Observation {
            point,
            pixel: camera().project(&(truth * point)).unwrap(),
            sigma: 1.0,
        };
        let run = |points: &[Point3<f64>]| {
            let observations: Vec<_> = points.iter().map(|&point| seen(point)).collect();
            let guess = moved(&truth, &Vector6::from_element(0.01));
            refine_pose(&observations, &camera(), &guess, &PnpConfig::default())
        };
        let along = |k: i32| f64::from(k) * 0.1 - 1.0;
        let line: Vec<_> = (0..20)
            .map(|k| Point3::new(along(k), 0.5 * along(k), 4.0))
            .collect();
        assert_eq!(run(&line), Err(PnpError::Singular));
        assert!(run(&[Point3::new(0.1, 0.2, 3.0); 20]).is_err());
        let sharp = Observation {
            sigma: 1e-200,
            ..seen(Point3::new(0.3, 0.1, 3.0))
        };
        let config = PnpConfig::default();
        assert!(refine_pose(&[sharp; 20], &camera(), &truth, &config).is_err());
        // A point in the camera's face does not hide that the others determine the pose.
        let mut spread = scene(&truth, 0);
        let near = truth.inverse() * Point3::new(1e-9, 2e-9, 8e-9);
        spread.push(seen(near));
        let found = refine_pose(&spread, &camera(), &truth, &config);
        assert!(found.is_ok(), "{found:?}");
        // A plane is enough.
        let plane: Vec<_> = (0..20)
            .map(|k| Point3::new(along(k), along(7 * k % 20), 4.0))
            .collect();
        assert!(run(&plane).is_ok());
    }

    #[test]
    fn points_behind_the_camera_do_not_count() {
        let truth = Isometry3::identity();
        let mut observations = scene(&truth, 0);
        for observation in &mut observations[..85] {
            observation.point.z *= -1.0;
        }
        let run = |min_inliers| {
            let config = PnpConfig {
                min_inliers,
                ..PnpConfig::default()
            };
            refine_pose(&observations, &camera(), &truth, &config)
        };
        let found = run(10).unwrap();
        assert!(found.inliers.iter().all(|&k| k >= 85));
        assert!(found.camera_from_world.translation.vector.norm() < 0.05);
        let few = PnpError::TooFewInliers {
            inliers: 15,
            observations: 100,
            needed: 16,
        };
        assert_eq!(run(16), Err(few));
    }

    #[test]
    fn parameters_outside_their_range_are_refused() {
        let config = PnpConfig::default();
        let seen = scene(&Isometry3::identity(), 0);
        for (name, config) in [
            (
                "huber",
                PnpConfig {
                    huber: f64::NAN,
                    ..config
                },
            ),
            (
                "inlier",
                PnpConfig {
                    inlier: 0.0,
                    ..config
                },
            ),
            (
                "min_inliers",
                PnpConfig {
                    min_inliers: 3,
                    ..config
                },
            ),
        ] {
            match refine_pose(&seen, &camera(), &Isometry3::identity(), &config) {
                Err(PnpError::Parameter { name: found, .. }) => assert_eq!(found, name),
                other => panic!("{name}: {other:?}"),
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn the_gradient_is_the_derivative_of_hubers_loss(
            axis in prop::array::uniform3(-0.5..0.5f64), shift in prop::array::uniform3(-0.05..0.05f64), huber in 0.5..9.0f64,
        ) {
            let truth = Isometry3::new(Vector3::new(0.3, -0.2, 0.5), axis.into());
            let observations = scene(&truth, 10);
            let camera = camera();
            let problem = Problem { observations: &observations, camera: &camera, huber };
            let all: Vec<usize> = (0..observations.len()).collect();
            let [a, b, c] = shift;
            let pose = moved(&truth, &Vector6::new(a, b, c, 0.2 * c, 0.2 * a, 0.2 * b));
            let (_, gradient, square) = problem.normal_equations(&pose, &all);
            prop_assert!(square > 0.0);
            for k in 0..6 {
                let mut step = Vector6::zeros();
                step[k] = 1e-6;
                let at = |step: Vector6<f64>| problem.cost(&moved(&pose, &step), &all);
                let numeric = (at(step) - at(-step)) / 2e-6;
                prop_assert!((numeric - gradient[k]).abs() < 1e-5 * (1.0 + gradient.norm()), "{} {}", numeric, gradient[k]);
            }
        }

        #[test]
        fn the_covariance_is_that_of_the_derivative_by_the_pixels(axis in prop::array::uniform3(-0.5..0.5f64)) {
            // Without noise and outliers every weight is 1, and the pose moves by (JᵀJ)⁻¹ Jᵀ times a change of pixels.
            let truth = Isometry3::new(Vector3::new(0.3, -0.2, 0.5), axis.into());
            let camera = camera();
            let exact: Vec<Observation> = scene(&truth, 0).into_iter().step_by(4).map(|o| {
                Observation { pixel: camera.project(&(truth * o.point)).unwrap(), ..o }
            }).collect();
            let run = |observations: &[Observation]| {
                refine_pose(observations, &camera, &truth, &PnpConfig::default()).unwrap()
            };
            let covariance = run(&exact).covariance;
            let mut numeric = Matrix6::zeros();
            for k in 0..2 * exact.len() {
                let tangent = |by: f64| {
                    let mut moved = exact.clone();
                    moved[k / 2].pixel[k % 2] += by;
                    let change = run(&moved).camera_from_world * truth.inverse();
                    let (v, w) = (change.translation.vector, change.rotation.scaled_axis());
                    Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
                };
                let slope = (tangent(1e-2) - tangent(-1e-2)) / 2e-2;
                numeric += slope * slope.transpose();
            }
            prop_assert!((numeric - covariance).norm() < 1e-2 * covariance.norm(), "{} {}", numeric, covariance);
        }

        #[test]
        fn the_jacobian_is_the_derivative(
            point in prop::array::uniform3(-1.0..1.0f64), axis in prop::array::uniform3(-0.3..0.3f64),
        ) {
            let observation = Observation { point: point.into(), pixel: Point2::new(1.0, 2.0), sigma: 1.3 };
            let camera = camera();
            let problem = Problem { observations: &[observation], camera: &camera, huber: 1.0 };
            let pose = Isometry3::new(Vector3::new(0.1, 0.2, 4.0), axis.into());
            let (_, jacobian) = problem.residual(&pose, 0).unwrap();
            for k in 0..6 {
                let mut step = Vector6::zeros();
                step[k] = 1e-6;
                let ahead = problem.residual(&moved(&pose, &step), 0).unwrap().0;
                let behind = problem.residual(&moved(&pose, &-step), 0).unwrap().0;
                prop_assert!(((ahead - behind) / 2e-6 - jacobian.column(k)).norm() < 1e-4);
            }
        }

        #[test]
        fn the_gradient_is_that_of_hubers_loss(
            points in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 6..12),
            off in prop::array::uniform2(-30.0..30.0f64), axis in prop::array::uniform3(-0.3..0.3f64),
        ) {
            let camera = camera();
            let pose = Isometry3::new(Vector3::new(0.1, 0.2, 4.0), axis.into());
            let observation = |(k, &point): (usize, &[f64; 3])| {
                let seen = camera.project(&(pose * Point3::from(point))).unwrap();
                // Some residuals below the bend of the loss, some above.
                let off = nalgebra::Vector2::from(off) * k as f64 / 12.0;
                Observation { point: point.into(), pixel: seen + off, sigma: 1.3 }
            };
            let observations: Vec<_> = points.iter().enumerate().map(observation).collect();
            let problem = Problem { observations: &observations, camera: &camera, huber: 2.45 };
            let all: Vec<usize> = (0..observations.len()).collect();
            let (_, gradient, _) = problem.normal_equations(&pose, &all);
            for k in 0..6 {
                let mut step = Vector6::zeros();
                step[k] = 1e-6;
                let cost = |step: Vector6<f64>| problem.cost(&moved(&pose, &step), &all);
                let numeric = (cost(step) - cost(-step)) / 2e-6;
                prop_assert!((numeric - gradient[k]).abs() < 1e-4 * (1.0 + gradient.norm()), "{k}");
            }
        }
    }
}
