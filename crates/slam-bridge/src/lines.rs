//! Text lines with their numbers, of any bytes: what is not UTF-8 becomes replacement characters.

use std::io::{self, BufRead, ErrorKind, Read};

use crate::Place;

/// Bytes of the longest line that is taken for text; no row of a map comes near, but a stream without line breaks would fill the memory.
const LONGEST: u64 = 16 << 20;

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
    /// order mark is dropped. Fails at a line of more than 16 MiB.
    pub(crate) fn next(&mut self) -> io::Result<Option<(u64, &str)>> {
        self.bytes.clear();
        let mut within = (&mut self.reader).take(LONGEST + 1);
        let read = within.read_until(b'\n', &mut self.bytes)?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        if read as u64 > LONGEST {
            let message = format!("line {} is longer than {LONGEST} bytes", self.number);
            return Err(io::Error::new(ErrorKind::InvalidData, message));
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_without_line_breaks_is_refused_before_it_fills_the_memory() {
        let endless = io::BufReader::new(b"first\n".chain(io::repeat(b'7')));
        let mut lines = Lines::new(endless);
        assert_eq!(lines.next().unwrap(), Some((1, "first")));
        let error = lines.next().unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidData);
        assert!(error.to_string().starts_with("line 2 is longer"), "{error}");
        assert!(lines.bytes.len() as u64 <= LONGEST + 1);
    }
}
