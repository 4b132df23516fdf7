//! The obstacles as a triangle mesh for viewers: Wavefront OBJ and ASCII PLY.

use super::ObstacleSet;
use crate::hull::Hull;
use std::io::{self, Write};

impl ObstacleSet {
    /// Writes every obstacle as an object `obstacle_N` of a Wavefront OBJ file. Points become point
    /// elements, segments line elements. Coordinates are printed to the last bit.
    ///
    /// # Errors
    /// Whatever the writer reports.
    pub fn write_obj(&self, mut writer: impl Write) -> io::Result<()> {
        let mut base = 1;
        for (number, hull) in self.hulls.iter().enumerate() {
            writeln!(writer, "o obstacle_{number}")?;
            for [x, y, z] in &hull.vertices {
                writeln!(writer, "v {x} {y} {z}")?;
            }
            match hull.vertices.len() {
                1 => writeln!(writer, "p {base}")?,
                2 => writeln!(writer, "l {base} {}", base + 1)?,
                _ => {
                    for [a, b, c] in &hull.triangles {
                        writeln!(writer, "f {} {} {}", base + a, base + b, base + c)?;
                    }
                }
            }
            base += hull.vertices.len();
        }
        Ok(())
    }

    /// Writes all obstacles as one ASCII PLY mesh; each vertex carries the number of its obstacle.
    /// Points and segments have vertices without faces.
    ///
    /// # Errors
    /// Whatever the writer reports.
    pub fn write_ply(&self, mut writer: impl Write) -> io::Result<()> {
        let total = |count: fn(&Hull) -> usize| self.hulls.iter().map(count).sum::<usize>();
        writeln!(writer, "ply\nformat ascii 1.0")?;
        writeln!(
            writer,
            "element vertex {}",
            total(|hull| hull.vertices.len())
        )?;
        writeln!(
            writer,
            "property double x\nproperty double y\nproperty double z"
        )?;
        writeln!(writer, "property int obstacle")?;
        writeln!(
            writer,
            "element face {}",
            total(|hull| hull.triangles.len())
        )?;
        writeln!(writer, "property list uchar int vertex_indices\nend_header")?;
        for (number, hull) in self.hulls.iter().enumerate() {
            for [x, y, z] in &hull.vertices {
                writeln!(writer, "{x} {y} {z} {number}")?;
            }
        }
        let mut base = 0;
        for hull in &self.hulls {
            for [a, b, c] in &hull.triangles {
                writeln!(writer, "3 {} {} {}", base + a, base + b, base + c)?;
            }
            base += hull.vertices.len();
        }
        Ok(())
    }
}
