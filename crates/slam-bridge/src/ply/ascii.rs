//! Rows of an ASCII PLY file: one line each.

use std::io::BufRead;

use super::header::{Element, Property};
use crate::{Fault, Place, ReadError, lines::Lines};

/// Reads one row into `row`, a number per property (a list gives 0). False at the file's end.
pub(super) fn read_row<R: BufRead>(
    lines: &mut Lines<R>,
    element: &Element,
    row: &mut Vec<f64>,
) -> Result<bool, ReadError> {
    row.clear();
    let Some((number, line)) = lines.next_filled()? else {
        return Ok(false);
    };
    parse_row(line, element, row).map_err(|fault| ReadError::at_line(number, fault))?;
    Ok(true)
}

/// Where the file goes on with something else than blank lines.
pub(super) fn surplus<R: BufRead>(lines: &mut Lines<R>) -> Result<Option<Place>, ReadError> {
    Ok(lines.next_filled()?.map(|(number, _)| Place::Line(number)))
}

fn parse_row(line: &str, element: &Element, row: &mut Vec<f64>) -> Result<(), Fault> {
    let mut fields = line.split_whitespace().enumerate();
    let needed = element.properties.len();
    for property in &element.properties {
        let value = number(fields.next(), needed, row.len())?;
        match property {
            Property::Scalar { .. } => row.push(value),
            Property::List { .. } => {
                for _ in 0..list_length(value, row.len())? {
                    number(fields.next(), needed, row.len())?;
                }
                row.push(0.0);
            }
        }
    }
    match fields.count() {
        0 => Ok(()),
        more => Err(Fault::Columns {
            found: needed + more,
            needed,
        }),
    }
}

fn number(field: Option<(usize, &str)>, needed: usize, found: usize) -> Result<f64, Fault> {
    let (column, text) = field.ok_or(Fault::Columns { found, needed })?;
    text.parse()
        .map_err(|_| Fault::not_a_number(column + 1, text))
}

/// A list's length as the file says it, from 0 to what fits a byte offset.
pub(super) fn list_length(value: f64, column: usize) -> Result<u64, Fault> {
    if (0.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0 {
        Ok(value as u64)
    } else {
        Err(Fault::not_a_number(column + 1, &value.to_string()))
    }
}
