//! Process noise that adapts to the battery and to the age of the last visual fix.
//!
//! ```text
//! Q = diag(β_p I₃, β_a I₃, β_s) (1 − b + ε + λ τ) dt
//! ```
//!
//! b is the battery's charge in 0..=1, τ the seconds since the last accepted visual fix. The paper's formula has
//! ε = 0, so that Q vanishes with a full battery right after a fix and the filter would ignore every measurement
//! from then on; and with b in per cent, as the drone reports it, Q would be negative. ε > 0 and a charge clamped
//! to 0..=1 mend both.

use nalgebra::SVector;

use super::FusionError;
use super::state::StateCovariance;

/// Parameters of the process noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcessNoise {
    /// β_p, m² per second, > 0. Default 0.05.
    pub position: f64,
    /// β_a, rad² per second, > 0. Default (2 degrees)².
    pub attitude: f64,
    /// β_s, per second, >= 0: how fast the visual scale may drift. Default 1e-4.
    pub log_scale: f64,
    /// ε, > 0: what is left with a full battery. Default 0.1.
    pub floor: f64,
    /// λ, per second, >= 0. Default 0.5.
    pub growth: f64,
    /// Age at which τ stops growing, seconds, >= 0. Default 5.
    pub longest_age: f64,
}

impl Default for ProcessNoise {
    fn default() -> Self {
        Self {
            position: 0.05,
            attitude: 2_f64.to_radians().powi(2),
            log_scale: 1e-4,
            floor: 0.1,
            growth: 0.5,
            longest_age: 5.0,
        }
    }
}

impl ProcessNoise {
    /// Q for a step of `dt` seconds. `battery` is clamped to 0..=1, `age` to 0..=`longest_age`. Fields are taken as they are:
    /// [`Ekf::new`](super::Ekf::new) checks them.
    #[must_use]
    pub fn covariance(&self, battery: f64, age: f64, dt: f64) -> StateCovariance {
        let age = age.min(self.longest_age).max(0.0);
        let factor = 1.0 - battery.clamp(0.0, 1.0) + self.floor + self.growth * age;
        let (p, a) = (self.position, self.attitude);
        let diagonal = SVector::from([p, p, p, a, a, a, self.log_scale]) * (factor * dt);
        StateCovariance::from_diagonal(&diagonal)
    }

    pub(super) fn validate(&self) -> Result<(), FusionError> {
        let fields = [
            ("position", self.position, self.position > 0.0, "positive"),
            ("attitude", self.attitude, self.attitude > 0.0, "positive"),
            (
                "log_scale",
                self.log_scale,
                self.log_scale >= 0.0,
                "0 or more",
            ),
            ("floor", self.floor, self.floor > 0.0, "positive"),
            ("growth", self.growth, self.growth >= 0.0, "0 or more"),
            (
                "longest_age",
                self.longest_age,
                self.longest_age >= 0.0,
                "0 or more",
            ),
        ];
        for (name, value, good, range) in fields {
            if !(good && value.is_finite()) {
                return Err(FusionError::Parameter { name, value, range });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn grows_with_age_and_discharge_and_never_vanishes(
            battery in 0.0..1.0f64, age in 0.0..8.0f64, less in 0.0..1.0f64, more in 0.0..3.0f64,
        ) {
            let noise = ProcessNoise::default();
            let q = |b, a| noise.covariance(b, a, 0.1)[(0, 0)];
            prop_assert!(q(battery, age) > 0.0);
            prop_assert!(q(battery * less, age) >= q(battery, age));
            prop_assert!(q(battery, age + more) >= q(battery, age));
        }
    }

    #[test]
    fn an_age_without_a_limit_does_not_panic() {
        for longest_age in [-1.0, f64::NAN] {
            let noise = ProcessNoise {
                longest_age,
                ..ProcessNoise::default()
            };
            assert!(noise.covariance(0.5, 2.0, 0.1)[(0, 0)] > 0.0);
            assert!(noise.validate().is_err());
        }
    }

    #[test]
    fn per_cent_do_not_make_it_negative() {
        let noise = ProcessNoise::default();
        assert_eq!(
            noise.covariance(87.0, 0.0, 0.1),
            noise.covariance(1.0, 0.0, 0.1)
        );
        assert!(noise.covariance(87.0, 0.0, 0.1)[(6, 6)] > 0.0);
    }
}
