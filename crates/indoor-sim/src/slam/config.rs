//! Numbers of the SLAM stand-in, all of them parameters.

use core::time::Duration;

use crate::ConfigError;
use crate::config_error::within;

/// How good, and how bad, the stand-in for a sparse monocular SLAM system is.
#[derive(Debug, Clone, PartialEq)]
pub struct SlamConfig {
    /// Corners that the detector keeps per picture, the strongest first, 50..=100000. ORB-SLAM's usual setting is 1000.
    pub feature_budget: usize,
    /// Chance that a detected corner of middling contrast is matched to its map point in a picture, 0..=1; faint corners are
    /// matched half as often.
    pub match_chance: f64,
    /// Chance that a pair of keyframes triangulates a corner that both see with enough parallax, 0..=1.
    pub triangulation_chance: f64,
    /// Least angle between two rays that makes a point, rad, 0..=0.5. ORB-SLAM: about 1 degree.
    pub least_parallax: f64,
    /// Standard deviation of a corner's place in the picture, pixels, 0..=20.
    pub pixel_noise: f64,
    /// Standard deviation of the error along the ray that no number of views removes, relative to the range, 0..=0.5.
    pub depth_floor: f64,
    /// Share of map points that are wrong matches, 0..=0.9.
    pub outlier_rate: f64,
    /// Standard deviation of a frame's position, relative to the median range of what it tracks, 0..=0.2.
    pub pose_noise: f64,
    /// Standard deviation of a frame's attitude per axis, rad, 0..=0.2.
    pub attitude_noise: f64,
    /// Drift of the position per metre flown where no old point is in view, metres, 0..=0.5.
    pub drift_per_meter: f64,
    /// Drift of the heading per radian turned where no old point is in view, rad, 0..=0.5. There is no drift of scale.
    pub drift_per_radian: f64,
    /// Least and greatest length of a metre in map units; drawn anew, evenly in its logarithm, for each epoch; 0.001..=1000.
    pub scale: (f64, f64),
    /// Least number of corners that two pictures must share to begin a map, 20..=10000. ORB-SLAM: 100.
    pub least_common: usize,
    /// Least distance between the two pictures that begin a map, metres, 0.01..=5: hovering must never do.
    pub least_baseline: f64,
    /// Tracking counts as failing below this number of tracked points, 4..=1000.
    pub least_tracked: usize,
    /// Lost after failing for this long.
    pub patience: Duration,
    /// Number of known points in view that ends a loss, 4..=10000.
    pub relocalization_points: usize,
    /// Forgets the map and begins a new epoch after being lost for this long; `None` waits for ever.
    pub reset_after: Option<Duration>,
}

impl Default for SlamConfig {
    fn default() -> Self {
        Self {
            feature_budget: 1000,
            match_chance: 0.85,
            triangulation_chance: 0.6,
            least_parallax: 1.0_f64.to_radians(),
            pixel_noise: 1.5,
            depth_floor: 0.038,
            outlier_rate: 0.10,
            pose_noise: 0.004,
            attitude_noise: 0.15_f64.to_radians(),
            drift_per_meter: 0.005,
            drift_per_radian: 0.3 / 90.0,
            scale: (0.2, 5.0),
            least_common: 100,
            least_baseline: 0.10,
            least_tracked: 20,
            patience: Duration::from_millis(500),
            relocalization_points: 40,
            reset_after: None,
        }
    }
}

impl SlamConfig {
    /// No noise, no outliers, no drift, one map unit a metre: for tests that need to know the answer.
    #[must_use]
    pub fn exact() -> Self {
        Self {
            match_chance: 1.0,
            triangulation_chance: 1.0,
            pixel_noise: 0.0,
            depth_floor: 0.0,
            outlier_rate: 0.0,
            pose_noise: 0.0,
            attitude_noise: 0.0,
            drift_per_meter: 0.0,
            drift_per_radian: 0.0,
            scale: (1.0, 1.0),
            ..Self::default()
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] names the first number that is out of its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        within("slam.feature_budget", self.feature_budget as f64, 50.0, 1e5)?;
        within("slam.match_chance", self.match_chance, 0.0, 1.0)?;
        within(
            "slam.triangulation_chance",
            self.triangulation_chance,
            0.0,
            1.0,
        )?;
        within("slam.least_parallax", self.least_parallax, 0.0, 0.5)?;
        within("slam.pixel_noise", self.pixel_noise, 0.0, 20.0)?;
        within("slam.depth_floor", self.depth_floor, 0.0, 0.5)?;
        within("slam.outlier_rate", self.outlier_rate, 0.0, 0.9)?;
        within("slam.pose_noise", self.pose_noise, 0.0, 0.2)?;
        within("slam.attitude_noise", self.attitude_noise, 0.0, 0.2)?;
        within("slam.drift_per_meter", self.drift_per_meter, 0.0, 0.5)?;
        within("slam.drift_per_radian", self.drift_per_radian, 0.0, 0.5)?;
        within("slam.scale.0", self.scale.0, 1e-3, 1e3)?;
        within("slam.scale.1", self.scale.1, self.scale.0, 1e3)?;
        within("slam.least_common", self.least_common as f64, 20.0, 1e4)?;
        within("slam.least_baseline", self.least_baseline, 0.01, 5.0)?;
        within("slam.least_tracked", self.least_tracked as f64, 4.0, 1e3)?;
        within(
            "slam.relocalization_points",
            self.relocalization_points as f64,
            4.0,
            1e4,
        )
    }
}
