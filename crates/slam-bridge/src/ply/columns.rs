//! Which columns of a PLY vertex hold what a map point needs, and the point made of a row.

use std::collections::BTreeSet;

use nalgebra::{Point3, Vector3};

use super::header::Element;
use crate::{Fault, MapPoint, PointId, ReadError};

/// Column numbers of one file's vertices.
#[derive(Debug)]
pub(super) struct Columns {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    max_distance: Option<usize>,
    id: Option<usize>,
    used_ids: BTreeSet<u64>,
}

impl Columns {
    pub(super) fn of(vertex: &Element) -> Result<Self, ReadError> {
        let three = |names: [&str; 3]| {
            let [a, b, c] = names.map(|name| vertex.column(name));
            Some([a?, b?, c?])
        };
        let position = three(["x", "y", "z"]).ok_or(ReadError::Missing { what: "x, y, z" })?;
        Ok(Self {
            position,
            normal: three(["nx", "ny", "nz"]),
            max_distance: vertex.column("max_distance"),
            id: vertex.column("id"),
            used_ids: BTreeSet::new(),
        })
    }

    /// The point of row number `index`; a file without ids gets row numbers.
    pub(super) fn point(&mut self, index: u64, row: &[f64]) -> Result<MapPoint, Fault> {
        let value = |column: usize| row.get(column).copied().unwrap_or(f64::NAN);
        for column in self.position {
            if !value(column).is_finite() {
                return Err(Fault::NonFinite { column: column + 1 });
            }
        }
        let viewing_direction = self
            .normal
            .map(|columns| Vector3::from(columns.map(value)))
            .and_then(|normal| normal.try_normalize(1e-9))
            .filter(|normal| normal.iter().all(|x| x.is_finite()));
        Ok(MapPoint {
            id: PointId(self.take_id(index, row)?),
            position: Point3::from(self.position.map(value)),
            viewing_direction,
            max_distance: self
                .max_distance
                .map(value)
                .filter(|distance| distance.is_finite() && *distance > 0.0),
            observers: Vec::new(),
        })
    }

    fn take_id(&mut self, index: u64, row: &[f64]) -> Result<u64, Fault> {
        let Some(column) = self.id else {
            return Ok(index);
        };
        let value = row.get(column).copied().unwrap_or(f64::NAN);
        let whole = (0.0..=9e15).contains(&value) && value.fract() == 0.0;
        if whole && self.used_ids.insert(value as u64) {
            Ok(value as u64)
        } else {
            Err(Fault::Id {
                id: value.to_string(),
            })
        }
    }
}
