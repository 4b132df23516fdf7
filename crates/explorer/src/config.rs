//! Every constant of the mission, with unit, range and source; metric ones are turned into map units by the measured scale.

use core::time::Duration;

use exit_finder::ExitConfig;
use sparse_to_obstacles::{FreeSpaceConfig, FreeSpaceError};
use submodular_minimax::{Cues, OutlierConfig};

/// Constants of one mission. `Default` flies a Tello through rooms.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionConfig {
    /// Radius of the drone's body, metres: 0.10 for a Tello with its propellers (98 x 93 mm, propellers beyond).
    pub drone_radius_m: f64,
    /// Kept free around the body when planning, metres, at least. The points' own noise thickens obstacles by 0.1 to 0.2 m
    /// beyond this: with 0.12 half of the true doorways (0.9 m) close in the simulator. Of paths planned with 0.15 m in all in proven space
    /// of three simulated apartments the nearest to a true wall kept 0.144 m.
    pub margin_m: f64,
    /// Kept free around the body where there is room, metres: the pose errs by up to 0.1 m where little is in view.
    pub comfortable_margin_m: f64,
    /// Error at the start of a leg, metres: of the pose, about 1 % of the median range (0.02).
    pub pose_error_m: f64,
    /// How much farther off a leg ends a metre of its length: 3 degrees of heading (two standard deviations).
    pub leg_error: f64,
    /// Flying height above the ground, metres: over tables, under lintels.
    pub flight_height_m: f64,
    /// Space around the start that the operator keeps clear, metres: initialising and the triangle happen in it.
    pub start_bubble_m: f64,
    /// Yaw stick of a full turn, percent, 10..=100: 36 degrees a second on a Tello, whose picture is 55 degrees wide and smears at
    /// twice that.
    pub scan_yaw_percent: i64,
    /// Throttle stick of a full turn, percent, 10..=100: up or down once while a direction is in view.
    pub scan_throttle_percent: i64,
    /// How far a full turn goes up and down, centimetres, 20..=500: the paper's "up and down".
    pub scan_climb_cm: i64,
    /// Side of the triangle flown to fit the plane (A, v), centimetres, 20..=500.
    pub triangle_cm: i64,
    /// Cruising speed, centimetres per second, 10..=100.
    pub speed_cm_per_s: u8,
    /// Longest straight leg without a new look at the pose, metres.
    pub longest_leg_m: f64,
    /// Land at this charge wherever the drone is, percent.
    pub battery_floor_percent: u8,
    /// Charge kept for the way home beyond the floor, percent for each metre of straight distance: a metre costs about five
    /// seconds at 0.15 percent a second, half as much again for detours.
    pub battery_percent_per_meter_home: f64,
    /// Land after this time.
    pub time_budget: Duration,
    /// Land after this many scans.
    pub scan_budget: usize,
    /// Stop a leg when the pose has been unknown for this long.
    pub lost_patience: Duration,
    /// How the map becomes a scene.
    pub perception: PerceptionConfig,
    /// How exits are chosen and reached.
    pub exploration: ExplorationConfig,
}

/// Constants of map cleaning, proven-free space, obstacles and exits.
#[derive(Debug, Clone, PartialEq)]
pub struct PerceptionConfig {
    /// Outlier removal.
    pub clean: OutlierConfig,
    /// Exit finding; `min_width` is set from the drone's need when the scale is known.
    pub exits: ExitConfig,
    /// Exits are looked for among the points that keyframes within this distance of the drone saw, metres: a scan's own, with some
    /// from the way there.
    pub exit_view_m: f64,
    /// Proven-free space, metres. The library's default, but for `clearance`: the hulls keep the body clear of points, and lines of sight
    /// pass nearer to them than a body may; and but for `max_blocked_share`, as the maps of a flight drift.
    pub free_space: FreeSpaceConfig,
    /// Points to a cluster on average: K = points / this (paper: K is given, the map's size is not).
    pub points_per_cluster: usize,
    /// Clusters longer than this are split, metres, so that no hull bridges a doorway.
    pub largest_obstacle_m: f64,
}

/// Constants of choosing where to fly.
#[derive(Debug, Clone, PartialEq)]
pub struct ExplorationConfig {
    /// How far from the flying height paths may lie, metres.
    pub height_band_m: f64,
    /// An exit counts as passed within this distance of the point behind it, metres.
    pub arrival_m: f64,
    /// An approach must come nearer to its exit by this, metres, or the exit counts as blocked.
    pub least_progress_m: f64,
    /// Approaches to one exit at most.
    pub approaches: usize,
    /// Flights towards one exit that may fail, for example because the pose was lost, before it counts as blocked.
    pub failures: usize,
    /// Without an exit left, places that no site saw are scanned if they are this far from every site, metres.
    pub site_distance_m: f64,
    /// Without anything unseen left, reachable places this far from every site are scanned too, metres.
    pub far_distance_m: f64,
    /// Smallest unseen area, square metres, that is worth a scan: slivers behind furniture are not.
    pub least_unseen_m2: f64,
    /// Exits nearer than this to the flown path lead to known space, metres (reference: 0.75).
    pub known_distance_m: f64,
    /// Earlier sites see what lies this deep inside their profile, metres (reference: 0.3).
    pub known_shrink_m: f64,
    /// RRT iterations before the flood's own path is taken.
    pub rrt_iterations: usize,
    /// Longest edge of the tree, metres.
    pub rrt_step_m: f64,
}

impl Default for MissionConfig {
    fn default() -> Self {
        Self {
            drone_radius_m: 0.10,
            margin_m: 0.05,
            comfortable_margin_m: 0.25,
            pose_error_m: 0.02,
            leg_error: 0.06,
            flight_height_m: 1.3,
            start_bubble_m: 0.6,
            scan_yaw_percent: 40,
            scan_throttle_percent: 40,
            scan_climb_cm: 40,
            triangle_cm: 40,
            speed_cm_per_s: 70,
            longest_leg_m: 2.0,
            battery_floor_percent: 8,
            battery_percent_per_meter_home: 1.1,
            time_budget: Duration::from_secs(12 * 60),
            scan_budget: 60,
            lost_patience: Duration::from_millis(800),
            perception: PerceptionConfig::default(),
            exploration: ExplorationConfig::default(),
        }
    }
}

impl Default for PerceptionConfig {
    fn default() -> Self {
        Self {
            clean: cleaning(),
            exits: ExitConfig::default(),
            exit_view_m: 1.0,
            free_space: FreeSpaceConfig {
                clearance: 0.10,
                // Maps of a flight drift, and walls stand twice: with 0.5 two of six flights ended as explored at 34 and 41 %,
                // which saw 93 and 100 % without.
                max_blocked_share: 1.0,
                // Flights were measured with these.
                max_triangle_angle: 0.3,
                max_gap: f64::INFINITY,
                ..FreeSpaceConfig::default()
            },
            points_per_cluster: 12,
            largest_obstacle_m: 0.6,
        }
    }
}

impl Default for ExplorationConfig {
    fn default() -> Self {
        Self {
            height_band_m: 0.35,
            arrival_m: 0.35,
            least_progress_m: 0.4,
            approaches: 5,
            failures: 3,
            site_distance_m: 1.2,
            far_distance_m: 1.8,
            least_unseen_m2: 0.6,
            known_distance_m: 0.75,
            known_shrink_m: 0.3,
            rrt_iterations: 4000,
            rrt_step_m: 0.5,
        }
    }
}

/// Why a configuration is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// A number outside its range.
    #[error("mission configuration: {field} is {value}, it must lie in {range}")]
    OutOfRange {
        /// Which field.
        field: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// A number of proven-free space.
    #[error(transparent)]
    FreeSpace(#[from] FreeSpaceError),
}

impl MissionConfig {
    /// Checks every number against its range.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] names the first field that lies outside.
    pub fn validate(&self) -> Result<(), ConfigError> {
        within(
            "drone_radius_m",
            self.drone_radius_m,
            0.01,
            2.0,
            "0.01..=2 m",
        )?;
        within("margin_m", self.margin_m, 0.0, 2.0, "0..=2 m")?;
        within(
            "flight_height_m",
            self.flight_height_m,
            0.3,
            10.0,
            "0.3..=10 m",
        )?;
        within("start_bubble_m", self.start_bubble_m, 0.0, 10.0, "0..=10 m")?;
        for (field, percent) in [
            ("scan_yaw_percent", self.scan_yaw_percent),
            ("scan_throttle_percent", self.scan_throttle_percent),
        ] {
            within(field, percent as f64, 10.0, 100.0, "10..=100 %")?;
        }
        within(
            "scan_climb_cm",
            self.scan_climb_cm as f64,
            20.0,
            500.0,
            "20..=500 cm",
        )?;
        within(
            "triangle_cm",
            self.triangle_cm as f64,
            20.0,
            500.0,
            "20..=500 cm",
        )?;
        within(
            "speed_cm_per_s",
            f64::from(self.speed_cm_per_s),
            10.0,
            100.0,
            "10..=100 cm/s",
        )?;
        within("longest_leg_m", self.longest_leg_m, 0.2, 5.0, "0.2..=5 m")?;
        within(
            "battery_floor_percent",
            f64::from(self.battery_floor_percent),
            5.0,
            90.0,
            "5..=90 %",
        )?;
        within(
            "scan_budget",
            self.scan_budget as f64,
            1.0,
            1e6,
            "1..=1000000",
        )?;
        self.perception.validate()?;
        self.exploration.validate()
    }

    /// Radius that must be free along a leg of `meters` that is about to be flown, metres: the body, the error of the pose and the
    /// error that grows along the leg. Long legs need more room than short ones.
    #[must_use]
    pub fn flying_radius_m(&self, meters: f64) -> f64 {
        self.drone_radius_m + self.pose_error_m + self.leg_error * meters.abs()
    }

    /// Radius that a planned motion keeps free, metres, at least.
    #[must_use]
    pub fn planning_radius_m(&self) -> f64 {
        self.drone_radius_m + self.margin_m
    }

    /// Radius that paths keep free where there is room, metres.
    #[must_use]
    pub fn comfortable_radius_m(&self) -> f64 {
        self.drone_radius_m + self.comfortable_margin_m.max(self.margin_m)
    }
}

/// Points that stand before a far background are what marks a jamb or the end of a wall. The default weights for triangulated points doubt them
/// for their image neighbours' depths, which cleans best; the milder ones keep them, which flies best.
fn cleaning() -> OutlierConfig {
    let mut clean = OutlierConfig::default();
    clean.rays.triangulated = Cues::one_position();
    clean.rays.one_position = Cues::one_position();
    clean
}

impl PerceptionConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        within("exit_view_m", self.exit_view_m, 0.0, 1e3, "0..=1000 m")?;
        self.free_space.validate()?;
        within(
            "points_per_cluster",
            self.points_per_cluster as f64,
            1.0,
            1e6,
            "1..=1000000",
        )?;
        within(
            "largest_obstacle_m",
            self.largest_obstacle_m,
            0.05,
            1e3,
            "0.05..=1000 m",
        )
    }
}

impl ExplorationConfig {
    fn validate(&self) -> Result<(), ConfigError> {
        within("rrt_step_m", self.rrt_step_m, 0.01, 100.0, "0.01..=100 m")?;
        within("height_band_m", self.height_band_m, 0.0, 5.0, "0..=5 m")
    }
}

fn within(
    field: &'static str,
    value: f64,
    low: f64,
    high: f64,
    range: &'static str,
) -> Result<(), ConfigError> {
    // A NaN lies in no range.
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(ConfigError::OutOfRange {
            field,
            value,
            range,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_valid_and_nonsense_is_not() {
        assert_eq!(MissionConfig::default().validate(), Ok(()));
        for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
            let config = MissionConfig {
                drone_radius_m: bad,
                ..MissionConfig::default()
            };
            let error = config.validate().unwrap_err();
            assert!(error.to_string().contains("drone_radius_m"), "{error}");
        }
    }
}
