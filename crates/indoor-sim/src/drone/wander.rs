//! The small wandering of a hovering drone about the point it holds.

use nalgebra::Vector3;
use rand::Rng;

use crate::random::normal3;

/// A critically damped process driven by noise: smooth, with zero mean and a given standard deviation per axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Wander {
    first: Vector3<f64>,
    offset: Vector3<f64>,
}

impl Wander {
    /// Where it is, metres off the held point.
    pub(crate) fn offset(&self) -> Vector3<f64> {
        self.offset
    }

    /// Goes on by `dt` seconds: an Ornstein-Uhlenbeck process with time constant `time`, smoothed by a low pass of the
    /// same constant. The low pass halves the variance, so the first stage is driven by √2 of the deviation.
    pub(crate) fn step(&mut self, dt: f64, deviation: f64, time: f64, rng: &mut impl Rng) {
        let keep = (-dt / time).exp();
        let drive = deviation * core::f64::consts::SQRT_2 * (1.0 - keep * keep).sqrt();
        self.first = self.first * keep + normal3(rng) * drive;
        self.offset = self.offset * keep + self.first * (1.0 - keep);
    }

    /// Forgets the wandering: on the ground there is none.
    pub(crate) fn rest(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::Wander;
    use crate::random::{Purpose, stream};

    #[test]
    fn the_deviation_is_the_one_asked_for() {
        let mut rng = stream(1, Purpose::Motion);
        let mut wander = Wander::default();
        let mut squares = 0.0;
        for _ in 0..100_000 {
            wander.step(0.05, 0.02, 1.0, &mut rng);
            squares += wander.offset().norm_squared() / 3.0;
        }
        let deviation = (squares / 100_000.0_f64).sqrt();
        assert!((deviation - 0.02).abs() < 0.002, "{deviation}");
    }
}
