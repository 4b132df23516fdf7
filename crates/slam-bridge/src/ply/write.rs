//! Map to ASCII PLY, with every digit that the coordinates have.

use std::io::{self, Write};

use super::header::{EPOCH_COMMENT, FRUSTUM_COMMENT, SCALE_COMMENT};
use crate::{Map, Scale};

/// Writes the points of a map as ASCII PLY: `x y z nx ny nz observations id`, and `max_distance` if a point has one.
///
/// `nx ny nz` is the mean viewing direction (0 0 0 where unknown), `observations` the number of
/// keyframes that see the point, `max_distance` 0 where unknown. Scale, epoch and field of view go into comments that
/// [`read_ply`](crate::read_ply) understands. Reading the file gives back the same points without
/// their observers, which [`write_observations`](crate::write_observations) keeps.
///
/// # Errors
/// Those of the writer.
///
/// # Example
/// ```
/// let map = slam_bridge::Map::from_positions([[1.0, 2.0, 3.5]]);
/// let mut file = Vec::new();
/// slam_bridge::write_ply(&map, &mut file)?;
/// assert_eq!(slam_bridge::read_ply(file.as_slice()).ok(), Some(map));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_ply<W: Write>(map: &Map, mut writer: W) -> io::Result<()> {
    writeln!(
        writer,
        "ply\nformat ascii 1.0\ncomment sparse map written by slam-bridge"
    )?;
    if let Scale::MetersPerUnit(meters) = map.scale {
        writeln!(writer, "comment {SCALE_COMMENT} {meters}")?;
    }
    if map.epoch != 0 {
        writeln!(writer, "comment {EPOCH_COMMENT} {}", map.epoch)?;
    }
    if let Some(frustum) = map.frustum {
        let (horizontal, vertical) = (frustum.half_horizontal, frustum.half_vertical);
        writeln!(writer, "comment {FRUSTUM_COMMENT} {horizontal} {vertical}")?;
    }
    writeln!(writer, "element vertex {}", map.points.len())?;
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        writeln!(writer, "property double {name}")?;
    }
    writeln!(writer, "property int observations\nproperty int id")?;
    let reaching = map.points.iter().any(|point| point.max_distance.is_some());
    if reaching {
        writeln!(writer, "property double max_distance")?;
    }
    writeln!(writer, "end_header")?;
    for point in &map.points {
        let [x, y, z]: [f64; 3] = point.position.into();
        let [u, v, w]: [f64; 3] = point.viewing_direction.unwrap_or_default().into();
        let (observations, id) = (point.observers.len(), point.id.0);
        write!(writer, "{x} {y} {z} {u} {v} {w} {observations} {id}")?;
        if reaching {
            write!(writer, " {}", point.max_distance.unwrap_or(0.0))?;
        }
        writeln!(writer)?;
    }
    writer.flush()
}
