//! Why a recorded sequence cannot be read.

use std::io;
use std::path::PathBuf;

use super::DecodeError;

/// Why a sequence cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// A file or folder cannot be read, or is larger than a picture (128 MiB) or a list (64 MiB) may be.
    #[error("{} cannot be read", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// An image cannot be decoded.
    #[error("{} cannot be decoded", path.display())]
    Image {
        /// Which.
        path: PathBuf,
        /// Why.
        source: DecodeError,
    },
    /// A line of a list is not "timestamp filename" (or a timestamp, or three numbers).
    #[error("line {line} of {name} is not understood")]
    Line {
        /// File name.
        name: &'static str,
        /// Counted from 1.
        line: usize,
    },
    /// `timestamps.txt` has more or fewer times than there are images: which belong together cannot be told.
    #[error("timestamps.txt has {times} times for {images} images; it must have one line for each")]
    Times {
        /// Lines with a time.
        times: usize,
        /// Image files.
        images: usize,
    },
    /// A depth image does not cover its image pixel by pixel.
    #[error(
        "{} is {} x {}, but its image {} x {}; depth must be registered to the image, pixel by pixel",
        path.display(), depth[0], depth[1], image[0], image[1]
    )]
    DepthSize {
        /// The depth image.
        path: PathBuf,
        /// Its columns and rows.
        depth: [usize; 2],
        /// Columns and rows of the image.
        image: [usize; 2],
    },
    /// The folder is no sequence.
    #[error("{} has neither rgb.txt nor PNG or JPEG files, in a folder color, image, rgb or gray or by themselves", path.display())]
    NotASequence {
        /// The folder.
        path: PathBuf,
    },
}
