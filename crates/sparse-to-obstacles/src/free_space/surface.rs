//! The surface points, sorted by voxel.

use super::grid::Grid;
use crate::vector::Vec3;
use std::ops::Range;

#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    points: Vec<Vec3>,
    /// The points inside the grid with the voxel that each lies in, ascending.
    by_voxel: Vec<(u32, Vec3)>,
    /// Where the points of each voxel start in `by_voxel`; one more entry than voxels.
    starts: Vec<u32>,
}

impl Surface {
    pub(super) fn extend(&mut self, points: impl IntoIterator<Item = Vec3>) {
        self.points.extend(points);
    }

    pub(super) fn retain(&mut self, keep: impl FnMut(&Vec3) -> bool) {
        self.points.retain(keep);
    }

    pub(super) fn sort_into(&mut self, grid: &Grid) {
        self.by_voxel = self
            .points
            .iter()
            .filter_map(|&point| Some((grid.index_of(point)? as u32, point)))
            .collect();
        self.by_voxel.sort_by_key(|&(voxel, _)| voxel);
        self.starts = vec![0; grid.len() + 1];
        for &(voxel, _) in &self.by_voxel {
            self.starts[voxel as usize + 1] += 1;
        }
        for index in 0..grid.len() {
            self.starts[index + 1] += self.starts[index];
        }
    }

    #[inline]
    pub(super) fn occupies(&self, voxel: usize) -> bool {
        self.starts[voxel] < self.starts[voxel + 1]
    }

    /// The points in a range of voxels.
    #[inline]
    pub(super) fn in_voxels(&self, voxels: Range<usize>) -> &[(u32, Vec3)] {
        &self.by_voxel[self.starts[voxels.start] as usize..self.starts[voxels.end] as usize]
    }
}
