//! PLY to map: header, then row by row.

use std::io::BufRead;

use super::{
    ascii,
    binary::BinaryRows,
    columns::Columns,
    header::{Element, Encoding, Header},
};
use crate::{Map, MapPoint, Place, ReadError, lines::Lines};

/// Reads the points of a PLY file: ASCII, or binary of either byte order.
///
/// Of the element `vertex` the properties `x y z` are positions in map units, `nx ny nz` mean
/// viewing directions and `id` identities (row numbers where there are none); all other properties
/// and elements are skipped. Observations stand in a file of their own, see
/// [`read_observations`](crate::read_observations). Memory follows the bytes that
/// are there, never the header's counts.
///
/// # Errors
/// See [`ReadError`]: truncation, a header that lies about its counts, NaN, repeated ids, each with
/// line or byte.
pub fn read_ply<R: BufRead>(reader: R) -> Result<Map, ReadError> {
    let mut lines = Lines::new(reader);
    let header = Header::read(&mut lines)?;
    if !header
        .elements
        .iter()
        .any(|element| element.name == "vertex")
    {
        return Err(ReadError::Missing {
            what: "element vertex",
        });
    }
    let mut points = Vec::new();
    match header.encoding {
        Encoding::Ascii => {
            for element in &header.elements {
                read_element(&mut lines, element, &mut points)?;
            }
            refuse_surplus(&header, ascii::surplus(&mut lines)?)?;
        }
        Encoding::Binary(endian) => {
            let (rest, offset) = lines.into_rest();
            let mut rows = BinaryRows::new(rest, endian, offset);
            for element in &header.elements {
                read_element(&mut rows, element, &mut points)?;
            }
            refuse_surplus(&header, rows.surplus()?)?;
        }
    }
    let Header {
        scale,
        epoch,
        frustum,
        ..
    } = header;
    Ok(Map {
        epoch,
        scale,
        points,
        keyframes: Vec::new(),
        frustum,
    })
}

/// Rows of either encoding.
trait Rows {
    fn place(&self) -> Place;
    fn read_row(&mut self, element: &Element, row: &mut Vec<f64>) -> Result<bool, ReadError>;
}

impl<R: BufRead> Rows for Lines<R> {
    fn place(&self) -> Place {
        Lines::place(self)
    }

    fn read_row(&mut self, element: &Element, row: &mut Vec<f64>) -> Result<bool, ReadError> {
        ascii::read_row(self, element, row)
    }
}

impl<R: BufRead> Rows for BinaryRows<R> {
    fn place(&self) -> Place {
        BinaryRows::place(self)
    }

    fn read_row(&mut self, element: &Element, row: &mut Vec<f64>) -> Result<bool, ReadError> {
        BinaryRows::read_row(self, element, row)
    }
}

fn read_element(
    rows: &mut impl Rows,
    element: &Element,
    points: &mut Vec<MapPoint>,
) -> Result<(), ReadError> {
    let mut columns = match element.name.as_str() {
        "vertex" => Some(Columns::of(element)?),
        // Rows without a column take no space in a binary file: there is nothing to skip.
        _ if element.properties.is_empty() => return Ok(()),
        _ => None,
    };
    let mut row = Vec::new();
    for found in 0..element.count {
        let before = rows.place();
        if !rows.read_row(element, &mut row)? {
            let (name, promised) = (element.name.clone(), element.count);
            return Err(ReadError::Truncated {
                rows: name,
                promised,
                found,
                place: rows.place(),
            });
        }
        if let Some(columns) = &mut columns {
            let place = match rows.place() {
                Place::Byte(_) => before,
                line @ Place::Line(_) => line,
            };
            let point = columns.point(found, &row);
            points.push(point.map_err(|fault| ReadError::At { place, fault })?);
        }
    }
    Ok(())
}

fn refuse_surplus(header: &Header, surplus: Option<Place>) -> Result<(), ReadError> {
    let promised = header
        .elements
        .iter()
        .fold(0_u64, |sum, e| sum.saturating_add(e.count));
    surplus.map_or(Ok(()), |place| Err(ReadError::Surplus { promised, place }))
}
