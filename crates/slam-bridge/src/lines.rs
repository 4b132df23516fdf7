//! Text lines with their numbers, of any bytes: what is not UTF-8 becomes replacement characters.

use std::io::{self, BufRead};

use crate::Place;

/// Reads line after line, counting lines and bytes.
#[derive(Debug)]
pub(crate) struct Lines<R> {
    reader: R,
    bytes: Vec<u8>,
    text: String,
    number: u64,
    offset: u64,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(reader: R) -> Self {
        Self {
            reader,
            bytes: Vec::new(),
            text: String::new(),
            number: 0,
            offset: 0,
        }
    }

    /// The next line and its number from 1, without its line break; `None` at the end. A byte
    /// order mark is dropped.
    pub(crate) fn next(&mut self) -> io::Result<Option<(u64, &str)>> {
        self.bytes.clear();
        let read = self.reader.read_until(b'\n', &mut self.bytes)?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        self.offset += read as u64;
        self.text.clear();
        self.text.push_str(&String::from_utf8_lossy(&self.bytes));
        let line = self.text.trim_end_matches(['\n', '\r']);
        let line = if self.number == 1 {
            line.trim_start_matches('\u{feff}')
        } else {
            line
        };
        Ok(Some((self.number, line)))
    }

    /// The next line that is not blank, trimmed.
    pub(crate) fn next_filled(&mut self) -> io::Result<Option<(u64, &str)>> {
        while self.next()?.is_some() {
            if !self.text.trim().is_empty() {
                return Ok(Some((
                    self.number,
                    self.text.trim().trim_start_matches('\u{feff}'),
                )));
            }
        }
        Ok(None)
    }

    /// Number of the line handed out last, from 1.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    pub(crate) fn place(&self) -> Place {
        Place::Line(self.number)
    }

    /// The bytes behind the last line handed out, and their offset in the file.
    pub(crate) fn into_rest(self) -> (R, u64) {
        (self.reader, self.offset)
    }
}
