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
        let [plane, row, _] = grid.strides();
        if row == 0 || plane == 0 {
            return DistanceField {
                quadruple_squared: field,
            };
        }
        for line in field.chunks_exact_mut(row) {
            along_row(line);
        }
        let mut former = Vec::new();
        for x in 0..grid.size[0] {
            across_rows(
                &mut field[x * plane..(x + 1) * plane],
                row,
                row,
                &mut former,
            );
        }
        for y in 0..grid.size[1] {
            across_rows(&mut field[y * row..], row, plane, &mut former);
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

/// What an offset of so many voxels costs.
fn cost(offset: usize) -> u16 {
    if offset < REACH {
        ((2 * offset - 1) * (2 * offset - 1)) as u16
    } else {
        FAR
    }
}

/// The first pass, along a row of marks: the nearest mark on either side.
fn along_row(row: &mut [u16]) {
    let mut since = REACH;
    for value in row.iter_mut() {
        since = if *value == 0 {
            0
        } else {
            (since + 1).min(REACH)
        };
        *value = if since == 0 { 0 } else { cost(since) };
    }
    since = REACH;
    for value in row.iter_mut().rev() {
        since = if *value == 0 {
            0
        } else {
            (since + 1).min(REACH)
        };
        *value = if since == 0 {
            0
        } else {
            cost(since).min(*value)
        };
    }
}

/// A later pass, for all rows that start `stride` apart: each takes the least of the rows beside it plus
/// what their offset costs. Whole rows at a time, so that it vectorises.
fn across_rows(field: &mut [u16], row: usize, stride: usize, former: &mut Vec<u16>) {
    former.clear();
    for line in field.chunks(stride) {
        former.extend_from_slice(&line[..row]);
    }
    let count = former.len() / row;
    for (i, line) in field.chunks_mut(stride).enumerate() {
        let line = &mut line[..row];
        for offset in 1..REACH {
            let cost = cost(offset);
            if line.iter().all(|&value| value <= cost) {
                break;
            }
            let beside = [
                i.checked_sub(offset),
                Some(i + offset).filter(|&j| j < count),
            ];
            for j in beside.into_iter().flatten() {
                for (value, other) in line.iter_mut().zip(&former[j * row..(j + 1) * row]) {
                    *value = (*value).min(other + cost);
                }
            }
        }
    }
}
