//! Charge over time.

use super::DroneConfig;

/// The battery's charge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Charge {
    percent: f64,
}

/// Drain on the ground with the motors off, percent per minute: electronics and video. Assumption.
const IDLE_DRAIN: f64 = 0.8;

impl Charge {
    pub(crate) fn new(percent: f64) -> Self {
        Self { percent }
    }

    /// Percent, 0..=100.
    pub(crate) fn percent(self) -> f64 {
        self.percent
    }

    /// Drains for `seconds` at `speed` m/s.
    pub(crate) fn drain(&mut self, config: &DroneConfig, seconds: f64, flying: bool, speed: f64) {
        let per_minute = if flying {
            config.hover_drain + config.motion_drain * speed.min(4.0)
        } else {
            IDLE_DRAIN
        };
        self.percent = (self.percent - per_minute * seconds / 60.0).max(0.0);
    }
}
