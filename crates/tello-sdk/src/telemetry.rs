//! One telemetry type for both protocols: every value with unit, frame, time of receipt, source and validity.
//!
//! Metres, seconds and degrees (the wire has whole degrees). A value that the drone did not send is `None`. Later
//! samples are merged over earlier ones with [`Telemetry::merge`], so each value keeps the time at which it came.

use crate::units::Battery;
use core::time::Duration;

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Source {
    /// The state line of the text protocol, about 10 Hz.
    TextState,
    /// The flight-data message of the binary protocol, about 10 Hz.
    FlightData,
    /// A log record of the binary protocol.
    Log,
    /// A simulator.
    Simulated,
}

/// A value with the time at which it was received.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading<T> {
    /// The value.
    pub value: T,
    /// Time since the start of the session: of receipt; for a log record when the drone made it, by its converted counter.
    pub at: Duration,
    /// Where it comes from.
    pub source: Source,
    /// Whether the sensor itself calls it usable (a ToF reading outside 0.30 to 10 m is not, for example).
    pub valid: bool,
}

impl<T> Reading<T> {
    /// A valid reading.
    #[must_use]
    pub fn new(value: T, at: Duration, source: Source) -> Self {
        Self {
            value,
            at,
            source,
            valid: true,
        }
    }

    /// The same reading with the validity replaced.
    #[must_use]
    pub fn with_validity(self, valid: bool) -> Self {
        Self { valid, ..self }
    }

    /// How old it is; zero when `now` is earlier.
    #[must_use]
    pub fn age(&self, now: Duration) -> Duration {
        now.saturating_sub(self.at)
    }
}

/// Attitude in degrees; yaw clockwise positive, zero at power-on, -180..=180.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Nose up positive, degrees.
    pub pitch_deg: f64,
    /// Right side down positive, degrees.
    pub roll_deg: f64,
    /// Clockwise from above positive, degrees.
    pub yaw_deg: f64,
}

/// The frame of a velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum VelocityFrame {
    /// x forward, y left, z up, turning with the drone's yaw.
    Body,
    /// x, y, z as the drone was heading at power-on.
    PowerOn,
    /// Not settled: published sources disagree (the default for the text state).
    #[default]
    Unsettled,
}

/// Velocity, metres per second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Velocity {
    /// The three components, m/s.
    pub meters_per_s: [f64; 3],
    /// The frame they are in.
    pub frame: VelocityFrame,
    /// Which of the three the sensor calls valid.
    pub valid: [bool; 3],
}

/// Temperature range inside the drone, degrees Celsius.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Temperature {
    /// Lowest of the sensors.
    pub low_c: i16,
    /// Highest of the sensors.
    pub high_c: i16,
}

impl Reading<Velocity> {
    /// Standard deviation of each component by the rounding of the wire alone, m/s; the sensor's own noise comes on top
    /// and is not published. A twelfth of a step's square is the variance.
    #[must_use]
    pub fn rounding_noise(&self) -> f64 {
        let step = match self.source {
            Source::Log => 0.01,
            Source::TextState | Source::FlightData | Source::Simulated => 0.1,
        };
        step * UNIFORM
    }
}

impl Reading<Attitude> {
    /// Standard deviation of each angle by the rounding of the wire alone, degrees; zero for the log's quaternions.
    #[must_use]
    pub fn rounding_noise(&self) -> f64 {
        match self.source {
            Source::Log => 0.0,
            Source::TextState | Source::FlightData | Source::Simulated => UNIFORM,
        }
    }
}

/// Standard deviation of a uniform distribution of width one: the root of a twelfth.
const UNIFORM: f64 = 0.288_675_134_594_812_9;

/// What the mission-pad detection reports (SDK 2.0 and later).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PadSighting {
    /// The pad's number, 1 to 8.
    pub pad: u8,
    /// The drone in the pad's frame, centimetres.
    pub position_cm: [i16; 3],
    /// Pitch, roll, yaw relative to the pad as they stand on the wire (their order was not verified), degrees.
    pub attitude_deg: [i16; 3],
}

/// What is known of the drone's state.
///
/// ```
/// use core::time::Duration;
/// use tello_sdk::{Attitude, Source, Telemetry};
/// let telemetry = Telemetry::builder(Duration::from_secs(3), Source::Simulated)
///     .attitude(Attitude { yaw_deg: 90.0, ..Attitude::default() })
///     .height_m(1.2)
///     .build();
/// assert_eq!(telemetry.height_m.map(|reading| reading.value), Some(1.2));
/// assert!(telemetry.battery.is_none());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Telemetry {
    /// Pitch, roll, yaw.
    pub attitude: Option<Reading<Attitude>>,
    /// Attitude as a quaternion (w, x, y, z), body to world; binary log only.
    pub quaternion: Option<Reading<[f64; 4]>>,
    /// Velocity.
    pub velocity: Option<Reading<Velocity>>,
    /// Position in the frame of visual odometry, metres; binary log only. `valid` is false when any axis is invalid.
    pub position_m: Option<Reading<[f64; 3]>>,
    /// Specific force, m/s^2, sensor axes (about -9.8 on z at rest).
    pub acceleration: Option<Reading<[f64; 3]>>,
    /// Angular rate, degrees per second; binary log only.
    pub angular_rate: Option<Reading<[f64; 3]>>,
    /// Height over the take-off point, metres, in steps of 0.1; low by 0.1 to 0.35 m, the offset is fixed per take-off.
    pub height_m: Option<Reading<f64>>,
    /// Distance to the ground below, metres; valid from 0.30 to 10 m.
    pub tof_m: Option<Reading<f64>>,
    /// Barometric height, metres, absolute; drifts with the weather.
    pub barometer_m: Option<Reading<f64>>,
    /// Charge of the battery.
    pub battery: Option<Reading<Battery>>,
    /// Temperature range.
    pub temperature: Option<Reading<Temperature>>,
    /// How long the motors have turned: it advances, in whole seconds, while they turn.
    pub motor_time: Option<Reading<Duration>>,
    /// The mission pad in sight, `None` if off or not seen.
    pub pad: Option<Reading<PadSighting>>,
    /// Whether the drone itself says that it flies; binary protocol only.
    pub flying: Option<Reading<bool>>,
}

impl Telemetry {
    /// Starts a sample whose values all carry this time and source.
    #[must_use]
    pub fn builder(at: Duration, source: Source) -> TelemetryBuilder {
        TelemetryBuilder {
            at,
            source,
            telemetry: Self::default(),
        }
    }

    /// Takes over every value that `newer` has.
    pub fn merge(&mut self, newer: &Self) {
        fn over<T: Copy>(old: &mut Option<T>, new: Option<T>) {
            *old = new.or(*old);
        }
        over(&mut self.attitude, newer.attitude);
        over(&mut self.quaternion, newer.quaternion);
        over(&mut self.velocity, newer.velocity);
        over(&mut self.position_m, newer.position_m);
        over(&mut self.acceleration, newer.acceleration);
        over(&mut self.angular_rate, newer.angular_rate);
        over(&mut self.height_m, newer.height_m);
        over(&mut self.tof_m, newer.tof_m);
        over(&mut self.barometer_m, newer.barometer_m);
        over(&mut self.battery, newer.battery);
        over(&mut self.temperature, newer.temperature);
        over(&mut self.motor_time, newer.motor_time);
        over(&mut self.pad, newer.pad);
        over(&mut self.flying, newer.flying);
    }
}

/// Fills a [`Telemetry`] value by value.
#[derive(Debug, Clone, Copy)]
pub struct TelemetryBuilder {
    at: Duration,
    source: Source,
    telemetry: Telemetry,
}

macro_rules! setters {
    ($($(#[$doc:meta])* $field:ident: $kind:ty;)*) => {
        impl TelemetryBuilder {
            $($(#[$doc])*
            #[must_use]
            pub fn $field(mut self, value: $kind) -> Self {
                self.telemetry.$field = Some(Reading::new(value, self.at, self.source));
                self
            })*
        }
    };
}

setters! {
    /// Pitch, roll, yaw.
    attitude: Attitude;
    /// Quaternion w, x, y, z.
    quaternion: [f64; 4];
    /// Velocity.
    velocity: Velocity;
    /// Position, metres.
    position_m: [f64; 3];
    /// Specific force, m/s^2.
    acceleration: [f64; 3];
    /// Angular rate, degrees per second.
    angular_rate: [f64; 3];
    /// Height, metres.
    height_m: f64;
    /// Barometric height, metres.
    barometer_m: f64;
    /// Battery.
    battery: Battery;
    /// Temperature.
    temperature: Temperature;
    /// Motor time.
    motor_time: Duration;
    /// Mission pad.
    pad: PadSighting;
    /// Whether the drone says that it flies.
    flying: bool;
}

impl TelemetryBuilder {
    /// Distance to the ground, metres; marked invalid outside 0.30 to 10 m.
    #[must_use]
    pub fn tof_m(mut self, value: f64) -> Self {
        let reading = Reading::new(value, self.at, self.source);
        self.telemetry.tof_m = Some(reading.with_validity((0.30..=10.0).contains(&value)));
        self
    }

    /// The sample.
    #[must_use]
    pub fn build(self) -> Telemetry {
        self.telemetry
    }
}
