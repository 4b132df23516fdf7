//! The drone's body as both protocols see it: movement, battery, heat, and what makes it land by itself.

use super::config::EmulatorConfig;
use super::physics::{Action, Physics};
use core::time::Duration;

/// A drone at power-on or later.
#[derive(Debug, Clone)]
pub(crate) struct Body<P> {
    pub(crate) physics: P,
    pub(crate) battery: f64,
    pub(crate) motor_time: Duration,
    pub(crate) lands_itself: bool,
    /// Up to when everything has happened.
    pub(crate) stepped: Duration,
}

/// Step of the movement while something runs.
const STEP: Duration = Duration::from_millis(20);

impl<P: Physics> Body<P> {
    pub(crate) fn new(physics: P, battery: f64) -> Self {
        Self {
            physics,
            battery,
            motor_time: Duration::ZERO,
            lands_itself: false,
            stepped: Duration::ZERO,
        }
    }

    /// Moves, drains and heats up to `at`.
    pub(crate) fn advance(&mut self, at: Duration, config: &EmulatorConfig) {
        let elapsed = at.saturating_sub(self.stepped);
        self.stepped = self.stepped.max(at);
        self.physics.advance(at);
        if self.physics.truth().motors {
            self.motor_time += elapsed;
            let drained = config.drain * elapsed.as_secs_f64() / 60.0;
            self.battery = (self.battery - drained).max(0.0);
        }
        if let Some((_, percent)) = config.faults.battery_falls.filter(|(from, _)| *from <= at) {
            self.battery = self.battery.min(percent);
        }
    }

    /// When the movement has to be looked at again.
    pub(crate) fn next_step(&self, busy: bool) -> Option<Duration> {
        (busy || self.lands_itself).then(|| self.stepped + STEP)
    }

    /// Degrees Celsius inside: 60 at power-on, a degree a minute of flight (an assumption), or the fault's.
    pub(crate) fn temperature(&self, config: &EmulatorConfig) -> f64 {
        let flown = 60.0 + (self.motor_time.as_secs_f64() / 60.0).min(20.0);
        let heat = config.faults.heat.filter(|(from, _)| *from <= self.stepped);
        heat.map_or(flown, |(_, celsius)| flown.max(celsius))
    }

    /// Too empty or too hot to fly.
    pub(crate) fn is_unfit(&self, config: &EmulatorConfig) -> bool {
        self.battery < config.min_battery || self.temperature(config) > config.max_temperature
    }

    /// Begins a landing if silence, emptiness, heat or the fault asks for one and none runs; true if it began.
    pub(crate) fn land_by_itself(
        &mut self,
        silence: Duration,
        busy: bool,
        config: &EmulatorConfig,
    ) -> bool {
        if self.lands_itself || !self.physics.truth().motors {
            return false;
        }
        let now = self.stepped;
        let silent = silence >= config.auto_land && !busy;
        let window = |at: Duration| (at..at + Duration::from_secs(1)).contains(&now);
        let forced = config.faults.auto_land_at.is_some_and(window);
        if silent || forced || self.is_unfit(config) {
            self.lands_itself = self.physics.begin(now, Action::Land).is_ok();
        }
        self.lands_itself
    }
}
