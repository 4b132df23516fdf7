//! The PCD format of the Point Cloud Library: ASCII, binary and compressed binary in.

mod header;
mod lzf;
mod read;

pub use read::read_pcd;
