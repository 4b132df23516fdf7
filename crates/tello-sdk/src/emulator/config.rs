//! What kind of drone is emulated, and how fast it is.

use super::faults::Faults;
use super::pads::FloorPad;
use crate::command::SdkVersion;
use alloc::string::String;
use alloc::vec::Vec;
use core::time::Duration;

/// What the drone does with a command while another one runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WhenBusy {
    /// Drops it.
    #[default]
    Drop,
    /// Answers `error Not joystick`.
    Refuse,
}

/// Times of a drone, from published measurements of single drones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Quantiles of the round trip of a command: 0, 50, 95, 99 and 100 %.
    /// Default 5, 44, 124, 200, 228 ms (580 queries on one drone).
    pub round_trip: [Duration; 5],
    /// Take-off until `ok`. Default 3.89 s.
    pub take_off: Duration,
    /// Landing until `ok`. Default 1.66 s.
    pub land: Duration,
    /// From a move's command until the drone moves. Default 350 ms.
    pub dead_time: Duration,
    /// Speed of moves before `speed x` is sent, m/s. Default 0.5 (an assumption).
    pub speed: f64,
    /// Yaw rate of turns, degrees per second. Default 60 (an assumption; about 90 is the maximum).
    pub yaw_rate: f64,
}

impl Default for Timing {
    fn default() -> Self {
        Self {
            round_trip: [5, 44, 124, 200, 228].map(Duration::from_millis),
            take_off: Duration::from_millis(3890),
            land: Duration::from_millis(1660),
            dead_time: Duration::from_millis(350),
            speed: 0.5,
            yaw_rate: 60.0,
        }
    }
}

impl Timing {
    /// A drone that does everything within a few tens of milliseconds, for tests of clients.
    #[must_use]
    pub fn fast() -> Self {
        Self {
            round_trip: [Duration::ZERO; 5],
            take_off: Duration::from_millis(300),
            land: Duration::from_millis(300),
            dead_time: Duration::from_millis(20),
            speed: 5.0,
            yaw_rate: 720.0,
        }
    }

    /// One way of a round trip at quantile `u` in 0..1, interpolated between the five given.
    pub(crate) fn one_way(&self, u: f64) -> Duration {
        let marks = [0.0, 0.5, 0.95, 0.99, 1.0];
        let mut trip = self.round_trip[4];
        for i in 0..4 {
            if u < marks[i + 1] {
                let part = (u - marks[i]) / (marks[i + 1] - marks[i]);
                let (low, high) = (self.round_trip[i], self.round_trip[i + 1]);
                trip = low + high.saturating_sub(low).mul_f64(part.clamp(0.0, 1.0));
                break;
            }
        }
        trip / 2
    }
}

/// Settings of an [`Emulator`](super::Emulator).
#[derive(Debug, Clone, PartialEq)]
pub struct EmulatorConfig {
    /// Which SDK it speaks. Default 2.0.
    pub version: SdkVersion,
    /// Answer to `sn?`.
    pub serial_number: String,
    /// Charge at power-on, percent. Default 87.
    pub battery: f64,
    /// Below this charge a take-off is refused and the drone lands. Default 5.
    pub min_battery: f64,
    /// Above this temperature a take-off is refused and the drone lands, degrees Celsius. Default 95 (an assumption: no
    /// limit is published).
    pub max_temperature: f64,
    /// Drain in the air, percent per minute. Default 7.7 (13 minutes of flight at best).
    pub drain: f64,
    /// Where state lines go on the client's address. Default 8890.
    pub state_port: u16,
    /// Where video goes on the client's address. Default 11111.
    pub video_port: u16,
    /// Period of the state line. Default 100 ms.
    pub state_period: Duration,
    /// Lands by itself after this long without a command. Default 15 s.
    pub auto_land: Duration,
    /// Mission pads on the floor. Default none.
    pub pads: Vec<FloorPad>,
    /// What happens to a command while another runs.
    pub when_busy: WhenBusy,
    /// How fast it is.
    pub timing: Timing,
    /// What goes wrong.
    pub faults: Faults,
    /// Seed of everything random.
    pub seed: u64,
}

impl Default for EmulatorConfig {
    fn default() -> Self {
        Self {
            version: SdkVersion::V2_0,
            serial_number: "0TQEMULATED001".into(),
            battery: 87.0,
            min_battery: 5.0,
            max_temperature: 95.0,
            drain: 7.7,
            state_port: 8890,
            video_port: 11_111,
            state_period: Duration::from_millis(100),
            auto_land: Duration::from_secs(15),
            pads: Vec::new(),
            when_busy: WhenBusy::Drop,
            timing: Timing::default(),
            faults: Faults::default(),
            seed: 0,
        }
    }
}
