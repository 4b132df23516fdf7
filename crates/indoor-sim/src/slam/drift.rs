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

/// A drift after a camera at `place` has moved `distance` metres and turned `angle` rad into the unknown.
pub(crate) fn slid(
    drift: &Drift,
    place: Vector3<f64>,
    (shift, turn): (f64, f64),
    rng: &mut impl Rng,
) -> Drift {
    let image = (drift * nalgebra::Point3::from(place)).coords;
    let yaw = heading(drift) + turn * normal(rng);
    placed(place, image + normal3(rng) * shift, yaw)
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
