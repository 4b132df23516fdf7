//! Video: H.264 in Annex B byte-stream format, cut into datagrams without header or timestamp.

mod annex_b;
mod assembler;
mod datagrams;

pub use annex_b::{NalKind, NalUnits, nal_units};
pub use assembler::{AccessUnit, Assembler, AssemblerConfig, Framing, Integrity, VideoCounters};
pub(crate) use datagrams::begins_with_parameter_set;
pub use datagrams::{PAYLOAD, datagrams};
