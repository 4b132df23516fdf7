//! The header of a PLY file: which rows follow, in which encoding, and what its comments tell.

use std::io::BufRead;

use super::scalar::{Endian, Scalar};
use crate::{Fault, Frustum, ReadError, Scale, lines::Lines};

/// How rows are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Encoding {
    #[default]
    Ascii,
    Binary(Endian),
}

/// One column of a kind of row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Property {
    Scalar { name: String, kind: Scalar },
    List { count: Scalar, item: Scalar },
}

/// One kind of row. The count is the header's word: never allocate by it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// Where a scalar property stands in its row.
    pub(super) fn column(&self, wanted: &str) -> Option<usize> {
        self.properties.iter().position(
            |property| matches!(property, Property::Scalar { name, .. } if name == wanted),
        )
    }
}

/// All of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    pub(super) scale: Scale,
    pub(super) epoch: u64,
    pub(super) frustum: Option<Frustum>,
}

/// Comments with which our writer keeps what PLY has no place for.
pub(super) const SCALE_COMMENT: &str = "meters_per_unit";
pub(super) const EPOCH_COMMENT: &str = "epoch";
pub(super) const FRUSTUM_COMMENT: &str = "frustum_half_angles";

impl Header {
    /// Reads up to and with the line `end_header`.
    pub(super) fn read<R: BufRead>(lines: &mut Lines<R>) -> Result<Self, ReadError> {
        match lines.next()? {
            None => return Err(ReadError::Empty),
            Some((_, line)) if line.trim_end() == "ply" => {}
            Some(_) => {
                return Err(ReadError::Unrecognized {
                    format: "PLY",
                    begins: "ply",
                });
            }
        }
        let mut header = Self::default();
        let mut encoding = None;
        while let Some((number, line)) = lines.next()? {
            let words: Vec<&str> = line.split_whitespace().collect();
            let parsed = match words.first() {
                Some(&"end_header") => {
                    header.encoding = encoding.ok_or(ReadError::Missing { what: "format" })?;
                    return Ok(header);
                }
                Some(&"format") => parse_encoding(&words).map(|found| encoding = Some(found)),
                Some(&"element") => parse_element(&words).map(|found| header.elements.push(found)),
                Some(&"property") => header.push_property(&words),
                Some(&"comment") => {
                    header.take_comment(&words);
                    Some(())
                }
                Some(&"obj_info") | None => Some(()),
                Some(_) => None,
            };
            if parsed.is_none() {
                return Err(ReadError::at_line(
                    number,
                    Fault::header("a PLY header line", line),
                ));
            }
        }
        Err(ReadError::Missing { what: "end_header" })
    }

    fn push_property(&mut self, words: &[&str]) -> Option<()> {
        let property = match words {
            ["property", "list", count, item, _] => Property::List {
                count: Scalar::named(count)?,
                item: Scalar::named(item)?,
            },
            ["property", kind, name] => Property::Scalar {
                name: (*name).to_owned(),
                kind: Scalar::named(kind)?,
            },
            _ => return None,
        };
        self.elements.last_mut()?.properties.push(property);
        Some(())
    }

    /// Takes up a comment of our own writer; all others are only comments.
    fn take_comment(&mut self, words: &[&str]) {
        let number = |index: usize| {
            let text: Option<&&str> = words.get(index);
            text.and_then(|text| text.parse::<f64>().ok())
                .filter(|x| x.is_finite() && *x > 0.0)
        };
        match words.get(1) {
            Some(&SCALE_COMMENT) => {
                self.scale = number(2).map_or(Scale::Unknown, Scale::MetersPerUnit);
            }
            Some(&EPOCH_COMMENT) => {
                self.epoch = words
                    .get(2)
                    .and_then(|text| text.parse().ok())
                    .unwrap_or_default();
            }
            Some(&FRUSTUM_COMMENT) => {
                self.frustum = number(2)
                    .zip(number(3))
                    .map(|(half_horizontal, half_vertical)| Frustum {
                        half_horizontal,
                        half_vertical,
                    });
            }
            _ => {}
        }
    }
}

fn parse_encoding(words: &[&str]) -> Option<Encoding> {
    match words {
        ["format", "ascii", _] => Some(Encoding::Ascii),
        ["format", "binary_little_endian", _] => Some(Encoding::Binary(Endian::Little)),
        ["format", "binary_big_endian", _] => Some(Encoding::Binary(Endian::Big)),
        _ => None,
    }
}

fn parse_element(words: &[&str]) -> Option<Element> {
    let ["element", name, count] = words else {
        return None;
    };
    let count = count.parse().ok()?;
    Some(Element {
        name: (*name).to_owned(),
        count,
        properties: Vec::new(),
    })
}
