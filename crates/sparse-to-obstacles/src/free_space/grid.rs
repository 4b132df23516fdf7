//! A dense voxel grid on multiples of the resolution, with bounded size.

use super::error::FreeSpaceError;
use crate::vector::{Vec3, sub};
use std::ops::Range;

/// Integer coordinates of a voxel: its low corner divided by the resolution.
pub(super) type Cell = [i64; 3];

/// Which voxels there are and where; z runs fastest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    pub(super) resolution: f64,
    pub(super) low: Cell,
    pub(super) size: [usize; 3],
}

/// Cells beyond this are refused, so that no conversion overflows.
const FARTHEST: f64 = 1e12;

impl Grid {
    pub(super) fn empty(resolution: f64) -> Self {
        Grid {
            resolution,
            low: [0; 3],
            size: [0; 3],
        }
    }

    pub(super) fn len(&self) -> usize {
        self.size[0] * self.size[1] * self.size[2]
    }

    /// How far apart the indices of neighbours along each axis are.
    pub(super) fn strides(&self) -> [usize; 3] {
        [self.size[1] * self.size[2], self.size[2], 1]
    }

    /// The grid that also holds the box from `low` to `high`.
    pub(super) fn grown(
        &self,
        low: Vec3,
        high: Vec3,
        max_voxels: usize,
    ) -> Result<Self, FreeSpaceError> {
        let resolution = self.resolution;
        let mut from = low.map(|c| (c / resolution).floor());
        let mut to = high.map(|c| (c / resolution).floor() + 1.0);
        if self.len() > 0 {
            for axis in 0..3 {
                from[axis] = from[axis].min(self.low[axis] as f64);
                to[axis] = to[axis].max((self.low[axis] + self.size[axis] as i64) as f64);
            }
        }
        let extent = sub(to, from);
        let voxels = extent[0] * extent[1] * extent[2];
        let far = from.iter().chain(&to).any(|c| c.abs() > FARTHEST);
        if far || voxels > max_voxels as f64 {
            let extent = extent.map(|cells| cells * resolution);
            return Err(FreeSpaceError::TooManyVoxels {
                extent,
                resolution,
                voxels,
                max_voxels,
            });
        }
        Ok(Grid {
            resolution,
            low: from.map(|c| c as i64),
            size: extent.map(|c| c as usize),
        })
    }

    #[inline]
    pub(super) fn cell_of(&self, point: Vec3) -> Cell {
        point.map(|c| floor(c / self.resolution))
    }

    #[inline]
    pub(super) fn index(&self, cell: Cell) -> Option<usize> {
        let x = cell[0].wrapping_sub(self.low[0]) as usize;
        let y = cell[1].wrapping_sub(self.low[1]) as usize;
        let z = cell[2].wrapping_sub(self.low[2]) as usize;
        (x < self.size[0] && y < self.size[1] && z < self.size[2])
            .then(|| (x * self.size[1] + y) * self.size[2] + z)
    }

    pub(super) fn index_of(&self, point: Vec3) -> Option<usize> {
        self.index(self.cell_of(point))
    }

    pub(super) fn cell_at(&self, index: usize) -> Cell {
        let z = index % self.size[2];
        let y = index / self.size[2] % self.size[1];
        let x = index / (self.size[2] * self.size[1]);
        [
            self.low[0] + x as i64,
            self.low[1] + y as i64,
            self.low[2] + z as i64,
        ]
    }

    #[inline]
    pub(super) fn corner(&self, cell: Cell) -> Vec3 {
        cell.map(|c| c as f64 * self.resolution)
    }

    #[inline]
    pub(super) fn centre(&self, cell: Cell) -> Vec3 {
        cell.map(|c| (c as f64 + 0.5) * self.resolution)
    }

    /// The squared distance from a point to the cube of a cell.
    #[inline]
    pub(super) fn squared_to_cube(&self, cell: Cell, point: Vec3) -> f64 {
        let mut squared = 0.0;
        for axis in 0..3 {
            let low = cell[axis] as f64 * self.resolution;
            let high = (cell[axis] + 1) as f64 * self.resolution;
            let gap = (low - point[axis]).max(point[axis] - high).max(0.0);
            squared += gap * gap;
        }
        squared
    }

    /// The cells of the grid around a segment, as far as this away along the axes.
    #[inline]
    pub(super) fn around(&self, a: Vec3, b: Vec3, reach: f64) -> CellBox {
        let mut low = self.cell_of(crate::vector::min(a, b).map(|c| c - reach));
        let mut high = self.cell_of(crate::vector::max(a, b).map(|c| c + reach));
        let mut is_clipped = false;
        for axis in 0..3 {
            let (first, last) = (self.low[axis], self.low[axis] + self.size[axis] as i64 - 1);
            is_clipped |= low[axis] < first || high[axis] > last;
            low[axis] = low[axis].max(first);
            high[axis] = high[axis].min(last);
        }
        CellBox {
            low,
            high,
            is_clipped,
        }
    }

    /// Calls `visit` with the index of every cell of the grid whose cube the ball touches.
    pub(super) fn for_each_touched(&self, centre: Vec3, radius: f64, mut visit: impl FnMut(usize)) {
        let low = self.cell_of(centre.map(|c| c - radius));
        let high = self.cell_of(centre.map(|c| c + radius));
        // Cubes that the ball touches in one point count, also on the far side of a cell's border.
        for x in low[0] - 1..=high[0] {
            for y in low[1] - 1..=high[1] {
                for z in low[2] - 1..=high[2] {
                    let cell = [x, y, z];
                    if self.squared_to_cube(cell, centre) <= radius * radius
                        && let Some(index) = self.index(cell)
                    {
                        visit(index);
                    }
                }
            }
        }
    }
}

/// A box of cells inside the grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellBox {
    low: Cell,
    high: Cell,
    /// Was a part of it outside the grid?
    pub(super) is_clipped: bool,
}

impl CellBox {
    /// The rows along z: the first cell of each, and the indices of all its cells.
    pub(super) fn rows(self, grid: &Grid) -> impl Iterator<Item = (Cell, Range<usize>)> {
        let length = (self.high[2] - self.low[2] + 1).max(0) as usize;
        (self.low[0]..=self.high[0]).flat_map(move |x| {
            (self.low[1]..=self.high[1]).filter_map(move |y| {
                let cell = [x, y, self.low[2]];
                let start = grid.index(cell)?;
                (length > 0).then_some((cell, start..start + length))
            })
        })
    }
}

/// The largest integer not above `value`; saturates. Without a call, unlike the standard one.
#[inline]
fn floor(value: f64) -> i64 {
    let towards_zero = value as i64;
    towards_zero.saturating_sub(i64::from(towards_zero as f64 > value))
}
