//! What can go wrong between a path and a map.

use std::io;
use std::path::PathBuf;

use crate::ReadError;

/// Why no map came out of a path, or none went in.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapFileError {
    /// Nothing is there.
    #[error("{}: no such file or folder", path.display())]
    NotFound {
        /// The path asked for.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("{}: {source}", path.display())]
    Io {
        /// The path asked for.
        path: PathBuf,
        /// The system's word.
        source: io::Error,
    },
    /// The content is bad.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file with the fault.
        path: PathBuf,
        /// The fault.
        source: ReadError,
    },
    /// The file is larger than what is read of one, at once or when it is unpacked.
    #[error(
        "{}: more than the {most} bytes that are read of a file (unpacked); thin the map or split it, or call the \
         format's reader (read_ply, read_pcd, read_xyz), which has no limit",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Bytes that are read at most.
        most: u64,
    },
    /// No reader goes with the name.
    #[error(
        "{}: no reader for this name; use .ply, .pcd, .csv, .xyz, .txt (each also with .gz) or a folder \
         with map.ply",
        path.display()
    )]
    UnknownExtension {
        /// The path asked for.
        path: PathBuf,
    },
    /// The folder holds no map.
    #[error("{}: the folder holds no map.ply and no map_N.ply (also with .gz)", path.display())]
    NoMapInFolder {
        /// The folder.
        path: PathBuf,
    },
}

impl MapFileError {
    pub(super) fn io(path: impl Into<PathBuf>, source: io::Error) -> Self {
        let path = path.into();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path },
            _ => Self::Io { path, source },
        }
    }

    pub(super) fn read(path: impl Into<PathBuf>, source: ReadError) -> Self {
        Self::Read {
            path: path.into(),
            source,
        }
    }
}
