//! Writes a connection's recording to a file.

use super::error::ConnectError;
use crate::record::{Channel, Record, encode};
use alloc::vec::Vec;
use core::time::Duration;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Appends each record as it comes: a crash loses at most the record being written.
pub(super) struct Recorder {
    file: Option<File>,
    buffer: Vec<u8>,
}

impl Recorder {
    /// A recorder for the path; without one it does nothing.
    pub(super) fn create(path: Option<&Path>) -> Result<Self, ConnectError> {
        let open = |path: &Path| {
            File::create(path).map_err(|source| ConnectError::Record {
                path: path.to_owned(),
                source,
            })
        };
        Ok(Self {
            file: path.map(open).transpose()?,
            buffer: Vec::new(),
        })
    }

    /// Writes one record; after a failed write (a full disk) nothing more is recorded, the flight goes on.
    pub(super) fn write(&mut self, at: Duration, channel: Channel, bytes: &[u8]) {
        let Some(file) = &mut self.file else { return };
        self.buffer.clear();
        encode(&Record { at, channel, bytes }, &mut self.buffer);
        if file.write_all(&self.buffer).is_err() {
            self.file = None;
        }
    }
}
