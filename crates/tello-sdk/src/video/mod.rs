//! Video: H.264 in Annex B byte-stream format, cut into datagrams without header or timestamp.

mod annex_b;
mod assembler;
#[cfg(feature = "video")]
mod codec;
mod datagrams;

pub use annex_b::{NalKind, NalUnits, nal_units};
pub use assembler::{AccessUnit, Assembler, AssemblerConfig, Framing, Integrity, VideoCounters};
#[cfg(feature = "video")]
pub use codec::{CodecError, Decoder, Encoder, Picture, TestPattern};
pub(crate) use datagrams::begins_with_parameter_set;
pub use datagrams::{PAYLOAD, datagrams};
