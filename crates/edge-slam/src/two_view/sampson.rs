//! The Sampson distance: to first order, how far a match must move to satisfy the epipolar constraint.
//!
//! ```text
//! r = x₂ᵀ E x₁ / √((E x₁)₁² + (E x₁)₂² + (Eᵀ x₂)₁² + (Eᵀ x₂)₂²)
//! ```

use nalgebra::{Matrix3, Vector3};

/// r for rays with z = 1, signed, in the same unit (times the focal length: pixels). 0/0 counts as infinite.
#[inline]
#[must_use]
pub fn sampson(essential: &Matrix3<f64>, first: &Vector3<f64>, second: &Vector3<f64>) -> f64 {
    let line = essential * first;
    let back = essential.tr_mul(second);
    let square = line.x * line.x + line.y * line.y + back.x * back.x + back.y * back.y;
    if square > 0.0 {
        second.dot(&line) / square.sqrt()
    } else {
        f64::INFINITY
    }
}

/// r and its derivatives for given derivatives of E.
pub(super) fn sampson_with_slopes<const N: usize>(
    essential: &Matrix3<f64>,
    slopes: &[Matrix3<f64>; N],
    first: &Vector3<f64>,
    second: &Vector3<f64>,
) -> Option<(f64, [f64; N])> {
    let line = essential * first;
    let back = essential.tr_mul(second);
    let square = line.x * line.x + line.y * line.y + back.x * back.x + back.y * back.y;
    if !(square > 0.0) {
        return None;
    }
    let root = square.sqrt();
    let value = second.dot(&line) / root;
    let slopes = slopes.each_ref().map(|slope| {
        let d_line = slope * first;
        let d_back = slope.tr_mul(second);
        let d_square =
            line.x * d_line.x + line.y * d_line.y + back.x * d_back.x + back.y * d_back.y;
        second.dot(&d_line) / root - value * d_square / square
    });
    Some((value, slopes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn slopes_are_the_derivatives(
            e in prop::array::uniform9(-1.0..1.0f64),
            d in prop::array::uniform9(-1.0..1.0f64),
            x in prop::array::uniform4(-0.6..0.6f64),
        ) {
            let (e, d) = (Matrix3::from_row_slice(&e), Matrix3::from_row_slice(&d));
            let (a, b) = (Vector3::new(x[0], x[1], 1.0), Vector3::new(x[2], x[3], 1.0));
            let (value, [slope]) = sampson_with_slopes(&e, &[d], &a, &b).unwrap();
            let numeric = (sampson(&(e + d * 1e-6), &a, &b) - sampson(&(e - d * 1e-6), &a, &b)) / 2e-6;
            prop_assert!((value - sampson(&e, &a, &b)).abs() < 1e-12);
            prop_assert!((slope - numeric).abs() < 1e-5 * (1.0 + slope.abs()), "{} {}", slope, numeric);
        }
    }
}
