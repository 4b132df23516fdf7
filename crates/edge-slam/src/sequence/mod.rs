//! Recorded image sequences: decoding of PNG and JPEG, TUM folders, plain folders (feature `image-files`).

mod bounded;
mod calibration;
mod decode;
mod error;
mod folder;
mod listing;
mod order;

pub use bounded::read_at_most;
pub use decode::{DecodeError, decode_depth, decode_gray};
pub use error::SequenceError;
pub use folder::{ImageSequence, LoadedFrame};
