//! Numbers and identities out of text fields.

use crate::Fault;

/// Splits a line at commas, else at semicolons, else at blanks; fields come trimmed.
pub(crate) fn split(line: &str) -> Vec<&str> {
    match [',', ';']
        .into_iter()
        .find(|&separator| line.contains(separator))
    {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// The finite number in a field; `column` counts from 0.
pub(crate) fn finite(fields: &[&str], column: usize) -> Result<f64, Fault> {
    let text = fields.get(column).copied().unwrap_or_default();
    let value: f64 = text
        .parse()
        .map_err(|_| Fault::not_a_number(column + 1, text))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Fault::NonFinite { column: column + 1 })
    }
}

/// The identity in a field.
pub(crate) fn id(text: &str) -> Result<u64, Fault> {
    text.parse().map_err(|_| Fault::Id {
        id: text.chars().take(24).collect(),
    })
}
