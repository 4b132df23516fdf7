//! PCD to map: header, then rows (ASCII, binary) or columns (compressed).

use std::io::{BufRead, ErrorKind, Read};

use super::{
    header::{Encoding, Field, Header},
    lzf,
};
use crate::{Fault, Map, Place, ReadError, fields, lines::Lines};

/// Reads the points `x y z` of a PCD file: `ascii`, `binary` or `binary_compressed`.
///
/// Other fields are skipped; ids are row numbers. Memory follows the bytes that are there, never the
/// header's counts (compressed data unpack to 88 times their size at most).
///
/// # Errors
/// See [`ReadError`]: truncation, a header that lies about its counts, damaged compression, NaN
/// points (also those by which the format marks missing range readings), each with line or byte.
pub fn read_pcd<R: BufRead>(reader: R) -> Result<Map, ReadError> {
    let mut lines = Lines::new(reader);
    let header = Header::read(&mut lines)?;
    let columns = Columns::of(&header)?;
    let points = match header.encoding {
        Encoding::Ascii => read_ascii(&header, &columns, &mut lines)?,
        Encoding::Binary => {
            let (rest, offset) = lines.into_rest();
            read_binary(&header, &columns, rest, offset)?
        }
        Encoding::Compressed => {
            let (rest, offset) = lines.into_rest();
            read_compressed(&header, &columns, rest, offset)?
        }
    };
    if points.is_empty() {
        Err(ReadError::NoPoints)
    } else {
        Ok(Map::from_positions(points))
    }
}

/// Where x, y and z stand: the field, its byte in a row, its number in a line of text.
struct Columns {
    axes: [(Field, usize, usize); 3],
}

impl Columns {
    fn of(header: &Header) -> Result<Self, ReadError> {
        let find = |name: &str| {
            let index = header.fields.iter().position(|field| field.name == name)?;
            let (before, rest) = header.fields.split_at(index);
            let byte = before.iter().map(Field::bytes).sum();
            let number = before.iter().map(|field| field.count).sum();
            Some((rest.first()?.clone(), byte, number))
        };
        let missing = ReadError::Missing { what: "x, y, z" };
        match (find("x"), find("y"), find("z")) {
            (Some(x), Some(y), Some(z)) => Ok(Self { axes: [x, y, z] }),
            _ => Err(missing),
        }
    }

    /// The point whose axis `a` stands at `bytes_of(a)`.
    fn point<'a>(
        &self,
        place: Place,
        bytes_of: impl Fn(&Field, usize) -> Option<&'a [u8]>,
    ) -> Result<[f64; 3], ReadError> {
        let mut point = [0.0; 3];
        for ((field, byte, number), value) in self.axes.iter().zip(&mut point) {
            let number = number + 1;
            let decoded = bytes_of(field, *byte).and_then(|bytes| field.decode(bytes));
            *value = decoded.ok_or(ReadError::Missing {
                what: "x, y, z of 4 or 8 bytes",
            })?;
            if !value.is_finite() {
                return Err(ReadError::At {
                    place,
                    fault: Fault::NonFinite { column: number },
                });
            }
        }
        Ok(point)
    }
}

fn read_ascii<R: BufRead>(
    header: &Header,
    columns: &Columns,
    lines: &mut Lines<R>,
) -> Result<Vec<[f64; 3]>, ReadError> {
    let needed = header.fields.iter().map(|field| field.count).sum();
    let mut points = Vec::new();
    for found in 0..header.points {
        let Some((number, line)) = lines.next_filled()? else {
            return Err(truncated(header, found, lines.place()));
        };
        let texts: Vec<&str> = line.split_whitespace().collect();
        let point = if texts.len() == needed {
            ascii_point(columns, &texts)
        } else {
            Err(Fault::Columns {
                found: texts.len(),
                needed,
            })
        };
        points.push(point.map_err(|fault| ReadError::at_line(number, fault))?);
    }
    let surplus = lines.next_filled()?.map(|(number, _)| Place::Line(number));
    refuse_surplus(header, surplus).map(|()| points)
}

fn ascii_point(columns: &Columns, texts: &[&str]) -> Result<[f64; 3], Fault> {
    let mut point = [0.0; 3];
    for ((_, _, number), value) in columns.axes.iter().zip(&mut point) {
        *value = fields::finite(texts, *number)?;
    }
    Ok(point)
}

fn read_binary<R: Read>(
    header: &Header,
    columns: &Columns,
    mut reader: R,
    mut offset: u64,
) -> Result<Vec<[f64; 3]>, ReadError> {
    let mut row = vec![0_u8; header.row_bytes()];
    let mut points = Vec::new();
    for found in 0..header.points {
        let place = Place::Byte(offset);
        match reader.read_exact(&mut row) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                return Err(truncated(header, found, place));
            }
            Err(error) => return Err(error.into()),
        }
        points.push(columns.point(place, |_, byte| row.get(byte..))?);
        offset += row.len() as u64;
    }
    let mut rest = Vec::new();
    reader.take(4).read_to_end(&mut rest)?;
    let harmless = rest.len() < 4 && rest.iter().all(u8::is_ascii_whitespace);
    refuse_surplus(header, (!harmless).then_some(Place::Byte(offset))).map(|()| points)
}

/// Compressed data hold column after column: all x, then all y, and so on.
fn read_compressed<R: Read>(
    header: &Header,
    columns: &Columns,
    mut reader: R,
    offset: u64,
) -> Result<Vec<[f64; 3]>, ReadError> {
    let mut sizes = [0_u8; 8];
    if reader.read_exact(&mut sizes).is_err() {
        return Err(truncated(header, 0, Place::Byte(offset)));
    }
    let [a, b, c, d, e, f, g, h] = sizes;
    let promised = u64::from(u32::from_le_bytes([a, b, c, d]));
    let unpacked = u64::from(u32::from_le_bytes([e, f, g, h]));
    let mut packed = Vec::new();
    reader.take(promised).read_to_end(&mut packed)?;
    let place = Place::Byte(offset + 8);
    let fault = Fault::Compressed {
        packed: packed.len() as u64,
        unpacked,
    };
    let damaged = || ReadError::At {
        place,
        fault: fault.clone(),
    };
    let expected = header.points.checked_mul(header.row_bytes() as u64);
    let plausible = unpacked <= (packed.len() as u64).saturating_mul(lzf::MAX_EXPANSION);
    if (packed.len() as u64) < promised || expected != Some(unpacked) || !plausible {
        return Err(damaged());
    }
    let size = usize::try_from(unpacked).map_err(|_| damaged())?;
    let data = lzf::decompress(&packed, size).ok_or_else(damaged)?;
    let count = usize::try_from(header.points).map_err(|_| damaged())?;
    let point = |row: usize| {
        columns.point(place, |field, byte| {
            data.get(byte * count + row * field.bytes()..)
        })
    };
    (0..count).map(point).collect()
}

fn truncated(header: &Header, found: u64, place: Place) -> ReadError {
    ReadError::Truncated {
        rows: "point".to_owned(),
        promised: header.points,
        found,
        place,
    }
}

fn refuse_surplus(header: &Header, surplus: Option<Place>) -> Result<(), ReadError> {
    let promised = header.points;
    surplus.map_or(Ok(()), |place| Err(ReadError::Surplus { promised, place }))
}
