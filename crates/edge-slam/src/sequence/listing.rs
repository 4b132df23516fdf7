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
    use super::*;

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
