//! Every time and limit of a session, with its source.

use crate::command::{Class, Command, SdkVersion};
use crate::safety::SafetyConfig;
use crate::state::StateConvention;
use core::time::Duration;

/// Why a configuration is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// A time must not be zero.
    #[error("`{field}` is zero: give a positive time")]
    Zero {
        /// The field's name.
        field: &'static str,
    },
    /// A time is longer than a year: such a wait is a mistake.
    #[error("`{field}` is longer than a year")]
    TooLong {
        /// The field's name.
        field: &'static str,
    },
    /// A count must not be zero.
    #[error("`{field}` is zero: at least one attempt is needed")]
    NoAttempt {
        /// The field's name.
        field: &'static str,
    },
}

/// Settings of a [`Session`](crate::Session).
#[derive(Debug, Clone, PartialEq)]
pub struct SessionConfig {
    /// The SDK that the drone speaks; commands of later ones are refused before sending. Default 2.0.
    pub version: SdkVersion,
    /// How the state line's velocity is read.
    pub convention: StateConvention,
    /// Wait for the reply to a query, per attempt. Default 1 s (measured round trip on the ground: max 228 ms).
    pub query_timeout: Duration,
    /// Wait for the reply to a setting, per attempt. Default 2 s.
    pub setting_timeout: Duration,
    /// Wait for the reply to a take-off. Default 20 s (over 7 s, up to 20 s were reported).
    pub take_off_timeout: Duration,
    /// Wait for the reply to any other motion. Default 16 s (the drone itself gives up after about 15 s).
    pub motion_timeout: Duration,
    /// Wait for the reply to a command that reboots the drone. Default 5 s.
    pub once_timeout: Duration,
    /// How often a query or a setting is sent at most. Default 3.
    pub attempts: u32,
    /// When a motion without reply is probed with a query (which also keeps the drone alive). Default 8 s.
    pub probe_after: Duration,
    /// Time between probes. Default 1 s.
    pub probe_interval: Duration,
    /// How long the drone must be still, after an answered probe, before a motion without reply is judged. Default 3 s.
    pub settle: Duration,
    /// How late a datagram may arrive: until then a reply of the same shape may be an old one. Default 3 s.
    pub max_delay: Duration,
    /// How late a copy of a reply, or the answer to a copy of a command, may arrive after the first. Default 300 ms; it
    /// is also the pause between two commands whose replies look alike.
    pub duplicate_window: Duration,
    /// Repetition of `land` and `stop` until confirmed. Default 1 s.
    pub safety_repeat: Duration,
    /// Repetition of `emergency`. Default 200 ms (it is often not answered).
    pub emergency_repeat: Duration,
    /// When `land` is given up as unconfirmed. Default 60 s.
    pub safety_give_up: Duration,
    /// When `stop` and `emergency` are given up as unconfirmed. Default 5 s.
    pub stop_give_up: Duration,
    /// Period of `rc` while sticks are set. Default 50 ms (20 Hz).
    pub stick_period: Duration,
    /// Without a new set-point for this long, the sticks are centred. Default 500 ms.
    pub stick_watchdog: Duration,
    /// Silence after which a query keeps the drone alive; `None` never. Default 5 s (it lands after 15 s or more).
    pub keep_alive: Option<Duration>,
    /// If set, [`Session::heartbeat`](crate::Session::heartbeat) must be called this often or the drone is landed and
    /// no longer kept alive. Default `None`: the drivers watch their owner themselves.
    pub heartbeat: Option<Duration>,
    /// Without any datagram from the drone for this long the link counts as lost. Default 2 s.
    pub link_timeout: Duration,
    /// How long a request may wait before it is sent. Default 30 s.
    pub queue_timeout: Duration,
    /// How many requests may wait. Default 16.
    pub queue_limit: usize,
    /// Accept replies from another source port of the drone's address. Default true (some emulators do that).
    pub accept_other_port: bool,
    /// What makes the session land by itself.
    pub safety: SafetyConfig,
}

impl Default for SessionConfig {
    fn default() -> Self {
        let ms = Duration::from_millis;
        Self {
            version: SdkVersion::V2_0,
            convention: StateConvention::default(),
            query_timeout: ms(1000),
            setting_timeout: ms(2000),
            take_off_timeout: ms(20_000),
            motion_timeout: ms(16_000),
            once_timeout: ms(5000),
            attempts: 3,
            probe_after: ms(8000),
            probe_interval: ms(1000),
            settle: ms(3000),
            max_delay: ms(3000),
            duplicate_window: ms(300),
            safety_repeat: ms(1000),
            emergency_repeat: ms(200),
            safety_give_up: ms(60_000),
            stop_give_up: ms(5000),
            stick_period: ms(50),
            stick_watchdog: ms(500),
            keep_alive: Some(ms(5000)),
            heartbeat: None,
            link_timeout: ms(2000),
            queue_timeout: ms(30_000),
            queue_limit: 16,
            accept_other_port: true,
            safety: SafetyConfig::default(),
        }
    }
}

impl SessionConfig {
    /// Checks that every period is positive and at most a year, and every command is sent at least once.
    ///
    /// # Errors
    /// The first field that is zero.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let periods = [
            ("query_timeout", self.query_timeout),
            ("setting_timeout", self.setting_timeout),
            ("take_off_timeout", self.take_off_timeout),
            ("motion_timeout", self.motion_timeout),
            ("once_timeout", self.once_timeout),
            ("probe_interval", self.probe_interval),
            ("safety_repeat", self.safety_repeat),
            ("emergency_repeat", self.emergency_repeat),
            ("stick_period", self.stick_period),
            ("stick_watchdog", self.stick_watchdog),
            ("link_timeout", self.link_timeout),
            ("queue_timeout", self.queue_timeout),
            (
                "keep_alive",
                self.keep_alive.unwrap_or(Duration::from_secs(1)),
            ),
            (
                "heartbeat",
                self.heartbeat.unwrap_or(Duration::from_secs(1)),
            ),
        ];
        if let Some(&(field, _)) = periods.iter().find(|(_, time)| time.is_zero()) {
            return Err(ConfigError::Zero { field });
        }
        let others = [
            ("probe_after", self.probe_after),
            ("settle", self.settle),
            ("max_delay", self.max_delay),
            ("duplicate_window", self.duplicate_window),
            ("safety_give_up", self.safety_give_up),
            ("stop_give_up", self.stop_give_up),
            (
                "max_flight_time",
                self.safety.max_flight_time.unwrap_or_default(),
            ),
            ("link_silence", self.safety.link_silence.unwrap_or_default()),
        ];
        let year = Duration::from_secs(365 * 86_400);
        let long = periods.iter().chain(&others).find(|(_, time)| *time > year);
        if let Some(&(field, _)) = long {
            return Err(ConfigError::TooLong { field });
        }
        if self.attempts == 0 {
            return Err(ConfigError::NoAttempt { field: "attempts" });
        }
        Ok(())
    }

    /// How long one attempt of a command waits for its reply.
    pub(super) fn timeout(&self, command: &Command) -> Duration {
        match (command.class(), command) {
            (Class::Query, _) => self.query_timeout,
            (Class::Setting, _) => self.setting_timeout,
            (Class::Motion, Command::TakeOff | Command::ThrowFly) => self.take_off_timeout,
            (Class::Motion, _) => self.motion_timeout,
            (Class::Once, _) => self.once_timeout,
            (Class::Safety | Class::Sticks, _) => self.safety_repeat,
        }
    }

    /// How often a command may be sent.
    pub(super) fn allowed_attempts(&self, command: &Command) -> u32 {
        match command.class() {
            Class::Query | Class::Setting => self.attempts,
            Class::Motion | Class::Once | Class::Safety | Class::Sticks => 1,
        }
    }
}
