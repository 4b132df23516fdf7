//! Real roots of a polynomial in an interval, all of them, without complex arithmetic.
//!
//! Between two neighbouring roots of its derivative a polynomial is monotonous, so each such stretch holds at most
//! one root, found by Newton's method kept inside by bisection. The derivatives' roots come from the same rule.

/// Ascending real roots in `[-bound, bound]` of Σ cₖ zᵏ; double roots may be missed (they change no sign).
///
/// Coefficients that are not finite, and constants, have no roots.
pub(super) fn real_roots(coefficients: &[f64; 11], bound: f64) -> Vec<f64> {
    let greatest = coefficients
        .iter()
        .fold(0.0_f64, |most, c| most.max(c.abs()));
    if !(greatest > 0.0 && greatest.is_finite()) {
        return Vec::new();
    }
    let degree = (0..11)
        .rev()
        .find(|&k| coefficients[k].abs() > 1e-14 * greatest)
        .unwrap_or(0);
    // derivatives[k] is the (degree − k)-th derivative, of degree k, scaled to keep numbers tame.
    let mut derivative = *coefficients;
    let mut derivatives = vec![derivative];
    for order in 1..degree {
        let top = degree + 1 - order;
        for k in 1..=top {
            #[expect(clippy::cast_precision_loss, reason = "at most 10")]
            let factor = k as f64 / top as f64;
            derivative[k - 1] = derivative[k] * factor;
        }
        derivative[top] = 0.0;
        derivatives.push(derivative);
    }
    let mut roots: Vec<f64> = Vec::with_capacity(10);
    for (index, polynomial) in derivatives.iter().rev().enumerate().filter(|_| degree > 0) {
        roots = between(&polynomial[..=(index + 1)], &roots, bound);
    }
    roots
}

fn between(polynomial: &[f64], extrema: &[f64], bound: f64) -> Vec<f64> {
    let mut roots = Vec::with_capacity(extrema.len() + 1);
    let mut low = -bound;
    for &high in extrema.iter().chain(core::iter::once(&bound)) {
        let (at_low, at_high) = (value(polynomial, low).0, value(polynomial, high).0);
        if (at_low < 0.0) != (at_high < 0.0) {
            roots.push(bracketed(polynomial, low, high, at_low < 0.0));
        }
        low = high;
    }
    roots
}

/// The root in an interval at whose ends the signs differ.
fn bracketed(polynomial: &[f64], mut low: f64, mut high: f64, rising: bool) -> f64 {
    let mut place = 0.5 * (low + high);
    for _ in 0..80 {
        let (height, slope) = value(polynomial, place);
        if (height < 0.0) == rising {
            low = place;
        } else {
            high = place;
        }
        let newton = place - height / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - place).abs() <= 1e-15 * place.abs().max(1e-3) {
            return next;
        }
        place = next;
    }
    place
}

/// Value and slope (Horner).
fn value(polynomial: &[f64], z: f64) -> (f64, f64) {
    let (mut height, mut slope) = (0.0, 0.0);
    for &coefficient in polynomial.iter().rev() {
        slope = slope * z + height;
        height = height * z + coefficient;
    }
    (height, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn known_roots_are_found(mut roots in prop::collection::vec(-5.0..5.0f64, 1..10), scale in 0.1..9.0f64) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|w| w[1] - w[0] > 0.2));
            let mut polynomial = [0.0; 11];
            polynomial[0] = scale;
            for (degree, root) in roots.iter().enumerate() {
                for k in (0..=degree + 1).rev() {
                    let lower = if k > 0 { polynomial[k - 1] } else { 0.0 };
                    polynomial[k] = lower - root * polynomial[k];
                }
            }
            let found = real_roots(&polynomial, 10.0);
            prop_assert_eq!(found.len(), roots.len());
            for (a, b) in found.iter().zip(&roots) {
                prop_assert!((a - b).abs() < 1e-4, "{} {}", a, b);
            }
        }
    }

    #[test]
    fn odd_input_has_no_roots() {
        assert!(real_roots(&[0.0; 11], 10.0).is_empty());
        assert!(real_roots(&[f64::NAN; 11], 10.0).is_empty());
        let mut constant = [0.0; 11];
        constant[0] = 3.0;
        assert!(real_roots(&constant, 10.0).is_empty());
        constant[2] = 1.0;
        assert!(real_roots(&constant, 10.0).is_empty());
    }
}
