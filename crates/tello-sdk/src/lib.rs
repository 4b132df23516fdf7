#![doc = include_str!("../README.md")]
#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod binary;
pub mod camera;
pub mod command;
#[cfg(feature = "std")]
pub mod driver;
pub mod emulator;
pub mod record;
pub mod reply;
pub mod safety;
pub mod session;
pub mod state;
pub mod telemetry;
pub mod units;
pub mod video;

pub use camera::{CalibrationError, CalibrationSource, Intrinsics};
pub use command::{
    Arc, Class, Command, Credentials, Flip, Pad, Query, ReplyShape, SdkVersion, Waypoint,
};
#[cfg(feature = "tokio")]
pub use driver::AsyncDrone;
#[cfg(feature = "std")]
pub use driver::{
    BinaryDrone, BinaryDroneConfig, ConnectError, DriveError, Drone, DroneConfig, Found, Lander,
    StateHub, VideoConfig, VideoHub, VideoStream, discover, subnet, together,
};
pub use reply::{Refusal, Reply, ReplyKind};
pub use safety::{Alarm, Finding, PreflightConfig, SafetyConfig, preflight};
pub use session::{
    ConfigError, Counters, Event, Input, Motors, Origin, Outcome, Output, RequestError, RequestId,
    Session, SessionConfig, Sticks, Verdict,
};
pub use state::{StateConvention, StateError, StateLine};
pub use telemetry::{
    Attitude, PadSighting, Reading, Source, Telemetry, TelemetryBuilder, Temperature, Velocity,
    VelocityFrame,
};
pub use units::{
    ArcSpeed, Battery, BitRate, Coordinate, Distance, PadNumber, Port, Speed, Stick, Turn,
    UnitError,
};
