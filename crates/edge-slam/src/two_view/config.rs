//! What the estimate of two views can be told, and what it refuses.

use nalgebra::Point2;

/// Parameters of [`estimate_two_view`](super::estimate_two_view).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoViewConfig {
    /// Sampson distance up to which a match is an inlier, pixels, > 0. Default 1.
    pub threshold: f64,
    /// Probability of having drawn a clean sample, in (0, 1). Default 0.999.
    pub confidence: f64,
    /// Most samples drawn, >= 1. Default 500.
    pub max_samples: usize,
    /// Fewest inliers of a pose, >= 6. Default 20.
    pub min_inliers: usize,
    /// Fewest inliers of a pose that is trusted. Default 50 (Mur-Artal et al. 2015 ask for as many points).
    pub min_confident_inliers: usize,
    /// Least share of inliers in front of both cameras, 0..=1. Default 0.7.
    pub min_in_front: f64,
    /// Least share of all matches that must be inliers, 0..=1. Default 0.4: with fewer, outliers that agree by
    /// chance choose the direction.
    pub min_inlier_share: f64,
    /// Least median angle between matched rays, radians, >= 0. Default 1.5 degrees: of pairs of a hand-held
    /// sequence with a true baseline under 1 cm, those above are rare.
    pub min_parallax: f64,
    /// Homography scores above this share call the scene planar, 0..=1. Default 0.45 (Mur-Artal et al. 2015).
    pub planar_share: f64,
    /// Least median angle left between matched rays after the rotation that explains them best, radians, >= 0. Default
    /// 0.2 degrees: 99 % of the pairs of a hand-held sequence that are 0.15 m apart have more, and errors of lens and
    /// shutter, which a turning camera shows as parallax, make less.
    pub min_residual_parallax: f64,
    /// What is added to `min_residual_parallax` per radian of turn, >= 0: a camera model that is not quite right shows a turn
    /// as parallax in proportion. Default 0.01, chosen among 0.005 to 0.02 on recorded turns; it is also what a
    /// focal length that is wrong by a tenth leaves at most (simulated turns about either axis, a picture of 63 by 49 degrees;
    /// half as much for a twentieth).
    pub residual_per_turn: f64,
    /// Greatest standard deviation of the direction of travel, radians, > 0. Default 10 degrees, under which 98 % of
    /// the same pairs are.
    pub max_direction_sigma: f64,
    /// Least [`TwoView::margin`](super::TwoView::margin) against another direction of travel, standard deviations. Default 1: the least of 0.5 to 3
    /// that left no wrong direction among the pairs on which it was chosen.
    pub min_margin: f64,
    /// A rotation that explains this share of the inliers, within twice the threshold, is the whole motion,
    /// 0..=1. Default 0.8.
    pub rotation_share: f64,
}

impl Default for TwoViewConfig {
    fn default() -> Self {
        Self {
            threshold: 1.0,
            confidence: 0.999,
            max_samples: 500,
            min_inliers: 20,
            min_confident_inliers: 50,
            min_in_front: 0.7,
            min_inlier_share: 0.4,
            min_parallax: 1.5_f64.to_radians(),
            min_residual_parallax: 0.2_f64.to_radians(),
            residual_per_turn: 0.01,
            max_direction_sigma: 10_f64.to_radians(),
            min_margin: 1.0,
            planar_share: 0.45,
            rotation_share: 0.8,
        }
    }
}

/// Why no relative pose was estimated.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TwoViewError {
    /// The two slices differ in length.
    #[error("{first} pixels of the first view cannot be matched with {second} of the second")]
    LengthMismatch {
        /// Pixels of the first view.
        first: usize,
        /// Pixels of the second view.
        second: usize,
    },
    /// A coordinate is NaN, infinite, or beyond 1e9 pixels.
    #[error("match {index} has a coordinate that is not finite or beyond 1e9 pixels")]
    NonFinite {
        /// Which match.
        index: usize,
    },
    /// Not enough matches agree.
    #[error(
        "{inliers} matches agree with one motion, {needed} are needed; take frames that overlap more"
    )]
    TooFewInliers {
        /// Matches that agree.
        inliers: usize,
        /// Matches needed.
        needed: usize,
    },
    /// A parameter is outside its range.
    #[error("{name} is {value}, but must be {range}")]
    Parameter {
        /// Field of the configuration.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
}

impl TwoViewConfig {
    /// Errs at the first field outside its range. A limit that is NaN would refuse nothing.
    ///
    /// # Errors
    /// [`TwoViewError::Parameter`].
    #[expect(clippy::cast_precision_loss, reason = "only compared and shown")]
    pub fn validate(&self) -> Result<(), TwoViewError> {
        let most = f64::MAX;
        let least = f64::MIN_POSITIVE;
        let share = [0.0, 1.0];
        let samples = self.max_samples as f64;
        let inliers = self.min_inliers as f64;
        let fields = [
            (
                "threshold",
                self.threshold,
                [least, 1e6],
                "positive and at most 1e6",
            ),
            (
                "confidence",
                self.confidence,
                [least, 1_f64.next_down()],
                "between 0 and 1",
            ),
            ("max_samples", samples, [1.0, most], "at least 1"),
            ("min_inliers", inliers, [6.0, most], "at least 6"),
            ("min_in_front", self.min_in_front, share, "in 0..=1"),
            ("min_inlier_share", self.min_inlier_share, share, "in 0..=1"),
            ("min_parallax", self.min_parallax, [0.0, most], "0 or more"),
            ("planar_share", self.planar_share, share, "in 0..=1"),
            (
                "min_residual_parallax",
                self.min_residual_parallax,
                [0.0, most],
                "0 or more",
            ),
            (
                "residual_per_turn",
                self.residual_per_turn,
                [0.0, most],
                "0 or more",
            ),
            (
                "max_direction_sigma",
                self.max_direction_sigma,
                [least, f64::INFINITY],
                "positive",
            ),
            (
                "min_margin",
                self.min_margin,
                [f64::NEG_INFINITY, f64::INFINITY],
                "a number",
            ),
            ("rotation_share", self.rotation_share, share, "in 0..=1"),
        ];
        for (name, value, [low, high], range) in fields {
            if !(value >= low && value <= high) {
                return Err(TwoViewError::Parameter { name, value, range });
            }
        }
        Ok(())
    }
}

/// Errs at the first thing that makes an estimate impossible.
pub(super) fn check(
    first: &[Point2<f64>],
    second: &[Point2<f64>],
    config: &TwoViewConfig,
) -> Result<(), TwoViewError> {
    if first.len() != second.len() {
        return Err(TwoViewError::LengthMismatch {
            first: first.len(),
            second: second.len(),
        });
    }
    let usable = |p: &Point2<f64>| p.x.abs() < 1e9 && p.y.abs() < 1e9;
    if let Some(index) = first
        .iter()
        .zip(second)
        .position(|(a, b)| !(usable(a) && usable(b)))
    {
        return Err(TwoViewError::NonFinite { index });
    }
    config.validate()
}
