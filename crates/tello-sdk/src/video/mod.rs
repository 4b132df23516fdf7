//! Video: H.264 in Annex B byte-stream format, cut into datagrams without header or timestamp.

mod annex_b;
mod assembler;
mod bits;
#[cfg(feature = "video")]
mod codec;
mod datagrams;
mod mosaic;
mod test_card;

pub use annex_b::{NalKind, NalUnits, nal_units};
pub use assembler::{AccessUnit, Assembler, AssemblerConfig, Framing, Integrity, VideoCounters};
#[cfg(feature = "video")]
pub use codec::{CodecError, Decoder, Encoder, Picture};
pub(crate) use datagrams::is_parameter_set;
pub use datagrams::{PAYLOAD, datagrams, numbered_datagrams};
pub use mosaic::{Mosaic, MosaicEncoder, SQUARE};
pub use test_card::{CardReading, TestCard};
