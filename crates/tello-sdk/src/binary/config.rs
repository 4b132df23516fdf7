//! Every time of a binary session, with its source.

use crate::safety::SafetyConfig;
use core::time::Duration;

/// Settings of a [`BinarySession`](super::BinarySession).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BinaryConfig {
    /// Where the drone shall send video. Default 6038.
    pub video_port: u16,
    /// Period of the stick message. Default 20 ms, as gobot has it.
    pub stick_period: Duration,
    /// Without a new set-point for this long the sticks are centred. Default 500 ms.
    pub stick_watchdog: Duration,
    /// Wait for an acknowledgement. Default 1.5 s.
    pub ack_timeout: Duration,
    /// Repetition of the connection request, and of `land`. Default 1 s.
    pub repeat: Duration,
    /// When `land` is given up as unconfirmed. Default 60 s.
    pub land_give_up: Duration,
    /// Repetition of the request for video. Default 2 s.
    pub video_repeat: Duration,
    /// Silence after which the connection is made anew. Default 2 s.
    pub link_timeout: Duration,
    /// What makes the session land by itself. The drone tells no temperature in this protocol, only that it is hot.
    pub safety: SafetyConfig,
}

impl Default for BinaryConfig {
    fn default() -> Self {
        let ms = Duration::from_millis;
        Self {
            video_port: 6038,
            stick_period: ms(20),
            stick_watchdog: ms(500),
            ack_timeout: ms(1500),
            repeat: ms(1000),
            land_give_up: ms(60_000),
            video_repeat: ms(2000),
            link_timeout: ms(2000),
            safety: SafetyConfig::default(),
        }
    }
}
