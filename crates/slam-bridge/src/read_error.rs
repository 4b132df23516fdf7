//! What can be wrong with a file of foreign making, and where in it.

use core::fmt;
use std::io;

/// A place in a file, counted as an editor counts: lines and bytes from 1 and 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A line of text, from 1.
    Line(u64),
    /// A byte offset, from 0.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// What is wrong at a [`Place`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// A field that should hold a number holds something else.
    #[error("'{text}' in column {column} is not a number")]
    NotANumber {
        /// The field, from 1.
        column: usize,
        /// The field's text, cut to 24 characters.
        text: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("the value in column {column} is NaN or infinite; remove such points")]
    NonFinite {
        /// The field, from 1.
        column: usize,
    },
    /// The line has too few or too many fields.
    #[error("{found} columns where {needed} belong")]
    Columns {
        /// Fields on the line.
        found: usize,
        /// Fields that belong there.
        needed: usize,
    },
    /// An identity is negative, not whole, or used before.
    #[error("the id {id} is not a whole number from 0 that no other row uses")]
    Id {
        /// What the file says.
        id: String,
    },
    /// A rotation of length zero.
    #[error("the quaternion has no length")]
    Quaternion,
    /// A line of a header that says something which the format does not know.
    #[error("{expected}, found '{found}'")]
    Header {
        /// What belongs there.
        expected: &'static str,
        /// The line's text, cut to 24 characters.
        found: String,
    },
    /// Compressed data that does not decompress to what its header says.
    #[error("damaged compressed data: {packed} bytes do not unpack to {unpacked}")]
    Compressed {
        /// Bytes of compressed data.
        packed: u64,
        /// Bytes that the header promises.
        unpacked: u64,
    },
}

impl Fault {
    pub(crate) fn not_a_number(column: usize, text: &str) -> Self {
        Self::NotANumber {
            column,
            text: excerpt(text),
        }
    }

    pub(crate) fn header(expected: &'static str, found: &str) -> Self {
        Self::Header {
            expected,
            found: excerpt(found),
        }
    }
}

/// Cuts foreign text to a length fit for a message and drops control characters.
fn excerpt(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(24).collect()
}

/// Why a reader gave up.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The bytes could not be fetched.
    #[error("cannot read on: {0}")]
    Io(#[from] io::Error),
    /// Not one byte.
    #[error("the file is empty")]
    Empty,
    /// The file is well formed and holds no point.
    #[error("the file holds no points")]
    NoPoints,
    /// The first bytes belong to another format.
    #[error("this is no {format} file: it does not begin with '{begins}'")]
    Unrecognized {
        /// The format that was asked for.
        format: &'static str,
        /// How a file of that format begins.
        begins: &'static str,
    },
    /// A header without what a map needs.
    #[error("the header names no {what}; a map needs it")]
    Missing {
        /// What is missing.
        what: &'static str,
    },
    /// The file ends before its header's promise is kept: truncated, or the header lies.
    #[error(
        "the header promises {promised} {rows} rows, the file ends after {found} ({place}): \
         it is truncated or its header lies"
    )]
    Truncated {
        /// What kind of row, the header's word.
        rows: String,
        /// Rows promised by the header.
        promised: u64,
        /// Whole rows found.
        found: u64,
        /// Where the file ends.
        place: Place,
    },
    /// The file goes on after everything that its header promised.
    #[error("the header promises {promised} rows in all, but more data follow ({place}): it lies")]
    Surplus {
        /// Rows promised by the header, all kinds together.
        promised: u64,
        /// Where the surplus begins.
        place: Place,
    },
    /// Something is wrong at a known place.
    #[error("{place}: {fault}")]
    At {
        /// Where.
        place: Place,
        /// What.
        fault: Fault,
    },
}

impl ReadError {
    pub(crate) fn at_line(line: u64, fault: Fault) -> Self {
        Self::At {
            place: Place::Line(line),
            fault,
        }
    }
}
