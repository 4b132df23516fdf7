//! Recorded image sequences: decoding of PNG and JPEG, TUM folders, plain folders (feature `image-files`).

mod bounded;
mod calibration;
mod decode;
mod folder;
mod listing;

pub use bounded::read_at_most;
pub use decode::{DecodeError, decode_depth, decode_gray};
pub use folder::{ImageSequence, LoadedFrame, SequenceError};
