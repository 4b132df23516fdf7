//! The essential matrix and the four motions it stands for.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// `E = [t]× R` with x₂ᵀ E x₁ = 0, for the motion that takes points of the first camera to the second.
#[must_use]
pub fn essential_of(second_from_first: &Isometry3<f64>) -> Matrix3<f64> {
    let translation = second_from_first.translation.vector;
    translation.cross_matrix() * second_from_first.rotation.to_rotation_matrix().matrix()
}

/// The four motions with a translation of length 1 that have this E (up to sign): two rotations, two directions.
///
/// `None` when the matrix is not finite, zero, or far from an essential one (second singular value under half
/// the first).
#[must_use]
pub fn candidate_poses(essential: &Matrix3<f64>) -> Option<[Isometry3<f64>; 4]> {
    if !essential.iter().all(|value| value.is_finite()) {
        return None;
    }
    // Columns of E span the plane at a right angle to t; the largest cross product of two of them is t.
    let columns = [0, 1, 2].map(|k| essential.column(k).into_owned());
    let crosses = [
        columns[0].cross(&columns[1]),
        columns[1].cross(&columns[2]),
        columns[2].cross(&columns[0]),
    ];
    let longest = crosses
        .iter()
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
    // Whatever the length of E: its two singular values are equal, so that the cross product is half its squared norm.
    let direction = longest.try_normalize(1e-12 * essential.norm_squared())?;
    let scaled = essential * (core::f64::consts::SQRT_2 / essential.norm());
    // Horn 1990: R = cof(E) ∓ [t]× E with unit t.
    let cofactors = Matrix3::from_columns(&[
        scaled.column(1).cross(&scaled.column(2)),
        scaled.column(2).cross(&scaled.column(0)),
        scaled.column(0).cross(&scaled.column(1)),
    ]);
    let turn =
        |sign: f64| nearest_rotation(&(cofactors - direction.cross_matrix() * scaled * sign));
    let (a, b) = (turn(1.0)?, turn(-1.0)?);
    let pose = |rotation, t: Vector3<f64>| Isometry3::from_parts(Translation3::from(t), rotation);
    Some([
        pose(a, direction),
        pose(a, -direction),
        pose(b, direction),
        pose(b, -direction),
    ])
}

/// The rotation nearest to a matrix that nearly is one.
fn nearest_rotation(matrix: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let mut rotation = *matrix;
    if !(rotation.determinant() > 0.1) {
        return None;
    }
    // Newton's iteration for the polar factor; quadratic near a rotation.
    for _ in 0..20 {
        let inverse = rotation.try_inverse()?;
        let next = (rotation + inverse.transpose()) * 0.5;
        let change = (next - rotation).norm();
        rotation = next;
        if change < 1e-14 {
            break;
        }
    }
    Some(UnitQuaternion::from_rotation_matrix(
        &Rotation3::from_matrix_unchecked(rotation),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn one_candidate_is_the_truth_and_all_share_the_matrix(
            axis in prop::array::uniform3(-1.5..1.5f64),
            shift in prop::array::uniform3(-1.0..1.0f64),
        ) {
            prop_assume!(Vector3::from(shift).norm() > 0.05);
            let truth = Isometry3::new(Vector3::from(shift).normalize(), axis.into());
            let essential = essential_of(&truth);
            let candidates = candidate_poses(&essential).unwrap();
            let nearest = candidates.iter().map(|c| {
                c.rotation.angle_to(&truth.rotation)
                    + (c.translation.vector - truth.translation.vector).norm()
            }).fold(f64::MAX, f64::min);
            prop_assert!(nearest < 1e-6, "{}", nearest);
            for candidate in &candidates {
                let e = essential_of(candidate);
                prop_assert!((e - essential).norm().min((e + essential).norm()) < 1e-6);
            }
        }
    }

    #[test]
    fn the_length_of_the_matrix_does_not_matter() {
        let truth = Isometry3::new(Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.1, -0.2, 0.3));
        for length in [1e-60, 1e-9, 1.0, 1e9, 1e60] {
            let candidates = candidate_poses(&(essential_of(&truth) * length)).unwrap();
            let off = |c: &Isometry3<f64>| {
                c.rotation.angle_to(&truth.rotation)
                    + (c.translation.vector - truth.translation.vector).norm()
            };
            assert!(candidates.iter().any(|pose| off(pose) < 1e-6), "{length:e}");
        }
        // One singular value is no essential matrix.
        let (a, b) = (Vector3::new(0.3, 0.1, 0.9), Vector3::new(-0.2, 0.8, 0.4));
        assert!(candidate_poses(&(a * b.transpose())).is_none());
    }

    #[test]
    fn nonsense_has_no_pose() {
        assert!(candidate_poses(&Matrix3::zeros()).is_none());
        assert!(candidate_poses(&Matrix3::from_element(f64::NAN)).is_none());
    }
}
