//! The text files of a TUM sequence: "timestamp filename" lines, and which image belongs to which depth.

use super::SequenceError;

/// A time stamp and a file name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub(super) time: f64,
    pub(super) file: String,
}

/// Parses "timestamp filename" lines; `#` begins a comment.
pub(super) fn parse_list(text: &str, name: &'static str) -> Result<Vec<Entry>, SequenceError> {
    let mut entries = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut words = line.split_whitespace();
        let time = words
            .next()
            .and_then(|word| word.parse::<f64>().ok())
            .filter(|t| t.is_finite());
        let (Some(time), Some(file)) = (time, words.next()) else {
            return Err(SequenceError::Line {
                name,
                line: index + 1,
            });
        };
        entries.push(Entry {
            time,
            file: file.to_owned(),
        });
    }
    Ok(entries)
}

/// Parses one time a line; what follows it on the line is left out, `#` begins a comment.
pub(super) fn parse_times(text: &str) -> Result<Vec<f64>, SequenceError> {
    let parse = |(index, line): (usize, &str)| {
        let word = line.split_whitespace().next();
        let value = word.and_then(|word| word.parse::<f64>().ok());
        value.filter(|v| v.is_finite()).ok_or(SequenceError::Line {
            name: "timestamps.txt",
            line: index + 1,
        })
    };
    let filled = |(_, line): &(usize, &str)| {
        let line = line.trim();
        !(line.is_empty() || line.starts_with('#'))
    };
    text.lines().enumerate().filter(filled).map(parse).collect()
}

/// For each image the nearest depth within `limit` seconds.
pub(super) fn pair(images: &[Entry], depths: &[Entry], limit: f64) -> Vec<Option<usize>> {
    let mut order: Vec<usize> = (0..depths.len()).collect();
    order.sort_by(|&a, &b| depths[a].time.total_cmp(&depths[b].time));
    let nearest = |image: &Entry| {
        let after = order.partition_point(|&k| depths[k].time < image.time);
        let near = after.saturating_sub(1)..(after + 1).min(order.len());
        let gap = |k: usize| (depths[k].time - image.time).abs();
        let best = order[near]
            .iter()
            .copied()
            .min_by(|&a, &b| gap(a).total_cmp(&gap(b)))?;
        (gap(best) <= limit).then_some(best)
    };
    images.iter().map(nearest).collect()
}

#[cfg(test)]
mod tests {
    use super::super::calibration::parse_intrinsics;
    use super::*;
    use proptest::prelude::*;

    /// Words of lists and rubbish, so that lines are often nearly right.
    fn rubbish() -> impl Strategy<Value = String> {
        let word = prop_oneof![
            Just("#".to_owned()),
            Just("\n".to_owned()),
            Just("\r\n".to_owned()),
            Just("\u{feff}".to_owned()),
            Just("nan".to_owned()),
            Just("1e999".to_owned()),
            Just("-inf".to_owned()),
            Just("a.png".to_owned()),
            any::<f64>().prop_map(|x| x.to_string()),
            "[ -~\u{e4}\u{1f600}]{0,6}",
        ];
        prop::collection::vec(word, 0..30).prop_map(|words| words.join(" "))
    }

    proptest! {
        #[test]
        fn any_text_is_a_list_or_an_error_that_names_a_line(text in rubbish()) {
            let lines = text.lines().count();
            match parse_list(&text, "rgb.txt") {
                Ok(entries) => {
                    prop_assert!(entries.len() <= lines);
                    prop_assert!(entries.iter().all(|e| e.time.is_finite() && !e.file.is_empty()));
                    let partners = pair(&entries, &entries, 0.02);
                    let same = |(k, partner): (usize, &Option<usize>)| {
                        partner.is_some_and(|p| entries[p].time == entries[k].time)
                    };
                    prop_assert!(partners.iter().enumerate().all(same));
                }
                Err(SequenceError::Line { name, line }) => {
                    prop_assert!(name == "rgb.txt" && (1..=lines).contains(&line));
                }
                Err(other) => prop_assert!(false, "{other:?}"),
            }
            if let Ok(times) = parse_times(&text) {
                prop_assert!(times.len() <= lines && times.iter().all(|t| t.is_finite()));
            }
            if let Ok(camera) = parse_intrinsics(&text) {
                prop_assert!(camera.pinhole.fx > 0.0 && camera.pinhole.fy > 0.0);
            }
        }

        #[test]
        fn what_was_listed_is_read_again(
            entries in prop::collection::vec((-1e9..1e9f64, "[a-z0-9/_.]{1,12}"), 0..20),
        ) {
            let text: String = entries.iter().map(|(t, f)| format!("{t} {f} more\n")).collect();
            let found = parse_list(&text, "rgb.txt").unwrap();
            let found: Vec<(f64, String)> = found.into_iter().map(|e| (e.time, e.file)).collect();
            let times: Vec<f64> = entries.iter().map(|e| e.0).collect();
            prop_assert_eq!(parse_times(&text).unwrap(), times);
            prop_assert_eq!(found, entries);
        }

        #[test]
        fn the_partner_is_the_nearest(
            images in prop::collection::vec(0.0..1.0f64, 0..12), depths in prop::collection::vec(0.0..1.0f64, 0..12),
        ) {
            let entries = |times: &[f64]| -> Vec<Entry> {
                times.iter().map(|&time| Entry { time, file: String::new() }).collect()
            };
            let found = pair(&entries(&images), &entries(&depths), 0.1);
            for (image, partner) in images.iter().zip(found) {
                let gap = depths.iter().map(|d| (d - image).abs()).fold(f64::INFINITY, f64::min);
                prop_assert_eq!(partner.is_some(), gap <= 0.1);
                prop_assert!(partner.is_none_or(|k| (depths[k] - image).abs() == gap));
            }
        }
    }

    #[test]
    fn lists_are_read_and_paired() {
        let images = parse_list(
            "# time file\n1.00 a.png\n\n2.00 b.png\n3.00 c.png\n",
            "rgb.txt",
        )
        .unwrap();
        let depths = parse_list("2.015 y.png\n1.01 x.png", "depth.txt").unwrap();
        assert_eq!(pair(&images, &depths, 0.02), [Some(1), Some(0), None]);
        assert_eq!(pair(&images, &[], 0.02), [None, None, None]);
        assert!(matches!(
            parse_list("1.0\n", "rgb.txt"),
            Err(SequenceError::Line { line: 1, .. })
        ));
        assert!(parse_list("nan a.png\n", "rgb.txt").is_err());
    }
}
