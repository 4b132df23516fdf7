//! Which keyframes see which point: `point_id, keyframe_id keyframe_id ...` as CSV.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, BufRead, Write};

use crate::{Fault, KeyFrameId, Map, PointId, ReadError, fields, lines::Lines};

/// What [`read_observations`] could not use: a SLAM system may cull points and keyframes while it
/// writes its files one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Unmatched {
    /// Lines about a point that the map does not hold.
    pub points: usize,
    /// Observations by a keyframe that the map does not hold.
    pub observations: usize,
}

/// Reads observations into [`MapPoint::observers`](crate::MapPoint::observers) of a map that
/// already has points and keyframes; earlier observers of a point that the file names are replaced.
///
/// # Errors
/// [`ReadError::At`] with the line for letters or negative ids.
pub fn read_observations<R: BufRead>(reader: R, map: &mut Map) -> Result<Unmatched, ReadError> {
    let rows: BTreeMap<PointId, usize> = map
        .points
        .iter()
        .enumerate()
        .map(|(row, point)| (point.id, row))
        .collect();
    let known: BTreeSet<KeyFrameId> = map.keyframes.iter().map(|keyframe| keyframe.id).collect();
    let mut lines = Lines::new(reader);
    let mut unmatched = Unmatched::default();
    while let Some((number, line)) = lines.next_filled()? {
        if line.starts_with('#') || line.starts_with("point_id") {
            continue;
        }
        let (id, mut observers) =
            observation(line).map_err(|fault| ReadError::at_line(number, fault))?;
        let named = observers.len();
        observers.retain(|keyframe| known.contains(keyframe));
        unmatched.observations += named - observers.len();
        match rows.get(&id).and_then(|&row| map.points.get_mut(row)) {
            Some(point) => point.observers = observers.into_iter().collect(),
            None => unmatched.points += 1,
        }
    }
    Ok(unmatched)
}

/// Writes observations as [`read_observations`] reads them, points without any left out.
///
/// # Errors
/// Those of the writer.
pub fn write_observations<W: Write>(map: &Map, mut writer: W) -> io::Result<()> {
    writeln!(writer, "point_id,keyframe_ids")?;
    for point in map
        .points
        .iter()
        .filter(|point| !point.observers.is_empty())
    {
        write!(writer, "{}", point.id.0)?;
        for (index, keyframe) in point.observers.iter().enumerate() {
            write!(
                writer,
                "{}{}",
                if index == 0 { ',' } else { ' ' },
                keyframe.0
            )?;
        }
        writeln!(writer)?;
    }
    writer.flush()
}

fn observation(line: &str) -> Result<(PointId, BTreeSet<KeyFrameId>), Fault> {
    let mut fields = line
        .split([',', ';', ' ', '\t'])
        .filter(|field| !field.is_empty());
    let point = fields::id(fields.next().unwrap_or_default())?;
    let observers = fields
        .map(|field| fields::id(field).map(KeyFrameId))
        .collect::<Result<_, _>>();
    Ok((PointId(point), observers?))
}
