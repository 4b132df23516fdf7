//! Rows of a binary PLY file: numbers of fixed size, lists preceded by their length.

use std::io::{ErrorKind, Read};

use super::{
    ascii::list_length,
    header::{Element, Property},
    scalar::{Endian, Scalar},
};
use crate::{Place, ReadError};

/// Reads binary rows, counting bytes.
#[derive(Debug)]
pub(super) struct BinaryRows<R> {
    reader: R,
    endian: Endian,
    offset: u64,
}

impl<R: Read> BinaryRows<R> {
    /// `offset` is where the reader stands in the file.
    pub(super) fn new(reader: R, endian: Endian, offset: u64) -> Self {
        Self {
            reader,
            endian,
            offset,
        }
    }

    pub(super) fn place(&self) -> Place {
        Place::Byte(self.offset)
    }

    /// Reads one row into `row`, a number per property (a list gives 0). False at the file's end.
    pub(super) fn read_row(
        &mut self,
        element: &Element,
        row: &mut Vec<f64>,
    ) -> Result<bool, ReadError> {
        row.clear();
        for property in &element.properties {
            let whole = match *property {
                Property::Scalar { kind, .. } => self.number(kind, row)?,
                Property::List { count, item } => self.list(count, item, row)?,
            };
            if !whole {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Where the file goes on with something else than a last line break.
    pub(super) fn surplus(mut self) -> Result<Option<Place>, ReadError> {
        let mut rest = Vec::new();
        self.reader.by_ref().take(4).read_to_end(&mut rest)?;
        let harmless = rest.len() < 4 && rest.iter().all(u8::is_ascii_whitespace);
        Ok((!harmless).then_some(self.place()))
    }

    fn number(&mut self, kind: Scalar, row: &mut Vec<f64>) -> Result<bool, ReadError> {
        let mut bytes = [0_u8; 8];
        let size = kind.size();
        match self.reader.read_exact(&mut bytes[..size]) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(false),
            Err(error) => return Err(error.into()),
        }
        self.offset += size as u64;
        row.push(kind.decode(&bytes, self.endian));
        Ok(true)
    }

    /// Skips a list; only its length is looked at.
    fn list(&mut self, count: Scalar, item: Scalar, row: &mut Vec<f64>) -> Result<bool, ReadError> {
        let place = self.place();
        if !self.number(count, row)? {
            return Ok(false);
        }
        let length = row.last_mut().map_or(0.0, core::mem::take);
        let length = list_length(length, row.len().saturating_sub(1))
            .map_err(|fault| ReadError::At { place, fault })?;
        let bytes = length * item.size() as u64;
        let skipped = std::io::copy(&mut self.reader.by_ref().take(bytes), &mut std::io::sink())?;
        self.offset += skipped;
        Ok(skipped == bytes)
    }
}
