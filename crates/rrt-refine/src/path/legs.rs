//! A path as a vehicle flies it: straight legs up to a length, and turns on the spot up to an angle.

use super::resample::{bounded, positive};
use super::{Path, PathError};
use crate::euclid::{between, distance};

/// One thing to do next on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leg<const D: usize> {
    /// Turn on the spot.
    Turn {
        /// Where.
        at: [f64; D],
        /// Unit vector of the direction before.
        from: [f64; D],
        /// Unit vector of the direction after.
        to: [f64; D],
        /// Angle between the two, radians, above 0.
        angle: f64,
    },
    /// Move on a straight line.
    Straight {
        /// From here.
        from: [f64; D],
        /// To here.
        to: [f64; D],
        /// Distance, above 0.
        length: f64,
    },
}

/// Turns below this angle (radians) are rounding, not turns.
const SMALLEST_TURN: f64 = 1e-9;

impl<const D: usize> Path<D> {
    /// The path as straight legs of at most `max_length` and turns on the spot of at most `max_turn` radians.
    ///
    /// Segments and corners are cut into the fewest equal parts. The path begins in the direction of its first segment; segments
    /// of length 0 give nothing. A reversal (π) turns through a fixed perpendicular; on a line (D = 1) it is one turn.
    /// To avoid turns on the spot, round the corners first ([`refine::round_corners`](crate::refine::round_corners)).
    ///
    /// ```
    /// use rrt_refine::{Leg, Path};
    /// let path = Path::new(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]])?;
    /// let legs = path.legs(2.0, 0.8)?;
    /// let turns = legs.iter().filter(|leg| matches!(leg, Leg::Turn { .. })).count();
    /// assert_eq!((legs.len(), turns), (5, 2));
    /// # Ok::<(), rrt_refine::PathError>(())
    /// ```
    ///
    /// # Errors
    /// A limit that is not positive and finite, or so small that more than ten million legs were needed.
    pub fn legs(&self, max_length: f64, max_turn: f64) -> Result<Vec<Leg<D>>, PathError> {
        positive("max_length", max_length)?;
        positive("max_turn", max_turn)?;
        let corners = self.points().len() as f64 * (std::f64::consts::PI / max_turn + 2.0);
        bounded(self.length() / max_length + corners)?;
        let mut legs = Vec::new();
        let mut heading: Option<[f64; D]> = None;
        for (a, b) in self.segments() {
            let Some(direction) = direction(a, b) else {
                continue;
            };
            if let Some(before) = heading {
                push_turns(&mut legs, a, &before, &direction, max_turn);
            }
            push_straights(&mut legs, a, b, max_length);
            heading = Some(direction);
        }
        Ok(legs)
    }

    /// Angles (radians, 0 to π) by which the path turns at its inner vertices; 0 where a neighbouring segment has no length.
    pub fn turns(&self) -> Vec<f64> {
        self.points()
            .windows(3)
            .map(|corner| {
                match (
                    direction(&corner[0], &corner[1]),
                    direction(&corner[1], &corner[2]),
                ) {
                    (Some(before), Some(after)) => angle_between(&before, &after),
                    _ => 0.0,
                }
            })
            .collect()
    }
}

fn push_straights<const D: usize>(
    legs: &mut Vec<Leg<D>>,
    a: &[f64; D],
    b: &[f64; D],
    max_length: f64,
) {
    let parts = (distance(a, b) / max_length).ceil().max(1.0) as usize;
    let mut from = *a;
    for part in 1..=parts {
        let to = between(a, b, part as f64 / parts as f64);
        let length = distance(&from, &to);
        legs.push(Leg::Straight { from, to, length });
        from = to;
    }
}

fn push_turns<const D: usize>(
    legs: &mut Vec<Leg<D>>,
    at: &[f64; D],
    before: &[f64; D],
    after: &[f64; D],
    max_turn: f64,
) {
    let angle = angle_between(before, after);
    if angle < SMALLEST_TURN {
        return;
    }
    let side = perpendicular(before, after);
    let parts = match side {
        Some(_) => (angle / max_turn).ceil().max(1.0) as usize,
        None => 1,
    };
    let mut from = *before;
    for part in 1..=parts {
        let to = match side {
            Some(side) if part < parts => {
                let (sin, cos) = (angle * part as f64 / parts as f64).sin_cos();
                std::array::from_fn(|axis| cos * before[axis] + sin * side[axis])
            }
            _ => *after,
        };
        legs.push(Leg::Turn {
            at: *at,
            from,
            to,
            angle: angle / parts as f64,
        });
        from = to;
    }
}

/// Unit vector from `a` to `b`.
pub(crate) fn direction<const D: usize>(a: &[f64; D], b: &[f64; D]) -> Option<[f64; D]> {
    let length = distance(a, b);
    (length > 0.0).then(|| std::array::from_fn(|axis| (b[axis] - a[axis]) / length))
}

/// Angle between two unit vectors, accurate for small and for straight angles.
pub(crate) fn angle_between<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let sum: [f64; D] = std::array::from_fn(|axis| a[axis] + b[axis]);
    2.0 * distance(a, b).atan2(distance(&sum, &[0.0; D]))
}

/// Unit vector at a right angle to `before`, on the side of `after`; for a reversal the side of the first axis that has one.
/// `None` on a line.
fn perpendicular<const D: usize>(before: &[f64; D], after: &[f64; D]) -> Option<[f64; D]> {
    let candidates = std::iter::once(*after)
        .chain((0..D).map(|k| std::array::from_fn(|axis| if axis == k { 1.0 } else { 0.0 })));
    for candidate in candidates {
        let dot: f64 = (0..D).map(|axis| candidate[axis] * before[axis]).sum();
        let rest: [f64; D] = std::array::from_fn(|axis| candidate[axis] - dot * before[axis]);
        // A shorter rest is mostly rounding; with D > 1 one axis always leaves more than this.
        if distance(&rest, &[0.0; D]) > 1e-6 {
            return direction(&[0.0; D], &rest);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn legs_join_up_and_keep_the_limits() -> Result<(), PathError> {
        let path = Path::new(&[
            [0.0, 0.0, 0.0],
            [1.0, 2.0, 0.5],
            [1.0, 2.0, 0.5],
            [-3.0, 1.0, 2.0],
            [4.0, 0.0, 0.0],
        ])?;
        let (mut at, mut length, mut turned) = (path.start(), 0.0, 0.0);
        for leg in path.legs(0.7, 0.3)? {
            match leg {
                Leg::Straight {
                    from,
                    to,
                    length: l,
                } => {
                    assert_eq!(from, at);
                    assert!(l > 0.0 && l <= 0.7 + 1e-12);
                    at = to;
                    length += l;
                }
                Leg::Turn {
                    at: here,
                    from,
                    to,
                    angle,
                } => {
                    assert_eq!(here, at);
                    assert!(angle <= 0.3 + 1e-12);
                    assert!((angle_between(&from, &to) - angle).abs() < 1e-9);
                    turned += angle;
                }
            }
        }
        assert_eq!(at, path.end());
        assert!((length - path.length()).abs() < 1e-9);
        // The doubled vertex hides the corner from `turns`.
        let clean = Path::new(&[
            path.points()[0],
            path.points()[1],
            path.points()[3],
            path.points()[4],
        ])?;
        assert!((turned - clean.turns().iter().sum::<f64>()).abs() < 1e-9);
        Ok(())
    }

    #[test]
    fn reversals_turn_half_around() -> Result<(), PathError> {
        let there_and_back = Path::new(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]])?;
        assert_eq!(there_and_back.turns(), [PI]);
        let legs = there_and_back.legs(5.0, PI / 2.0)?;
        assert!(matches!(legs[1], Leg::Turn { to, .. } if (to[1] - 1.0).abs() < 1e-12));
        assert_eq!(legs.len(), 4);
        let line = Path::new(&[[0.0], [1.0], [0.0]])?;
        assert_eq!(line.legs(5.0, 0.1)?.len(), 3);
        Ok(())
    }

    #[test]
    fn a_path_without_length_has_no_legs() -> Result<(), PathError> {
        assert!(Path::new(&[[1.0, 1.0]])?.legs(1.0, 1.0)?.is_empty());
        assert!(Path::new(&[[1.0, 1.0]; 4])?.legs(1.0, 1.0)?.is_empty());
        assert!(Path::new(&[[1.0, 1.0]])?.legs(0.0, 1.0).is_err());
        assert!(Path::new(&[[0.0], [1.0]])?.legs(1e-200, 1.0).is_err());
        assert!(Path::new(&[[0.0], [1.0]])?.legs(1.0, 1e-200).is_err());
        Ok(())
    }

    #[test]
    fn segments_and_corners_are_cut_into_the_fewest_equal_parts() -> Result<(), PathError> {
        let corner = Path::new(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]])?;
        for (max_length, max_turn, lengths, turns) in [
            (4.0, 2.0, 2, 1),
            (3.0, 1.58, 2, 1),
            (2.99, 1.57, 3, 2),
            (1.0, 0.53, 4, 3),
            (0.4, 0.1, 8 + 3, 16),
        ] {
            let legs = corner.legs(max_length, max_turn)?;
            let is_turn = |leg: &&Leg<2>| matches!(leg, Leg::Turn { .. });
            assert_eq!(legs.iter().filter(is_turn).count(), turns);
            assert_eq!(legs.len() - turns, lengths);
            for leg in legs {
                if let Leg::Turn { angle, .. } = leg {
                    assert!((angle - 0.5 * PI / turns as f64).abs() < 1e-12);
                }
            }
        }
        Ok(())
    }

    #[test]
    fn more_than_ten_million_legs_are_refused_before_they_are_made() -> Result<(), PathError> {
        // Nothing turns here, but three corners could turn half around.
        let straight = Path::new(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])?;
        assert_eq!(straight.legs(1.0, 1e-6)?.len(), 2);
        assert!(straight.legs(1.0, 0.9e-6).is_err());
        assert!(straight.legs(1e-7, 1.0).is_err());
        Ok(())
    }
}
