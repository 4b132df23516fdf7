//! Preflight: everything that would make a take-off fail or a flight end early, found beforehand.

use crate::telemetry::Telemetry;
use alloc::vec::Vec;
use core::time::Duration;

/// Something that speaks against taking off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Finding {
    /// No state line came, or none lately.
    #[error(
        "no fresh state line (last one {age_ms:?} ms ago): check that the state port is open in the firewall and not in use, and that this machine is in the drone's network"
    )]
    NoState {
        /// Age of the newest value, ms; `None` if there was none.
        age_ms: Option<u64>,
    },
    /// The battery is too low for a take-off.
    #[error("battery at {percent} %, at least {needed} % needed")]
    Battery {
        /// Charge, percent.
        percent: u8,
        /// Needed, percent.
        needed: u8,
    },
    /// The drone is too hot.
    #[error("temperature {celsius} C, at most {allowed} C: let it cool")]
    Temperature {
        /// Highest temperature, degrees Celsius.
        celsius: i16,
        /// Allowed, degrees Celsius.
        allowed: i16,
    },
    /// The attitude sensor is not warm yet.
    #[error(
        "heard for {heard_s} s only: the attitude sensor needs about {needed_s} s after power-on"
    )]
    WarmUp {
        /// Time since the first state line, s.
        heard_s: u64,
        /// Needed, s.
        needed_s: u64,
    },
    /// The video brings no pictures.
    #[error(
        "no key frame of the video (last one {age_ms:?} ms ago): send `streamon`, and check that the video port is open in the firewall"
    )]
    NoVideo {
        /// Age of the newest key frame, ms; `None` if there was none.
        age_ms: Option<u64>,
    },
    /// It stands on a slope or is held.
    #[error("tilted by {degrees} degrees: put it on level ground")]
    Tilted {
        /// Largest of pitch and roll, whole degrees.
        degrees: u16,
    },
}

/// What is asked for before a take-off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PreflightConfig {
    /// Least charge, percent. Default 20.
    pub min_battery: u8,
    /// Highest temperature, degrees Celsius. Default 80.
    pub max_temperature: i16,
    /// Time to wait after the first state line. Default zero; a drone just switched on needs about 20 s.
    pub warm_up: Duration,
    /// Oldest acceptable state line. Default 1 s.
    pub max_age: Duration,
    /// Largest pitch or roll, degrees. Default 20.
    pub max_tilt_degrees: u16,
}

impl Default for PreflightConfig {
    fn default() -> Self {
        Self {
            min_battery: 20,
            max_temperature: 80,
            warm_up: Duration::ZERO,
            max_age: Duration::from_secs(1),
            max_tilt_degrees: 20,
        }
    }
}

/// Lists what speaks against taking off now; empty means go. `first_state` is when the first state line came.
#[must_use]
pub fn preflight(
    config: &PreflightConfig,
    telemetry: &Telemetry,
    first_state: Option<Duration>,
    now: Duration,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let age = telemetry.attitude.map(|reading| reading.age(now));
    if age.is_none_or(|age| age > config.max_age) {
        findings.push(Finding::NoState {
            age_ms: age.map(|age| age.as_millis() as u64),
        });
    }
    let heard = now.saturating_sub(first_state.unwrap_or(now));
    if heard < config.warm_up {
        findings.push(Finding::WarmUp {
            heard_s: heard.as_secs(),
            needed_s: config.warm_up.as_secs(),
        });
    }
    if let Some(battery) = telemetry.battery {
        let percent = battery.value.percent();
        if percent < config.min_battery {
            findings.push(Finding::Battery {
                percent,
                needed: config.min_battery,
            });
        }
    }
    if let Some(temperature) = telemetry.temperature {
        let (celsius, allowed) = (temperature.value.high_c, config.max_temperature);
        if celsius > allowed {
            findings.push(Finding::Temperature { celsius, allowed });
        }
    }
    if let Some(attitude) = telemetry.attitude {
        let degrees = attitude
            .value
            .pitch_deg
            .abs()
            .max(attitude.value.roll_deg.abs()) as u16;
        if degrees > config.max_tilt_degrees {
            findings.push(Finding::Tilted { degrees });
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::{Attitude, Source, Temperature};
    use crate::units::Battery;

    #[test]
    fn everything_wrong_is_listed_and_a_good_drone_passes() {
        let now = Duration::from_secs(5);
        let config = PreflightConfig {
            warm_up: Duration::from_secs(20),
            ..Default::default()
        };
        let bad = Telemetry::builder(Duration::ZERO, Source::TextState)
            .attitude(Attitude {
                pitch_deg: -30.0,
                ..Attitude::default()
            })
            .battery(Battery::from_percent(5).unwrap())
            .temperature(Temperature {
                low_c: 80,
                high_c: 85,
            })
            .build();
        assert_eq!(preflight(&config, &bad, Some(Duration::ZERO), now).len(), 5);
        let good = Telemetry::builder(now, Source::TextState)
            .attitude(Attitude::default())
            .battery(Battery::from_percent(80).unwrap())
            .build();
        assert!(preflight(&PreflightConfig::default(), &good, Some(now), now).is_empty());
        let none = preflight(
            &PreflightConfig::default(),
            &Telemetry::default(),
            None,
            now,
        );
        assert_eq!(none, [Finding::NoState { age_ms: None }]);
    }
}
