//! The header of a PCD file.

use std::io::BufRead;

use crate::{Fault, ReadError, lines::Lines};

/// How the numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Encoding {
    #[default]
    Ascii,
    Binary,
    Compressed,
}

/// The kinds of numbers: signed, unsigned, floating.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Signed,
    Unsigned,
    Float,
}

/// One named column, `count` numbers wide.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) size: usize,
    pub(super) count: usize,
}

impl Field {
    pub(super) fn bytes(&self) -> usize {
        self.size * self.count
    }

    /// The field's first number, little endian; `None` for a size that the format does not know.
    pub(super) fn decode(&self, bytes: &[u8]) -> Option<f64> {
        match (self.kind, bytes.get(..self.size)?) {
            (Kind::Float, &[a, b, c, d]) => Some(f64::from(f32::from_le_bytes([a, b, c, d]))),
            (Kind::Float, &[a, b, c, d, e, f, g, h]) => {
                Some(f64::from_le_bytes([a, b, c, d, e, f, g, h]))
            }
            (Kind::Signed, &[a, b, c, d]) => Some(f64::from(i32::from_le_bytes([a, b, c, d]))),
            (Kind::Unsigned, &[a, b, c, d]) => Some(f64::from(u32::from_le_bytes([a, b, c, d]))),
            _ => None,
        }
    }
}

/// All of it. `points` is the header's word: never allocate by it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Header {
    pub(super) fields: Vec<Field>,
    pub(super) points: u64,
    pub(super) encoding: Encoding,
}

/// Columns and their numbers are bounded, so that no row is absurdly long.
const MAX_ROW_BYTES: usize = 1 << 16;

impl Header {
    /// Reads up to and with the line `DATA`.
    pub(super) fn read<R: BufRead>(lines: &mut Lines<R>) -> Result<Self, ReadError> {
        let mut draft = Draft::default();
        let mut last = 0;
        while let Some((number, line)) = lines.next()? {
            last = number;
            let line = line.trim();
            let (key, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
            if number == 1 && !line.starts_with('#') && key != "VERSION" {
                return Err(ReadError::Unrecognized {
                    format: "PCD",
                    begins: "# .PCD",
                });
            }
            let taken = draft.take(key, rest);
            let fault = Fault::header("a PCD header line", line);
            if taken.ok_or_else(|| ReadError::at_line(number, fault))? {
                return draft.finish();
            }
        }
        Err(if last == 0 {
            ReadError::Empty
        } else {
            ReadError::Missing { what: "DATA" }
        })
    }

    pub(super) fn row_bytes(&self) -> usize {
        self.fields.iter().map(Field::bytes).sum()
    }
}

/// Header lines as they come.
#[derive(Debug, Default)]
struct Draft {
    names: Vec<String>,
    sizes: Vec<usize>,
    kinds: Vec<Kind>,
    counts: Option<Vec<usize>>,
    size_of_grid: [Option<u64>; 2],
    points: Option<u64>,
    encoding: Encoding,
}

impl Draft {
    /// Takes one line; true at the last, `None` when it makes no sense.
    fn take(&mut self, key: &str, rest: &str) -> Option<bool> {
        match key {
            "FIELDS" => self.names = rest.split_whitespace().map(str::to_owned).collect(),
            "SIZE" => self.sizes = numbers(rest)?,
            "COUNT" => self.counts = Some(numbers(rest)?),
            "TYPE" => self.kinds = rest.split_whitespace().map(kind).collect::<Option<_>>()?,
            "WIDTH" => self.size_of_grid[0] = Some(rest.trim().parse().ok()?),
            "HEIGHT" => self.size_of_grid[1] = Some(rest.trim().parse().ok()?),
            "POINTS" => self.points = Some(rest.trim().parse().ok()?),
            "DATA" => {
                self.encoding = match rest.trim() {
                    "ascii" => Encoding::Ascii,
                    "binary" => Encoding::Binary,
                    "binary_compressed" => Encoding::Compressed,
                    _ => return None,
                };
                return Some(true);
            }
            "" | "VERSION" | "VIEWPOINT" => {}
            _ if key.starts_with('#') => {}
            _ => return None,
        }
        Some(false)
    }

    fn finish(self) -> Result<Header, ReadError> {
        let counts = self.counts.unwrap_or_else(|| vec![1; self.names.len()]);
        let columns = self.names.len();
        if columns != self.sizes.len() || columns != self.kinds.len() || columns != counts.len() {
            return Err(ReadError::Missing {
                what: "SIZE, TYPE and COUNT for each of its FIELDS",
            });
        }
        let parts = self
            .names
            .into_iter()
            .zip(self.kinds)
            .zip(self.sizes.into_iter().zip(counts));
        let fields = parts
            .map(|((name, kind), (size, count))| Field {
                name,
                kind,
                size,
                count,
            })
            .collect::<Vec<_>>();
        let row = fields.iter().fold(0_usize, |sum, field| {
            sum.saturating_add(field.size.saturating_mul(field.count))
        });
        if row == 0 || row > MAX_ROW_BYTES {
            return Err(ReadError::Missing {
                what: "FIELDS of sensible size",
            });
        }
        let grid = self.size_of_grid[0].zip(self.size_of_grid[1]);
        let points = self
            .points
            .or_else(|| grid.and_then(|(w, h)| w.checked_mul(h)));
        let points = points.ok_or(ReadError::Missing { what: "POINTS" })?;
        Ok(Header {
            fields,
            points,
            encoding: self.encoding,
        })
    }
}

fn numbers(text: &str) -> Option<Vec<usize>> {
    text.split_whitespace()
        .map(|word| word.parse().ok())
        .collect()
}

fn kind(word: &str) -> Option<Kind> {
    match word {
        "I" => Some(Kind::Signed),
        "U" => Some(Kind::Unsigned),
        "F" => Some(Kind::Float),
        _ => None,
    }
}
