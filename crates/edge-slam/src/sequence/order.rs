//! The order of pictures that have no list: as people count, and not as letters are compared, which puts 10 before 2.

use std::path::{Path, PathBuf};

/// Sorts files by name: where all names are decimal numbers (a counter, or times) by their values, else text by text with the whole
/// numbers in between by theirs. Equal ones by their letters.
pub(super) fn sort_as_counted(files: &mut [PathBuf]) {
    files.sort();
    let values: Option<Vec<f64>> = files.iter().map(|file| decimal(&stem(file))).collect();
    if values.is_some() {
        // Values are not negative: their bits ascend with them.
        files.sort_by_cached_key(|file| decimal(&stem(file)).map(f64::to_bits));
    } else {
        files.sort_by_cached_key(|file| pieces(&stem(file)));
    }
}

fn stem(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

/// Digits with at most one point.
fn decimal(name: &str) -> Option<f64> {
    let is_plain = name.chars().all(|c| c.is_ascii_digit() || c == '.');
    name.parse().ok().filter(|_| is_plain)
}

/// Each text with the number behind it: how many digits, then which.
fn pieces(name: &str) -> Vec<(String, usize, String)> {
    let mut pieces = Vec::new();
    let mut rest = name;
    while !rest.is_empty() {
        let is_digit = |c: char| c.is_ascii_digit();
        let (text, tail) = rest.split_at(rest.find(is_digit).unwrap_or(rest.len()));
        let end = tail.find(|c| !is_digit(c)).unwrap_or(tail.len());
        let (digits, after) = tail.split_at(end);
        let number = digits.trim_start_matches('0');
        pieces.push((text.to_owned(), number.len(), number.to_owned()));
        rest = after;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sorted(names: &[&str]) -> Vec<String> {
        let mut files: Vec<PathBuf> = names.iter().rev().map(PathBuf::from).collect();
        sort_as_counted(&mut files);
        files
            .iter()
            .map(|file| file.display().to_string())
            .collect()
    }

    #[test]
    fn ten_comes_after_two() {
        for names in [
            &["0.png", "1.png", "2.png", "10.png", "11.png", "100.png"][..],
            &["frame1.jpg", "frame2.jpg", "frame10.jpg", "frame100.jpg"],
            &["a1-b2.png", "a1-b10.png", "a2-b1.png", "b0.png"],
            &[
                "frame-000000.color.png",
                "frame-000001.color.png",
                "frame-000010.color.png",
            ],
            // Times with as many decimals as they need.
            &["9.5.png", "10.png", "10.25.png", "10.3.png"],
            &[
                "1305031230.030002.png",
                "1305031230.065145.png",
                "1305031231.000001.png",
            ],
            // The same number twice; more digits than an integer holds.
            &[
                "x01.png",
                "x1.png",
                "x99999999999999999999.png",
                "x100000000000000000000.png",
            ],
            &["", "-1.png", "é1.png"],
        ] {
            assert_eq!(sorted(names), names);
        }
    }

    proptest! {
        #[test]
        fn numbers_of_any_length_are_counted(mut numbers in prop::collection::btree_set(any::<u32>(), 0..20), prefix in "[a-z]{0,3}") {
            numbers.insert(7);
            let names: Vec<String> = numbers.iter().map(|k| format!("{prefix}{k}.png")).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            prop_assert_eq!(sorted(&names), names);
        }

        #[test]
        fn any_names_are_fine(names in prop::collection::vec("[0-9a.é ]{0,8}", 0..12)) {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            prop_assert_eq!(sorted(&names).len(), names.len());
        }
    }
}
