//! Points from text: `x, y, z` first on each line, separated by commas, semicolons or blanks.
//!
//! Further columns are ignored, so are blank lines, lines that begin with `#` or `//`, and a first
//! line of column names. Trailing separators are harmless. Ids are row numbers of the points.

use std::io::BufRead;

use crate::{Fault, Map, ReadError, fields, lines::Lines};

/// Reads a cloud of points from text (.csv, .xyz, .txt), in map units of unknown scale.
///
/// # Errors
/// [`ReadError::At`] with the line number for letters, an empty column, a missing column, NaN or
/// infinity; [`ReadError::Empty`] and [`ReadError::NoPoints`].
///
/// # Example
/// ```
/// let map = slam_bridge::read_xyz("x,y,z\n1,2,3\n4,5,6,,\n".as_bytes())?;
/// assert_eq!(map.positions(), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
/// # Ok::<(), slam_bridge::ReadError>(())
/// ```
pub fn read_xyz<R: BufRead>(reader: R) -> Result<Map, ReadError> {
    let mut lines = Lines::new(reader);
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut header_allowed = true;
    while let Some((number, line)) = lines.next_filled()? {
        if line.starts_with('#') || line.starts_with("//") {
            continue;
        }
        let fields = fields::split(line);
        let is_header = header_allowed && names_columns(&fields);
        header_allowed = false;
        if is_header {
            continue;
        }
        match position(&fields) {
            Ok(point) => points.push(point),
            Err(fault) => return Err(ReadError::at_line(number, fault)),
        }
    }
    match (points.is_empty(), lines.number()) {
        (true, 0) => Err(ReadError::Empty),
        (true, _) => Err(ReadError::NoPoints),
        _ => Ok(Map::from_positions(points)),
    }
}

/// A line names columns when none of its first three fields is a number.
fn names_columns(fields: &[&str]) -> bool {
    fields.len() >= 3
        && fields
            .iter()
            .take(3)
            .all(|field| !field.is_empty() && field.parse::<f64>().is_err())
}

fn position(fields: &[&str]) -> Result<[f64; 3], Fault> {
    if fields.len() < 3 {
        return Err(Fault::Columns {
            found: fields.len(),
            needed: 3,
        });
    }
    Ok([
        fields::finite(fields, 0)?,
        fields::finite(fields, 1)?,
        fields::finite(fields, 2)?,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Map, ReadError> {
        read_xyz(text.as_bytes())
    }

    fn message(text: &str) -> String {
        read(text).expect_err("bad input").to_string()
    }

    #[test]
    fn every_separator_and_trailing_commas() {
        let text = "# comment\n\n1,2,3\n4; 5; 6\n7\t8  9\n10,11,12,,,\r\n13,14,15,255,0,0";
        let map = read(text).expect("good text");
        assert_eq!(map.points.len(), 5);
        assert_eq!(map.positions()[3], [10.0, 11.0, 12.0]);
        assert_eq!(map.points[4].id.0, 4);
    }

    #[test]
    fn a_byte_order_mark_is_no_letter() {
        assert_eq!(read("\u{feff}1,2,3\n").expect("good text").points.len(), 1);
    }

    #[test]
    fn letters_are_named_with_their_line() {
        assert_eq!(
            message("1,2,3\n4,five,6\n"),
            "line 2: 'five' in column 2 is not a number"
        );
        assert_eq!(
            message("x,y,z\nx,y,z\n1,2,3"),
            "line 2: 'x' in column 1 is not a number"
        );
    }

    #[test]
    fn missing_columns_do_not_shift() {
        assert_eq!(
            message("1,2,3\n1,,3,4\n"),
            "line 2: '' in column 2 is not a number"
        );
        assert_eq!(
            message("1,2,3\n\n1,2\n"),
            "line 3: 2 columns where 3 belong"
        );
    }

    #[test]
    fn nan_is_refused_with_its_line() {
        assert!(message("1,2,3\n1,nan,3\n").starts_with("line 2: the value in column 2 is NaN"));
        assert!(message("inf 2 3\n").starts_with("line 1: the value in column 1 is NaN"));
    }

    #[test]
    fn nothing_is_not_a_map() {
        assert!(matches!(read(""), Err(ReadError::Empty)));
        assert!(matches!(read("# only words\n"), Err(ReadError::NoPoints)));
        assert!(matches!(read("x,y,z\n"), Err(ReadError::NoPoints)));
    }
}
