//! Bearings on the circle: wrapping and turns.

use std::f64::consts::{PI, TAU};

/// Maps any finite angle to `[0, 2π)`.
pub(crate) fn wrap(angle: f64) -> f64 {
    // The remainder is slow and rarely needed: bearings come from atan2.
    let wrapped = match angle {
        angle if (0.0..TAU).contains(&angle) => return angle,
        angle if (-TAU..0.0).contains(&angle) => angle + TAU,
        angle => angle.rem_euclid(TAU),
    };
    if wrapped >= TAU { 0.0 } else { wrapped }
}

/// Signed turn from `from` to `to`, in `(-π, π]`.
pub(crate) fn turn(from: f64, to: f64) -> f64 {
    let difference = wrap(to - from);
    if difference > PI {
        difference - TAU
    } else {
        difference
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_stays_half_open() {
        assert_eq!(wrap(-1e-20), 0.0);
        assert_eq!(wrap(TAU), 0.0);
        assert!((wrap(-0.5) - (TAU - 0.5)).abs() < 1e-12);
    }

    #[test]
    fn a_turn_takes_the_short_way() {
        assert!((turn(0.1, TAU - 0.1) + 0.2).abs() < 1e-12);
        assert!((turn(TAU - 0.1, 0.1) - 0.2).abs() < 1e-12);
    }
}
