//! Trajectories in the text format of the TUM RGB-D benchmark: `time tx ty tz qx qy qz qw`.

use std::io::{self, BufRead, Write};

use nalgebra::Isometry3;

use crate::{
    Fault, ReadError, fields,
    keyframes::{pose, pose_numbers},
    lines::Lines,
};

/// A pose and when it was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedPose {
    /// Seconds of the source's clock.
    pub time: f64,
    /// Body- or camera-to-world.
    pub pose: Isometry3<f64>,
}

/// Reads a trajectory, in the file's order. Lines beginning with `#` are comments.
///
/// # Errors
/// [`ReadError::At`] with the line for anything but eight finite numbers and a quaternion with
/// length; [`ReadError::Empty`].
///
/// # Example
/// ```
/// let poses = slam_bridge::read_tum("# t x y z q\n0.5 1 2 3 0 0 0 1\n".as_bytes())?;
/// assert_eq!(poses[0].pose.translation.z, 3.0);
/// # Ok::<(), slam_bridge::ReadError>(())
/// ```
pub fn read_tum<R: BufRead>(reader: R) -> Result<Vec<TimedPose>, ReadError> {
    let mut lines = Lines::new(reader);
    let mut poses = Vec::new();
    while let Some((number, line)) = lines.next_filled()? {
        if !line.starts_with('#') {
            poses.push(timed_pose(line).map_err(|fault| ReadError::at_line(number, fault))?);
        }
    }
    if lines.number() == 0 {
        Err(ReadError::Empty)
    } else {
        Ok(poses)
    }
}

/// Writes a trajectory with every digit that the numbers have.
///
/// # Errors
/// Those of the writer.
pub fn write_tum<W: Write>(poses: &[TimedPose], mut writer: W) -> io::Result<()> {
    writeln!(writer, "# time tx ty tz qx qy qz qw")?;
    for TimedPose { time, pose } in poses {
        let [x, y, z, qx, qy, qz, qw] = pose_numbers(pose);
        writeln!(writer, "{time} {x} {y} {z} {qx} {qy} {qz} {qw}")?;
    }
    writer.flush()
}

fn timed_pose(line: &str) -> Result<TimedPose, Fault> {
    let fields = fields::split(line);
    match fields.len() {
        8 => Ok(TimedPose {
            time: fields::finite(&fields, 0)?,
            pose: pose(&fields, 1)?,
        }),
        found => Err(Fault::Columns { found, needed: 8 }),
    }
}
