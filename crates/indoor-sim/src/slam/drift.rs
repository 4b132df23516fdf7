//! How far the map's idea of space has slid away from the true one.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand::Rng;

use crate::random::{normal, normal3};

/// Where a true place lies in the drifted space: a turn about the vertical and a shift, kept as a rigid motion.
pub(crate) type Drift = Isometry3<f64>;

/// The mean of several drifts as felt at a place: the mean of where they put it and of their headings. `None` without
/// weights.
pub(crate) fn mean_at(
    place: Vector3<f64>,
    drifts: impl Iterator<Item = (Drift, f64)>,
) -> Option<Drift> {
    let mut weight = 0.0;
    let mut image = Vector3::zeros();
    let mut yaw = 0.0;
    for (drift, share) in drifts {
        weight += share;
        image += (drift * nalgebra::Point3::from(place)).coords * share;
        yaw += heading(&drift) * share;
    }
    (weight > 0.0).then(|| placed(place, image / weight, yaw / weight))
}

/// The slide into the unknown: a steady direction that changes slowly from keyframe to keyframe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slide {
    shift: Vector3<f64>,
    turn: f64,
}

/// How much of the slide's direction survives a keyframe.
const PERSISTENCE: f64 = 0.9;

impl Slide {
    pub(crate) fn new(rng: &mut impl Rng) -> Self {
        Self {
            shift: normal3(rng),
            turn: normal(rng),
        }
    }

    /// Changes the direction a little, keeping its spread.
    pub(crate) fn change(&mut self, rng: &mut impl Rng) {
        let fresh = (1.0 - PERSISTENCE * PERSISTENCE).sqrt();
        self.shift = self.shift * PERSISTENCE + normal3(rng) * fresh;
        self.turn = self.turn * PERSISTENCE + normal(rng) * fresh;
    }

    /// The drift after a camera has come to `place`, having slid by `shift` metres and `turn` rad.
    pub(crate) fn apply(
        &self,
        drift: &Drift,
        place: Vector3<f64>,
        (shift, turn): (f64, f64),
    ) -> Drift {
        let image = (drift * nalgebra::Point3::from(place)).coords;
        // Three components of variance 1/3 each make a step of the length asked for.
        let step = self.shift * (shift / 3.0_f64.sqrt());
        placed(place, image + step, heading(drift) + self.turn * turn)
    }
}

/// The drift that turns by `yaw` and takes `place` to `image`.
fn placed(place: Vector3<f64>, image: Vector3<f64>, yaw: f64) -> Drift {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
    Isometry3::from_parts(Translation3::from(image - turn * place), turn)
}

/// The turn about the vertical, rad; small by nature.
fn heading(drift: &Drift) -> f64 {
    2.0 * drift.rotation.k.atan2(drift.rotation.w)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{heading, mean_at, placed};

    #[test]
    fn the_mean_of_equal_drifts_is_that_drift() {
        let place = Vector3::new(5.0, -2.0, 1.0);
        let drift = placed(place, Vector3::new(5.1, -2.1, 1.0), 0.04);
        let mean = mean_at(
            Vector3::new(1.0, 1.0, 1.0),
            [(drift, 2.0), (drift, 5.0)].into_iter(),
        );
        let mean = mean.unwrap();
        assert!((heading(&mean) - 0.04).abs() < 1e-12);
        assert!((mean.translation.vector - drift.translation.vector).norm() < 1e-12);
        assert!(mean_at(place, core::iter::empty()).is_none());
    }
}
