//! The PLY format: ASCII and binary of either byte order in, ASCII out.

mod ascii;
mod binary;
mod columns;
mod header;
mod read;
mod scalar;
mod write;

pub use read::read_ply;
pub use write::write_ply;
