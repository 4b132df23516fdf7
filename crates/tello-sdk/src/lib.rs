#![doc = include_str!("../README.md")]
#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod command;
pub mod reply;
pub mod state;
pub mod telemetry;
pub mod units;

pub use command::{
    Arc, Class, Command, Credentials, Flip, Pad, Query, ReplyShape, SdkVersion, Waypoint,
};
pub use reply::{Refusal, Reply, ReplyKind};
pub use state::{StateConvention, StateError, StateLine};
pub use telemetry::{
    Attitude, PadSighting, Reading, Source, Telemetry, TelemetryBuilder, Temperature, Velocity,
    VelocityFrame,
};
pub use units::{
    ArcSpeed, Battery, BitRate, Coordinate, Distance, PadNumber, Port, Speed, Stick, Turn,
    UnitError,
};
