//! How far a path stays from obstacles: samples along it, and a bound that holds between the samples.

use super::resample::{bounded, positive};
use super::{Path, PathError};
use crate::euclid::{between, distance};

/// Clearance along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct ClearanceProfile {
    /// Samples in order: distance along the path and clearance there. Vertices are among them.
    pub samples: Vec<ClearanceSample>,
    /// Least clearance of a sample.
    pub min: f64,
    /// No point of the path has less clearance than this, provided that clearance is a distance (it changes by at most the
    /// distance moved).
    pub at_least: f64,
}

/// One sample of a [`ClearanceProfile`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearanceSample {
    /// Distance from the start, along the path.
    pub along: f64,
    /// Clearance at that place.
    pub clearance: f64,
}

impl<const D: usize> Path<D> {
    /// Clearance at the vertices and at places between them, at most `spacing` apart.
    ///
    /// A NaN clearance counts as −∞: nothing is known to be free there.
    ///
    /// ```
    /// use rrt_refine::Path;
    /// let path = Path::new(&[[0.0, 2.0], [4.0, 2.0]])?;
    /// // An obstacle point at (2, 0).
    /// let profile = path.clearance_profile(0.5, |p| ((p[0] - 2.0).powi(2) + p[1].powi(2)).sqrt())?;
    /// assert_eq!(profile.min, 2.0);
    /// assert!(profile.at_least > 1.75);
    /// # Ok::<(), rrt_refine::PathError>(())
    /// ```
    ///
    /// # Errors
    /// A spacing that is not positive and finite, or so small that more than ten million samples were needed.
    pub fn clearance_profile(
        &self,
        spacing: f64,
        clearance: impl Fn(&[f64; D]) -> f64,
    ) -> Result<ClearanceProfile, PathError> {
        positive("spacing", spacing)?;
        bounded(self.length() / spacing + self.points().len() as f64)?;
        let known = |point: &[f64; D]| Some(clearance(point)).filter(|c| !c.is_nan());
        let at = |point: &[f64; D]| known(point).unwrap_or(f64::NEG_INFINITY);
        let first = at(&self.start());
        let mut profile = ClearanceProfile {
            samples: vec![ClearanceSample {
                along: 0.0,
                clearance: first,
            }],
            min: first,
            at_least: first,
        };
        let (mut walked, mut last) = (0.0, first);
        for (a, b) in self.segments() {
            let length = distance(a, b);
            let parts = (length / spacing).ceil().max(1.0) as usize;
            for part in 1..=parts {
                let share = part as f64 / parts as f64;
                let here = at(&between(a, b, share));
                profile.samples.push(ClearanceSample {
                    along: walked + length * share,
                    clearance: here,
                });
                profile.min = profile.min.min(here);
                profile.at_least =
                    profile
                        .at_least
                        .min(between_samples(last, here, length / parts as f64));
                last = here;
            }
            walked += length;
        }
        Ok(profile)
    }
}

/// Least clearance between two places `gap` apart, for a clearance that is a distance.
pub(crate) fn between_samples(a: f64, b: f64, gap: f64) -> f64 {
    ((a + b - gap) / 2.0).min(a).min(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_holds_between_samples() -> Result<(), PathError> {
        let path = Path::new(&[[0.0, 1.0], [3.0, 1.0], [3.0, 5.0]])?;
        let clearance = |p: &[f64; 2]| distance(p, &[1.13, 0.0]);
        let fine = path.clearance_profile(1e-3, clearance)?;
        for spacing in [0.1, 0.7, 10.0] {
            let profile = path.clearance_profile(spacing, clearance)?;
            assert!(profile.at_least <= fine.min + 1e-9);
            assert!(profile.min >= fine.min - 1e-3);
        }
        Ok(())
    }

    #[test]
    fn unknown_clearance_is_none() -> Result<(), PathError> {
        let path = Path::new(&[[0.0]])?;
        let profile = path.clearance_profile(0.1, |_| f64::NAN)?;
        assert_eq!(profile.min, f64::NEG_INFINITY);
        assert_eq!(profile.samples.len(), 1);
        Ok(())
    }

    #[test]
    fn unbounded_clearance_stays_unbounded() -> Result<(), PathError> {
        let profile = Path::new(&[[0.0], [1.0]])?.clearance_profile(0.3, |_| f64::INFINITY)?;
        assert_eq!(profile.at_least, f64::INFINITY);
        Ok(())
    }
}
