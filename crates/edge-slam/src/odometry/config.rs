//! What the odometry can be told, and what it refuses.

use crate::feature::{AlignConfig, KltConfig, MatchConfig, OrbConfig, OrbConfigError, Selection};
use crate::pnp::{PnpConfig, PnpError};
use crate::two_view::{TwoViewConfig, TwoViewError};

/// How a frame's features are found again.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Tracker {
    /// ORB in every frame, matched with the keyframe's.
    #[default]
    Orb,
    /// The keyframe's patches are followed; ORB's corners are sought in keyframes only.
    Klt(KltConfig),
}

/// Parameters of [`super::Odometry`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdometryConfig {
    /// Features of each frame. Default 1,000, chosen by [`Selection::Balanced`].
    pub orb: OrbConfig,
    /// How the keyframe's features are found in a frame. Default [`Tracker::Orb`].
    pub tracker: Tracker,
    /// Matching of a frame with its keyframe.
    pub matching: MatchConfig,
    /// How the places of matches are made to agree below a pixel; `None` leaves them where the detector found them. Of use with
    /// [`Tracker::Orb`] only: KLT follows patches anyway. Default: [`AlignConfig::default`].
    pub align: Option<AlignConfig>,
    /// Monocular start and recovery.
    pub two_view: TwoViewConfig,
    /// Pose of a frame.
    pub pnp: PnpConfig,
    /// Share of the keyframe's first count of inliers under which a new keyframe is made, 0..=1. Default 0.6.
    pub keyframe_share: f64,
    /// Inliers under which a new keyframe is made; without measured depth only when they are also a smaller share of the most than 0.85: a
    /// keyframe that began with few points would give way to every frame, none of them far enough from the next to triangulate. Default 60.
    pub keyframe_inliers: usize,
    /// Points farther than this are left out, metres or units, > 0. Default 10.
    pub farthest: f64,
    /// Least angle of triangulation, radians, > 0. Default 1 degree.
    pub least_angle: f64,
    /// Lost frames after which a new map is begun, >= 1. Default 5.
    pub patience: usize,
}

impl Default for OdometryConfig {
    fn default() -> Self {
        Self {
            orb: OrbConfig {
                selection: Selection::Balanced,
                ..OrbConfig::default()
            },
            tracker: Tracker::default(),
            matching: MatchConfig::default(),
            align: Some(AlignConfig::default()),
            two_view: TwoViewConfig::default(),
            pnp: PnpConfig {
                min_inliers: 15,
                ..PnpConfig::default()
            },
            keyframe_share: 0.6,
            keyframe_inliers: 60,
            farthest: 10.0,
            least_angle: 1_f64.to_radians(),
            patience: 5,
        }
    }
}

/// Why no odometry can be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OdometryError {
    /// A field of the feature extractor.
    #[error(transparent)]
    Orb(#[from] OrbConfigError),
    /// A field of the two-view estimate.
    #[error("two_view: {0}")]
    TwoView(#[from] TwoViewError),
    /// A field of the pose's refinement.
    #[error("pnp: {0}")]
    Pnp(#[from] PnpError),
    /// Another field.
    #[error("{name} is {value}, but must be {range}")]
    Parameter {
        /// Field.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
}

impl OdometryConfig {
    /// Errs at the first field outside its range.
    ///
    /// # Errors
    /// [`OdometryError`].
    pub fn validate(&self) -> Result<(), OdometryError> {
        self.orb.validate()?;
        self.two_view.validate()?;
        self.pnp.validate()?;
        #[expect(clippy::cast_precision_loss, reason = "only shown in a message")]
        let patience = self.patience as f64;
        let share = self.keyframe_share;
        let fields = [
            (
                "keyframe_share",
                share,
                (0.0..=1.0).contains(&share),
                "in 0..=1",
            ),
            ("farthest", self.farthest, self.farthest > 0.0, "positive"),
            (
                "least_angle",
                self.least_angle,
                self.least_angle > 0.0,
                "positive",
            ),
            ("patience", patience, self.patience > 0, "at least 1"),
        ];
        match fields.into_iter().find(|field| !field.2) {
            Some((name, value, _, range)) => Err(OdometryError::Parameter { name, value, range }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_is_checked() {
        let good = OdometryConfig::default();
        assert_eq!(good.validate(), Ok(()));
        let mut bad = good;
        bad.two_view.min_margin = f64::NAN;
        assert!(matches!(bad.validate(), Err(OdometryError::TwoView(_))));
        let mut bad = good;
        bad.pnp.huber = 0.0;
        assert!(matches!(bad.validate(), Err(OdometryError::Pnp(_))));
        let mut bad = good;
        bad.orb.features = 0;
        assert!(matches!(bad.validate(), Err(OdometryError::Orb(_))));
        let mut bad = good;
        bad.farthest = f64::NAN;
        let name = "farthest";
        assert!(
            matches!(bad.validate(), Err(OdometryError::Parameter { name: found, .. }) if found == name)
        );
    }
}
