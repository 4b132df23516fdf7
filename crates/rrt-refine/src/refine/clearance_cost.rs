//! A cost of motions that keeps a path off obstacles: length, made dearer where the clearance is small.

use super::RefineError;
use super::error::{not_negative, positive};
use crate::euclid::{between, distance};

/// Cost ∫ (1 + weight · max(0, 1 − c(x)/comfort)²) ds of a straight motion, c the clearance at a point.
///
/// The integral is the midpoint rule over equal parts of at most `spacing`. At least the length, as
/// [`dag_by_cost`](super::dag_by_cost) wants it.
///
/// ```
/// use rrt_refine::{Path, refine};
/// let cost = refine::ClearanceCost { comfort: 1.0, weight: 10.0, spacing: 0.05 };
/// cost.validate()?;
/// // A wall along y = 0: the straight way hugs it, the path's own vertex keeps off.
/// let off = |p: &[f64; 2]| p[1].abs();
/// let path = Path::new(&[[0.0, 0.1], [2.0, 1.0], [4.0, 0.1]])?;
/// let free = |_: &[f64; 2], _: &[f64; 2]| true;
/// assert_eq!(refine::dag(&path, &free).path.points().len(), 2);
/// let kept = refine::dag_by_cost(&path, &free, &|a, b| cost.of(a, b, &off));
/// assert_eq!(kept.path.points().len(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearanceCost {
    /// Clearance from which on a place costs nothing extra, in the unit of the space; positive. Default 0.5 (metres).
    pub comfort: f64,
    /// Extra cost per length where the clearance is 0; 0 or more. Default 4.
    pub weight: f64,
    /// Distance of the samples along the motion; positive. Default 0.1 (metres).
    pub spacing: f64,
}

/// Most samples of one motion.
const MAX_SAMPLES: f64 = 100_000.0;

impl Default for ClearanceCost {
    fn default() -> Self {
        Self {
            comfort: 0.5,
            weight: 4.0,
            spacing: 0.1,
        }
    }
}

impl ClearanceCost {
    /// # Errors
    /// The first parameter that is out of its range.
    pub fn validate(&self) -> Result<(), RefineError> {
        positive("comfort", self.comfort)?;
        not_negative("weight", self.weight)?;
        positive("spacing", self.spacing)
    }

    /// Cost of the motion; `clearance` is asked at the middle of each part. A NaN clearance counts as 0.
    pub fn of<const D: usize>(
        &self,
        from: &[f64; D],
        to: &[f64; D],
        clearance: &impl Fn(&[f64; D]) -> f64,
    ) -> f64 {
        let length = distance(from, to);
        // Bounded, so the conversion is exact.
        let parts = (length / self.spacing).ceil().clamp(1.0, MAX_SAMPLES) as usize;
        let extra: f64 = (0..parts)
            .map(|part| {
                let middle = between(from, to, (part as f64 + 0.5) / parts as f64);
                let lack = 1.0 - clearance(&middle).max(0.0) / self.comfort;
                lack.max(0.0).powi(2)
            })
            .sum();
        length * (1.0 + self.weight * extra / parts as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_grow_from_the_length_as_clearance_shrinks() {
        let cost = ClearanceCost::default();
        let of = |clearance: f64| cost.of(&[0.0], &[2.0], &|_: &[f64; 1]| clearance);
        assert_eq!(of(0.5), 2.0);
        assert_eq!(of(f64::INFINITY), 2.0);
        assert!((of(0.25) - 4.0).abs() < 1e-12);
        assert_eq!(of(0.0), 10.0);
        assert_eq!(of(f64::NAN), of(0.0));
        assert_eq!(of(-1.0), of(0.0));
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        let bad = ClearanceCost {
            spacing: 0.0,
            ..Default::default()
        };
        assert_eq!(
            bad.validate(),
            Err(RefineError::NotPositive {
                name: "spacing",
                value: 0.0
            })
        );
    }
}
