//! The protocol of the maker's app: numbered, checksummed frames, sticks, flight data and log records.
//!
//! Excludes the text protocol: after `command` the drone answers no more of this until it is switched off and on.
//! Sources: the public notes of TelloPy and of SMerrony's Go library; not verified on hardware here.

mod checksum;
mod clock;
mod command;
mod config;
mod emulated;
mod flight_data;
mod frame;
mod landing;
mod log;
mod message;
mod reports;
mod session;
mod sticks;

pub use checksum::{crc8, crc16};
pub use clock::TickClock;
pub use command::{BinaryCommand, BinaryEvent, BinaryOutput, CommandId, Ending};
pub use config::BinaryConfig;
pub use emulated::BinaryEmulator;
pub use flight_data::FlightData;
pub use frame::{Frame, FrameError};
pub use log::{Gyro, Imu, LogRecord, LogRecords, Odometry, RecordKind, encode_record};
pub use message::Message;
pub use session::BinarySession;
pub use sticks::{decode_sticks, encode_sticks};
