//! Predicts a displacement whose unit is not known: the exact mean and covariances of e^−σ w for jointly Gaussian σ and w.
//!
//! ```text
//! measured    d = e⁻ˢ (w + n)       w = R₀ᵀ (p − p₀),  s = s̄ + σ;  weighed in metres: eˢ̄ d = e^−σ (w + n)
//! mean        e^{P_σσ/2} (w̄ − P_wσ)
//! cov x, ·    e^{P_σσ/2} (P_xw − P_xσ (w̄ − P_wσ)ᵀ)
//! cov ·, ·    e^{2 P_σσ} ((w̄ − 2 P_wσ)(w̄ − 2 P_wσ)ᵀ + P_ww + R) − mean meanᵀ
//! ```
//!
//! Weighing a Gaussian with e^−σ moves its mean by −P_xσ and changes nothing else, which gives all three. With them the
//! Kalman update is the best linear one, and its covariance that of its error.
//!
//! Deviation from the specification, which has the extended update: that one takes the slope by s, −w, for known, although w
//! is itself estimated, and every update counts as knowledge about the scale that nobody had. For a small P_σσ both agree.
//! The exact posterior (integrated over s) was tried instead: it reads the scale from the size of the innovations as
//! well, and where they are smaller than the noise assumed it went astray (a scale of 1.94 for 1.6 in a test of this crate).

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::state::StateCovariance;

/// What is predicted of a displacement and of the angles with it.
pub(super) struct Prediction {
    /// Metres at the state's scale.
    pub(super) mean: Vector3<f64>,
    /// Of the state with displacement and angles.
    pub(super) cross: SMatrix<f64, 7, 6>,
    /// Of displacement and angles, without the angles' noise.
    pub(super) spread: SMatrix<f64, 6, 6>,
}

/// P_σσ above which the log scale is as good as unknown (a factor of seven either way) and the moments, which are those
/// of its long tail then, say nothing about likely values: the extended update takes over.
const WIDEST: f64 = 4.0;

/// `way` is w̄, `back` R₀ᵀ; the noise of a displacement has the variance `noise[0] + noise[1] |w|²` in each direction.
pub(super) fn predict_displacement(
    covariance: &StateCovariance,
    way: &Vector3<f64>,
    back: &Matrix3<f64>,
    noise: [f64; 2],
) -> Prediction {
    let with_way: SMatrix<f64, 7, 3> = covariance.fixed_columns::<3>(0) * back.transpose();
    let own: Matrix3<f64> = back * with_way.fixed_rows::<3>(0);
    let with_scale: SVector<f64, 7> = covariance.column(6).into_owned();
    let shift: Vector3<f64> = back * with_scale.fixed_rows::<3>(0);
    let variance = with_scale[6];
    let (mean, with_seen, seen) = if variance <= WIDEST {
        let (once, twice) = ((0.5 * variance).exp(), (2.0 * variance).exp());
        let (near, far) = (way - shift, way - shift * 2.0);
        let mean = near * once;
        let error = noise[0] + noise[1] * (far.norm_squared() + own.trace());
        let square = far * far.transpose() + own + Matrix3::identity() * error;
        let with_seen = (with_way - with_scale * near.transpose()) * once;
        (mean, with_seen, square * twice - mean * mean.transpose())
    } else {
        let with_seen = with_way - with_scale * way.transpose();
        let error = noise[0] + noise[1] * way.norm_squared();
        let bent = shift * way.transpose();
        let seen = own - bent - bent.transpose() + way * way.transpose() * variance;
        (*way, with_seen, seen + Matrix3::identity() * error)
    };
    let mut cross = SMatrix::<f64, 7, 6>::zeros();
    cross.fixed_columns_mut::<3>(0).copy_from(&with_seen);
    let angles = covariance.fixed_columns::<3>(3);
    cross.fixed_columns_mut::<3>(3).copy_from(&angles);
    let mut spread = SMatrix::<f64, 6, 6>::zeros();
    spread.fixed_view_mut::<3, 3>(0, 0).copy_from(&seen);
    let mixed = cross.fixed_view::<3, 3>(3, 0).into_owned();
    spread.fixed_view_mut::<3, 3>(3, 0).copy_from(&mixed);
    let mixed = mixed.transpose();
    spread.fixed_view_mut::<3, 3>(0, 3).copy_from(&mixed);
    let angles = covariance.fixed_view::<3, 3>(3, 3);
    spread.fixed_view_mut::<3, 3>(3, 3).copy_from(&angles);
    Prediction {
        mean,
        cross,
        spread,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    const NOISE: [f64; 2] = [9e-4, 4e-4];

    /// A covariance with correlations of every kind; the log scale's deviation is about `sigma`.
    fn covariance(numbers: &[f64], sigma: f64) -> StateCovariance {
        let root = StateCovariance::from_row_slice(numbers) + StateCovariance::identity() * 2.0;
        let unit = SVector::from([0.1, 0.1, 0.1, 0.03, 0.03, 0.03, sigma / 2.2]);
        let scaled = StateCovariance::from_diagonal(&unit) * root;
        scaled * scaled.transpose()
    }

    proptest! {
        #[test]
        fn the_slopes_are_derivatives_where_the_scale_is_nearly_known(
            numbers in prop::collection::vec(-0.5..0.5f64, 49), way in prop::array::uniform3(-2.0..2.0f64),
            turn in prop::array::uniform3(-2.0..2.0f64),
        ) {
            let (way, back) = (Vector3::from(way), *Rotation3::new(Vector3::from(turn)).matrix());
            // Central differences of what is seen, e^−σ (w + R₀ᵀ δp), and the angles.
            let seen = |x: SVector<f64, 7>| {
                let place = (way + back * x.fixed_rows::<3>(0)) * (-x[6]).exp();
                SVector::<f64, 6>::new(place.x, place.y, place.z, x[3], x[4], x[5])
            };
            let mut slopes = SMatrix::<f64, 6, 7>::zeros();
            for k in 0..7 {
                let step = SVector::<f64, 7>::from_fn(|i, _| if i == k { 1e-6 } else { 0.0 });
                slopes.set_column(k, &((seen(step) - seen(-step)) / 2e-6));
            }
            // Both forms: the moments of a narrow scale, and the extended update.
            for sigma in [1e-4, 9.0] {
                let p = covariance(&numbers, sigma);
                let found = predict_displacement(&p, &way, &back, [0.0, 0.0]);
                let unit = SVector::<f64, 7>::from_fn(|k, _| p[(k, k)].sqrt());
                let spread = slopes * p * slopes.transpose();
                let size = SVector::<f64, 6>::from_fn(|k, _| spread[(k, k)].sqrt());
                let off = (found.cross - p * slopes.transpose()).component_div(&(unit * size.transpose()));
                prop_assert!(off.abs().max() < 0.01, "{sigma} {off}");
                let off = (found.spread - spread).component_div(&(size * size.transpose()));
                prop_assert!(off.abs().max() < 0.01, "{sigma} {off}");
            }
        }

        #[test]
        fn the_whole_is_a_covariance_however_unsure_the_scale_is(
            numbers in prop::collection::vec(-0.5..0.5f64, 49), way in prop::array::uniform3(-5.0..5.0f64),
            sigma in 0.0..6.0f64,
        ) {
            let p = covariance(&numbers, sigma);
            let found = predict_displacement(&p, &way.into(), &Matrix3::identity(), NOISE);
            let inverse = found.spread.try_inverse().unwrap();
            let left = p - found.cross * inverse * found.cross.transpose();
            let unit = SVector::<f64, 7>::from_fn(|k, _| p[(k, k)].sqrt().max(1e-9));
            let left = left.component_div(&(unit * unit.transpose()));
            prop_assert!(left.symmetric_eigenvalues().min() > -1e-6);
        }
    }

    #[test]
    fn moments_are_those_of_draws() {
        let numbers: Vec<f64> = (0..49).map(|k| 0.5 * (f64::from(k) * 1.7).sin()).collect();
        let p = covariance(&numbers, 0.3);
        let way = Vector3::new(0.8, -0.5, 0.3);
        let back = *Rotation3::new(Vector3::new(0.3, 0.2, -0.8)).matrix();
        let found = predict_displacement(&p, &way, &back, NOISE);
        let root = p.cholesky().unwrap().l();
        let rng = &mut Pcg64::seed_from_u64(5);
        let mut gaussian = || {
            let (u, v): (f64, f64) = (rng.random(), rng.random());
            (-2.0 * (1.0 - u).ln()).sqrt() * (core::f64::consts::TAU * v).cos()
        };
        let count = 200_000.0;
        let (mut sum, mut cross) = (SVector::<f64, 6>::zeros(), SMatrix::<f64, 7, 6>::zeros());
        let mut square = SMatrix::<f64, 6, 6>::zeros();
        for _ in 0..200_000 {
            let x = root * SVector::<f64, 7>::from_fn(|_, _| gaussian());
            let place = way + back * x.fixed_rows::<3>(0);
            let sigma = (NOISE[0] + NOISE[1] * place.norm_squared()).sqrt();
            let noisy = place + Vector3::from_fn(|_, _| gaussian()) * sigma;
            let [a, b, c]: [f64; 3] = (noisy * (-x[6]).exp()).into();
            let seen = SVector::from([a, b, c, x[3], x[4], x[5]]);
            sum += seen / count;
            cross += x * seen.transpose() / count;
            square += seen * seen.transpose() / count;
        }
        let spread = square - sum * sum.transpose();
        let size = SVector::<f64, 6>::from_fn(|k, _| spread[(k, k)].sqrt());
        let unit = SVector::<f64, 7>::from_fn(|k, _| p[(k, k)].sqrt());
        let off = (sum.fixed_rows::<3>(0) - found.mean).component_div(&size.fixed_rows::<3>(0));
        assert!(off.abs().max() < 0.02, "{off}");
        let off = (cross - found.cross).component_div(&(unit * size.transpose()));
        assert!(off.abs().max() < 0.02, "{off}");
        let off = (spread - found.spread).component_div(&(size * size.transpose()));
        assert!(off.abs().max() < 0.03, "{off}");
    }
}
