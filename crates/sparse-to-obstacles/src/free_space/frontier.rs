//! The frontier: proven-free voxels that border on unknown space.

use super::FreeSpace;
use super::query::VoxelState;

impl FreeSpace {
    /// The centres of the proven-free voxels with an unknown voxel behind one of their six faces, in the
    /// order of their coordinates: where there is more to see.
    #[must_use]
    pub fn frontier(&self) -> Vec<[f64; 3]> {
        let borders_unknown = |cell: &[i64; 3]| {
            (0..6).any(|side| {
                let mut beside = *cell;
                beside[side / 2] += if side % 2 == 0 { 1 } else { -1 };
                let index = self.grid.index(beside);
                index.is_none_or(|index| self.state_at(index) == VoxelState::Unknown)
            })
        };
        let cells = self.free_cells().filter(borders_unknown);
        cells.map(|cell| self.grid.centre(cell)).collect()
    }
}
