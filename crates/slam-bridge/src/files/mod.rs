//! The only part that opens files: picks a reader by name, and reads and writes map folders.

mod bounded;
mod error;
mod folder;
mod read;

pub use error::MapFileError;
pub use folder::{read_map_folder, write_map_folder};
pub use read::{MOST_MAP_BYTES, read_map};
