//! Keyframe tables: `keyframe_id, frame_id, timestamp, x, y, z, qx, qy, qz, qw` as CSV.

use std::collections::BTreeSet;
use std::io::{self, BufRead, Write};

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use crate::{Fault, KeyFrame, KeyFrameId, ReadError, fields, lines::Lines};

const COLUMNS: usize = 10;

/// Reads keyframes, camera-to-world in map units, ascending by id. The frame's number is not used; an empty timestamp is
/// a time that nobody knows.
///
/// # Errors
/// [`ReadError::At`] with the line for too few columns, what is no finite number, a quaternion without length, or an
/// id that came before.
///
/// # Example
/// ```
/// let keyframes = slam_bridge::read_keyframes("7,7,0.5,1,2,3,0,0,0,1\n8,8,,1,2,4,0,0,0,1\n".as_bytes())?;
/// assert_eq!(keyframes[0].center().z, 3.0);
/// assert_eq!((keyframes[0].time, keyframes[1].time), (Some(0.5), None));
/// # Ok::<(), slam_bridge::ReadError>(())
/// ```
pub fn read_keyframes<R: BufRead>(reader: R) -> Result<Vec<KeyFrame>, ReadError> {
    let mut lines = Lines::new(reader);
    let mut keyframes = Vec::new();
    let mut used = BTreeSet::new();
    while let Some((number, line)) = lines.next_filled()? {
        if line.starts_with('#') || line.starts_with("keyframe_id") {
            continue;
        }
        let keyframe = keyframe(line).and_then(|keyframe| match used.insert(keyframe.id) {
            true => Ok(keyframe),
            false => Err(Fault::Id {
                id: keyframe.id.0.to_string(),
            }),
        });
        keyframes.push(keyframe.map_err(|fault| ReadError::at_line(number, fault))?);
    }
    keyframes.sort_by_key(|keyframe| keyframe.id);
    Ok(keyframes)
}

/// Writes keyframes as [`read_keyframes`] reads them, with every digit that the numbers have.
///
/// # Errors
/// Those of the writer.
pub fn write_keyframes<W: Write>(keyframes: &[KeyFrame], mut writer: W) -> io::Result<()> {
    writeln!(writer, "keyframe_id,frame_id,timestamp,x,y,z,qx,qy,qz,qw")?;
    for keyframe in keyframes {
        let id = keyframe.id.0;
        let time = keyframe
            .time
            .map_or_else(String::new, |time| time.to_string());
        let [x, y, z, qx, qy, qz, qw] = pose_numbers(&keyframe.world_from_camera);
        writeln!(writer, "{id},{id},{time},{x},{y},{z},{qx},{qy},{qz},{qw}")?;
    }
    writer.flush()
}

fn keyframe(line: &str) -> Result<KeyFrame, Fault> {
    let fields = fields::split(line);
    if fields.len() < COLUMNS {
        return Err(Fault::Columns {
            found: fields.len(),
            needed: COLUMNS,
        });
    }
    Ok(KeyFrame {
        id: KeyFrameId(fields::id(fields.first().copied().unwrap_or_default())?),
        time: match fields.get(2) {
            Some(&"") => None,
            _ => Some(fields::finite(&fields, 2)?),
        },
        world_from_camera: pose(&fields, 3)?,
    })
}

/// A pose from seven fields `x y z qx qy qz qw` beginning at `column` (from 0).
pub(crate) fn pose(fields: &[&str], column: usize) -> Result<Isometry3<f64>, Fault> {
    let mut numbers = [0.0; 7];
    for (offset, number) in numbers.iter_mut().enumerate() {
        *number = fields::finite(fields, column + offset)?;
    }
    let [x, y, z, i, j, k, w] = numbers;
    let rotation = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 1e-6)
        .filter(|rotation| rotation.coords.iter().all(|x| x.is_finite()))
        .ok_or(Fault::Quaternion)?;
    Ok(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

/// The same seven numbers of a pose.
pub(crate) fn pose_numbers(pose: &Isometry3<f64>) -> [f64; 7] {
    let [x, y, z]: [f64; 3] = pose.translation.vector.into();
    let [i, j, k, w]: [f64; 4] = pose.rotation.coords.into();
    [x, y, z, i, j, k, w]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        read_keyframes(text.as_bytes())
            .expect_err("bad input")
            .to_string()
    }

    #[test]
    fn faults_name_their_line() {
        let good = "3,3,0.5,1,2,3,0,0,0,1";
        assert!(message(&format!("{good}\n{good}\n")).starts_with("line 2: the id 3"));
        assert_eq!(
            message("1,1,0,1,2,3,0,0,0,0\n"),
            "line 1: the quaternion has no length"
        );
        assert_eq!(
            message("1,1,0,1,2,3\n"),
            "line 1: 6 columns where 10 belong"
        );
        assert!(message("-1,1,0,1,2,3,0,0,0,1\n").contains("the id -1"));
    }
}
