//! Numbers of the simulated drone, all of them parameters.

use core::time::Duration;

use crate::ConfigError;
use crate::config_error::within;

/// How the drone moves, errs and drains its battery. The defaults are published figures of the Tello where there are
/// any; the ones marked "assumption" have no trustworthy source.
#[derive(Debug, Clone, PartialEq)]
pub struct DroneConfig {
    /// Radius of the ball that stands for the body, metres, 0.02..=0.5.
    pub radius: f64,
    /// Speed of moves without a speed of their own until `speed` changes it, m/s, 0.1..=1.
    pub speed: f64,
    /// Acceleration of moves, m/s², 0.2..=5. Assumption: gives the published peak 0.8 to 1 s after a `forward`.
    pub acceleration: f64,
    /// Turning speed, rad/s, 0.1..=6. About 90 degrees/s at most by the tello_pilot experiments.
    pub yaw_rate: f64,
    /// Time between a command and the first motion, 0..=2 s. 0.3 to 0.4 s measured by users.
    pub dead_time: Duration,
    /// Hovering at the end of a move before the reply, 0..=5 s. Assumption.
    pub settle_time: Duration,
    /// Standard deviation of a move's length relative to what was commanded, 0..=0.3. Users: 90 cm give 85 to 95 cm.
    pub distance_error: f64,
    /// Standard deviation of a move's direction and of a turn's angle, rad, 0..=0.3. Assumption: 1.5 degrees.
    pub heading_error: f64,
    /// Standard deviation of the wandering about the hover point, metres per axis, 0..=0.5. Assumption.
    pub hover_wander: f64,
    /// Time in which the wandering forgets where it was, seconds, 0.1..=60. Assumption.
    pub wander_time: f64,
    /// Lowest and highest height reached by a take-off, metres, 0.3..=2.
    pub takeoff_height: (f64, f64),
    /// Duration of a take-off. 3.89 s measured by a user.
    pub takeoff_time: Duration,
    /// Duration of a landing from take-off height; higher ones take as much longer. 1.66 s measured by a user.
    pub landing_time: Duration,
    /// Lowest hover above the floor, metres, 0.1..=1. Flight logs: about 0.27.
    pub lowest_hover: f64,
    /// Speed at full deflection of a stick, m/s, 0.1..=4. Assumption for the text protocol's slow mode.
    pub stick_speed: f64,
    /// Charge at the start, percent, 0..=100.
    pub battery_percent: f64,
    /// Drain while hovering, percent per minute, 0..=100. 7.7 follows from the vendor's 13 min; 10 to 13 min are usual.
    pub hover_drain: f64,
    /// Further drain at 1 m/s, percent per minute, 0..=100. Assumption.
    pub motion_drain: f64,
    /// Take-off is refused below this charge, percent, 0..=100.
    pub takeoff_percent: f64,
    /// The drone lands by itself at this charge, percent, 0..=100.
    pub landing_percent: f64,
    /// The drone lands by itself after this long in the air without any command; `None` never. The manual says 15 s.
    pub silence_limit: Option<Duration>,
    /// A move that lasts longer fails with `error Run timeout`; `None` never. Users: about 15 s.
    pub move_limit: Option<Duration>,
}

impl Default for DroneConfig {
    fn default() -> Self {
        Self {
            radius: 0.10,
            speed: 0.5,
            acceleration: 1.2,
            yaw_rate: 90.0_f64.to_radians(),
            dead_time: Duration::from_millis(350),
            settle_time: Duration::from_millis(500),
            distance_error: 0.025,
            heading_error: 1.5_f64.to_radians(),
            hover_wander: 0.012,
            wander_time: 2.0,
            takeoff_height: (0.8, 1.0),
            takeoff_time: Duration::from_millis(3890),
            landing_time: Duration::from_millis(1660),
            lowest_hover: 0.27,
            stick_speed: 1.0,
            battery_percent: 100.0,
            hover_drain: 8.0,
            motion_drain: 1.5,
            takeoff_percent: 10.0,
            landing_percent: 5.0,
            silence_limit: Some(Duration::from_secs(15)),
            move_limit: Some(Duration::from_secs(15)),
        }
    }
}

impl DroneConfig {
    /// A drone that does exactly what it is told, for tests that need to know where it ends.
    #[must_use]
    pub fn exact() -> Self {
        Self {
            distance_error: 0.0,
            heading_error: 0.0,
            hover_wander: 0.0,
            ..Self::default()
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] names the first number that is out of its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        within("drone.radius", self.radius, 0.02, 0.5)?;
        within("drone.speed", self.speed, 0.1, 1.0)?;
        within("drone.acceleration", self.acceleration, 0.2, 5.0)?;
        within("drone.yaw_rate", self.yaw_rate, 0.1, 6.0)?;
        within("drone.dead_time", self.dead_time.as_secs_f64(), 0.0, 2.0)?;
        within(
            "drone.settle_time",
            self.settle_time.as_secs_f64(),
            0.0,
            5.0,
        )?;
        within("drone.distance_error", self.distance_error, 0.0, 0.3)?;
        within("drone.heading_error", self.heading_error, 0.0, 0.3)?;
        within("drone.hover_wander", self.hover_wander, 0.0, 0.5)?;
        within("drone.wander_time", self.wander_time, 0.1, 60.0)?;
        within("drone.takeoff_height.0", self.takeoff_height.0, 0.3, 2.0)?;
        within(
            "drone.takeoff_height.1",
            self.takeoff_height.1,
            self.takeoff_height.0,
            2.0,
        )?;
        within(
            "drone.takeoff_time",
            self.takeoff_time.as_secs_f64(),
            0.5,
            20.0,
        )?;
        within(
            "drone.landing_time",
            self.landing_time.as_secs_f64(),
            0.5,
            20.0,
        )?;
        within("drone.lowest_hover", self.lowest_hover, 0.1, 1.0)?;
        within("drone.stick_speed", self.stick_speed, 0.1, 4.0)?;
        within("drone.battery_percent", self.battery_percent, 0.0, 100.0)?;
        within("drone.hover_drain", self.hover_drain, 0.0, 100.0)?;
        within("drone.motion_drain", self.motion_drain, 0.0, 100.0)?;
        within("drone.takeoff_percent", self.takeoff_percent, 0.0, 100.0)?;
        within("drone.landing_percent", self.landing_percent, 0.0, 100.0)
    }
}
