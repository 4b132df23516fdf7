//! Alarms: conditions, checked at every input while the motors turn, that make the session land.

use crate::telemetry::Telemetry;
use core::time::Duration;

/// Why the session lands by itself.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Alarm {
    /// The battery is low.
    #[error("battery at {percent} %, limit {limit} %")]
    Battery {
        /// Charge now, percent.
        percent: u8,
        /// Limit, percent.
        limit: u8,
    },
    /// The drone is too hot.
    #[error("temperature {celsius} C, limit {limit} C")]
    Temperature {
        /// Highest temperature, degrees Celsius.
        celsius: i16,
        /// Limit, degrees Celsius.
        limit: i16,
    },
    /// The drone says that it is too hot (binary protocol: without a number).
    #[error("the drone says that it is too hot")]
    Hot,
    /// The drone is too high.
    #[error("height {centimeters} cm, limit {limit} cm")]
    Height {
        /// Height, cm.
        centimeters: i32,
        /// Limit, cm.
        limit: i32,
    },
    /// The flight is too long.
    #[error("flying for {seconds} s, limit {limit} s")]
    FlightTime {
        /// Time since the motors started, s.
        seconds: u64,
        /// Limit, s.
        limit: u64,
    },
    /// The reported position is outside the fence.
    #[error("position {distance_cm} cm outside the fence")]
    Fence {
        /// How far outside the box, cm.
        distance_cm: u32,
    },
    /// Nothing is heard from the drone.
    #[error("nothing heard from the drone for {milliseconds} ms")]
    LinkSilence {
        /// How long, ms.
        milliseconds: u64,
    },
    /// The owner's heartbeat stopped.
    #[error("no heartbeat for {milliseconds} ms")]
    Heartbeat {
        /// How long, ms.
        milliseconds: u64,
    },
}

impl Eq for Alarm {}

/// A box, in the frame of the positions that the caller reports, metres.
pub type Fence = ([f64; 3], [f64; 3]);

/// Limits of a flight; `None` switches a check off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SafetyConfig {
    /// Land below this charge, percent. Default 10.
    pub min_battery: Option<u8>,
    /// Land above this temperature, degrees Celsius. Default 90 (no limit is published; the drone shuts down by itself).
    pub max_temperature: Option<i16>,
    /// Land above this height, metres. Default 5: indoor use.
    pub max_height: Option<f64>,
    /// Land after this time since the motors started. Default 12 min (13 min is the maker's maximum).
    pub max_flight_time: Option<Duration>,
    /// Land when nothing was heard for this long. Default 3 s.
    pub link_silence: Option<Duration>,
    /// Land when a position given to [`Session::report_position`](crate::Session::report_position) leaves this box
    /// (lowest and highest corner). Default none: the text protocol itself has no position.
    pub fence: Option<Fence>,
}

impl Default for SafetyConfig {
    fn default() -> Self {
        Self {
            min_battery: Some(10),
            max_temperature: Some(90),
            max_height: Some(5.0),
            max_flight_time: Some(Duration::from_secs(12 * 60)),
            link_silence: Some(Duration::from_secs(3)),
            fence: None,
        }
    }
}

/// Watches a flight; latches the first alarm until acknowledged.
#[derive(Debug, Clone, Default)]
pub(crate) struct Guard {
    flying_since: Option<Duration>,
    latched: Option<Alarm>,
}

impl Guard {
    pub(crate) fn latched(&self) -> Option<Alarm> {
        self.latched
    }

    pub(crate) fn acknowledge(&mut self) {
        self.latched = None;
    }

    /// The motors were seen to turn or to stand; without knowledge nothing changes.
    pub(crate) fn motors(&mut self, now: Duration, turning: Option<bool>) {
        match turning {
            Some(true) => self.flying_since = self.flying_since.or(Some(now)),
            Some(false) => self.flying_since = None,
            None => {}
        }
    }

    pub(crate) fn is_flying(&self) -> bool {
        self.flying_since.is_some()
    }

    /// Raises an alarm from outside; true if none was latched.
    pub(crate) fn raise(&mut self, alarm: Alarm) -> bool {
        let first = self.latched.is_none();
        self.latched = self.latched.or(Some(alarm));
        first
    }

    /// When time alone will raise an alarm.
    pub(crate) fn deadline(&self, config: &SafetyConfig, heard: Duration) -> Option<Duration> {
        let since = self.flying_since?;
        if self.latched.is_some() {
            return None;
        }
        let time = config.max_flight_time.map(|limit| since + limit);
        let link = config.link_silence.map(|limit| heard + limit);
        time.into_iter().chain(link).min()
    }

    /// Checks everything; returns a new alarm once.
    pub(crate) fn check(
        &mut self,
        now: Duration,
        config: &SafetyConfig,
        telemetry: &Telemetry,
        heard: Duration,
    ) -> Option<Alarm> {
        let since = self.flying_since?;
        if self.latched.is_some() {
            return None;
        }
        let alarm =
            time_alarm(now, since, config, heard).or_else(|| value_alarm(config, telemetry));
        self.latched = alarm;
        alarm
    }
}

fn time_alarm(
    now: Duration,
    since: Duration,
    config: &SafetyConfig,
    heard: Duration,
) -> Option<Alarm> {
    let silence = now.saturating_sub(heard);
    if config.link_silence.is_some_and(|limit| silence >= limit) {
        return Some(Alarm::LinkSilence {
            milliseconds: silence.as_millis() as u64,
        });
    }
    let flight = now.saturating_sub(since);
    let limit = config.max_flight_time.filter(|&limit| flight >= limit)?;
    Some(Alarm::FlightTime {
        seconds: flight.as_secs(),
        limit: limit.as_secs(),
    })
}

fn value_alarm(config: &SafetyConfig, telemetry: &Telemetry) -> Option<Alarm> {
    if let (Some(battery), Some(limit)) = (telemetry.battery, config.min_battery) {
        let percent = battery.value.percent();
        if percent < limit {
            return Some(Alarm::Battery { percent, limit });
        }
    }
    if let (Some(temperature), Some(limit)) = (telemetry.temperature, config.max_temperature) {
        let celsius = temperature.value.high_c;
        if celsius > limit {
            return Some(Alarm::Temperature { celsius, limit });
        }
    }
    let (height, limit) = (telemetry.height_m?, config.max_height?);
    let centimeters = |meters: f64| (meters * 100.0) as i32;
    (height.value > limit).then(|| Alarm::Height {
        centimeters: centimeters(height.value),
        limit: centimeters(limit),
    })
}

/// How far a position lies outside the box, cm; zero inside. A position that is not finite counts as far outside.
pub(crate) fn outside(fence: &Fence, position: [f64; 3]) -> u32 {
    let mut worst = 0.0_f64;
    for ((value, low), high) in position.iter().zip(fence.0).zip(fence.1) {
        if !value.is_finite() {
            return u32::MAX;
        }
        worst = worst.max(low - value).max(value - high);
    }
    (worst * 100.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::{Source, Temperature};
    use crate::units::Battery;

    const NOW: Duration = Duration::from_secs(100);

    fn flying() -> Guard {
        let mut guard = Guard::default();
        guard.motors(Duration::from_secs(90), Some(true));
        guard
    }

    fn sample() -> crate::telemetry::TelemetryBuilder {
        Telemetry::builder(NOW, Source::TextState)
    }

    #[test]
    fn each_limit_raises_its_alarm_once() {
        let config = SafetyConfig::default();
        let low = sample().battery(Battery::from_percent(9).unwrap()).build();
        let hot = sample()
            .temperature(Temperature {
                low_c: 80,
                high_c: 91,
            })
            .build();
        let high = sample().height_m(5.1).build();
        for (telemetry, wanted) in [
            (
                low,
                Alarm::Battery {
                    percent: 9,
                    limit: 10,
                },
            ),
            (
                hot,
                Alarm::Temperature {
                    celsius: 91,
                    limit: 90,
                },
            ),
            (
                high,
                Alarm::Height {
                    centimeters: 509,
                    limit: 500,
                },
            ),
        ] {
            let mut guard = flying();
            assert_eq!(guard.check(NOW, &config, &telemetry, NOW), Some(wanted));
            assert_eq!(guard.check(NOW, &config, &telemetry, NOW), None);
        }
    }

    #[test]
    fn silence_and_flight_time_are_alarms_only_in_flight() {
        let config = SafetyConfig::default();
        let heard = Duration::from_secs(97);
        let silent = Some(Alarm::LinkSilence { milliseconds: 3000 });
        assert_eq!(
            flying().check(NOW, &config, &Telemetry::default(), heard),
            silent
        );
        assert_eq!(
            Guard::default().check(NOW, &config, &Telemetry::default(), heard),
            None
        );
        let late = Duration::from_secs(90 + 720);
        let alarm = flying().check(late, &config, &Telemetry::default(), late);
        assert_eq!(
            alarm,
            Some(Alarm::FlightTime {
                seconds: 720,
                limit: 720
            })
        );
    }

    #[test]
    fn the_fence_is_a_box() {
        let fence = ([-1.0, -1.0, 0.0], [1.0, 1.0, 2.0]);
        assert_eq!(outside(&fence, [0.0, 1.0, 2.0]), 0);
        assert_eq!(outside(&fence, [0.0, 0.0, 2.5]), 50);
        assert_eq!(outside(&fence, [f64::NAN, 0.0, 0.0]), u32::MAX);
    }
}
