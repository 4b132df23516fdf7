//! Coordinates as short JSON: as many digits as a screen can show.

use core::fmt::Write as _;

/// Digits behind the point that a scene of this size needs.
pub(super) fn digits(size: f64) -> usize {
    if size.is_finite() && size > 0.0 {
        (4.0 - size.log10()).clamp(0.0, 12.0) as usize
    } else {
        4
    }
}

/// A flat JSON array of all coordinates.
pub(super) fn flat<'a>(points: impl IntoIterator<Item = &'a [f64; 3]>, digits: usize) -> String {
    let mut json = String::from("[");
    for value in points.into_iter().flatten() {
        if json.len() > 1 {
            json.push(',');
        }
        let value = if value.is_finite() { *value } else { 0.0 };
        // A `String` takes everything.
        let _ = write!(json, "{value:.digits$}");
    }
    json.push(']');
    json
}

/// A JSON array of flat arrays.
pub(super) fn nested(paths: &[Vec<[f64; 3]>], digits: usize) -> String {
    let paths: Vec<String> = paths.iter().map(|path| flat(path, digits)).collect();
    format!("[{}]", paths.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_is_short_and_valid() {
        let json = flat(&[[1.0, f64::NAN, -2.55555]], digits(5.0));
        assert_eq!(json, "[1.000,0.000,-2.556]");
        assert_eq!(nested(&[vec![], vec![[0.0; 3]]], 0), "[[],[0,0,0]]");
    }
}
