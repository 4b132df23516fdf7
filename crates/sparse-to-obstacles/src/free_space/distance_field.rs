//! For every voxel, how far its centre is from the nearest marked voxel: a shortcut for queries.
//!
//! Distances from the centre to a cube are sqrt(sum of max(|d| - 1/2, 0)²) in voxels, which is separable by
//! axis (Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions", 2012). Distances
//! beyond the reach are reported as the reach.

use super::grid::Grid;

/// How far the field looks, in voxels.
const REACH: usize = 12;
const FAR: u16 = ((2 * REACH - 1) * (2 * REACH - 1)) as u16;

/// Four times the squared distance in voxels, at most [`FAR`].
#[derive(Clone, Debug, Default)]
pub(super) struct DistanceField {
    quadruple_squared: Vec<u16>,
}

impl DistanceField {
    pub(super) fn new(grid: &Grid, marked: impl Fn(usize) -> bool) -> Self {
        let mut field: Vec<u16> = (0..grid.len())
            .map(|index| if marked(index) { 0 } else { FAR })
            .collect();
        let strides = grid.strides();
        let mut line = Vec::new();
        for axis in [2, 1, 0] {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            for i in 0..grid.size[a] {
                for j in 0..grid.size[b] {
                    let start = i * strides[a] + j * strides[b];
                    spread(&mut field, start, strides[axis], grid.size[axis], &mut line);
                }
            }
        }
        DistanceField {
            quadruple_squared: field,
        }
    }

    /// Distance from the voxel's centre to the nearest marked cube, in voxels: exact below the reach,
    /// otherwise at least what is returned.
    #[inline]
    pub(super) fn voxels(&self, index: usize) -> f64 {
        0.5 * f64::from(self.quadruple_squared[index]).sqrt()
    }

    /// Is the distance exact, and not cut off at the reach?
    #[inline]
    pub(super) fn is_exact(&self, index: usize) -> bool {
        self.quadruple_squared[index] < FAR
    }
}

/// One line of one pass: each entry takes the least of its neighbours plus what their offset costs.
fn spread(field: &mut [u16], start: usize, stride: usize, count: usize, line: &mut Vec<u16>) {
    line.clear();
    line.extend((0..count).map(|i| field[start + i * stride]));
    if line.iter().all(|&value| value == FAR) || line.iter().all(|&value| value == 0) {
        return;
    }
    for i in 0..count {
        let mut best = line[i];
        for offset in 1..REACH {
            let cost = ((2 * offset - 1) * (2 * offset - 1)) as u16;
            if cost >= best {
                break;
            }
            if i >= offset {
                best = best.min(line[i - offset] + cost);
            }
            if i + offset < count {
                best = best.min(line[i + offset] + cost);
            }
        }
        field[start + i * stride] = best;
    }
}
