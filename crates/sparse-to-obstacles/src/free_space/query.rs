//! Exact queries on the voxels: the state of a place, and a ball that moves along a segment.
//!
//! A motion is followed by sphere tracing: the distance fields bound how far the nearest blocked voxel
//! and the nearest surface point can be, and so how far the ball may jump. Where the bounds do not
//! decide, a piece of a few voxels' length is tested exactly against every voxel and point around it.

use super::FreeSpace;
use super::grid::Cell;
use crate::hull::separation;
use crate::point::is_finite;
use crate::vector::{Vec3, distance, lerp};

/// What is known about a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VoxelState {
    /// Seen through by enough keyframes.
    Free,
    /// Holds a surface point, or more rays end there than go through.
    Occupied,
    /// Nothing is proven.
    Unknown,
}

/// Length of a piece that is tested exactly, in voxels.
const PIECE: f64 = 3.0;
/// The shortest jump, in voxels, that is worth another look at the fields.
const WORTHWHILE: f64 = 0.1;

/// How far a ball can certainly move without touching anything, negative where that is open.
struct Jump {
    past_voxels: f64,
    past_points: f64,
}

impl FreeSpace {
    /// The state of the voxel that holds this point. Unknown outside the grid and where a coordinate is
    /// not finite.
    #[must_use]
    pub fn state(&self, point: [f64; 3]) -> VoxelState {
        if !is_finite(point) {
            return VoxelState::Unknown;
        }
        self.grid
            .index_of(point)
            .map_or(VoxelState::Unknown, |index| self.state_at(index))
    }

    pub(super) fn state_at(&self, index: usize) -> VoxelState {
        if self.surface.occupies(index) {
            VoxelState::Occupied
        } else if self.free[index] {
            VoxelState::Free
        } else if self.evidence[index].is_occupied(&self.config) {
            VoxelState::Occupied
        } else {
            VoxelState::Unknown
        }
    }

    /// Have many more rays gone through the place of a point than ended there? Then the point is wrong, or
    /// far off, and no obstacle: pass only points that are not contradicted as surface and to
    /// [`ObstacleSet`](crate::ObstacleSet). See [`FreeSpaceConfig::contradiction_log_odds`](crate::FreeSpaceConfig::contradiction_log_odds).
    #[must_use]
    pub fn contradicts(&self, point: [f64; 3]) -> bool {
        let index = is_finite(point)
            .then(|| self.grid.index_of(point))
            .flatten();
        index.is_some_and(|index| {
            self.free[index] && self.evidence[index].is_contradicted(&self.config)
        })
    }

    /// The centres of the voxels in which a ball of this radius can be, in the order of their coordinates:
    /// every voxel whose centre lies within the radius is proven free, and no surface point is nearer than
    /// the larger of the radius and [`clearance`](crate::FreeSpaceConfig::clearance).
    ///
    /// This is the rule by which proven free space is measured and drawn. It asks for the centres of voxels;
    /// [`motion_is_free`](Self::motion_is_free) asks for every voxel that the ball touches, and so for
    /// up to a voxel more. A radius that is not finite or negative fits nowhere.
    #[must_use]
    pub fn places(&self, radius: f64) -> Vec<[f64; 3]> {
        if !(radius >= 0.0 && radius.is_finite()) {
            return Vec::new();
        }
        let clearance = self.config.clearance.max(radius);
        let fits = |centre: &Vec3| {
            self.centres_are_free(*centre, radius)
                && self.points_are_away(*centre, *centre, clearance)
        };
        self.voxel_centers().into_iter().filter(fits).collect()
    }

    /// Is every voxel free whose centre lies within the radius?
    fn centres_are_free(&self, place: Vec3, radius: f64) -> bool {
        let around = self.grid.around(place, place, radius);
        let free = |cell: Cell, index: usize| {
            self.free[index] || distance(self.grid.centre(cell), place) > radius
        };
        // Nothing beyond the grid is free.
        !around.is_clipped
            && around.rows(&self.grid).all(|([x, y, z], indices)| {
                (z..).zip(indices).all(|(z, index)| free([x, y, z], index))
            })
    }

    /// Can a ball be here? As [`motion_is_free`](Self::motion_is_free) without a motion.
    #[must_use]
    pub fn ball_is_free(&self, centre: [f64; 3], radius: f64) -> bool {
        self.motion_is_free(centre, centre, radius)
    }

    /// Is all the space that a ball sweeps on a straight line from `a` to `b` proven free?
    ///
    /// True where every voxel that the ball touches is proven free, and the centre keeps the larger of
    /// the radius and [`clearance`](crate::FreeSpaceConfig::clearance) from every surface point. Exact on
    /// the voxels for the whole sweep. A coordinate, a radius or a length of the way that is not finite, or
    /// a negative radius, is not free.
    #[must_use]
    pub fn motion_is_free(&self, a: [f64; 3], b: [f64; 3], radius: f64) -> bool {
        if !(is_finite(a) && is_finite(b) && radius >= 0.0 && radius.is_finite()) {
            return false;
        }
        // The grid is convex, and nothing beyond it is free.
        if self.grid.index_of(a).is_none() || self.grid.index_of(b).is_none() {
            return false;
        }
        let length = distance(a, b);
        // Coordinates beyond 1e150: what cannot be measured is not proven.
        if !length.is_finite() {
            return false;
        }
        let at = |done: f64| {
            if done > 0.0 {
                lerp(a, b, (done / length).min(1.0))
            } else {
                a
            }
        };
        let piece = PIECE * self.config.resolution;
        let clearance = self.config.clearance.max(radius);
        let mut done = 0.0;
        while done <= length {
            let centre = at(done);
            let Some(jump) = self.jump(centre, radius, clearance) else {
                return false;
            };
            let step = jump.past_voxels.min(jump.past_points);
            if step >= WORTHWHILE * self.config.resolution {
                done += step;
                continue;
            }
            let end = at(done + piece);
            let voxels = jump.past_voxels >= piece || self.voxels_are_free(centre, end, radius);
            if !voxels
                || (jump.past_points < piece && !self.points_are_away(centre, end, clearance))
            {
                return false;
            }
            done += piece;
        }
        true
    }

    /// How far a ball here can certainly move. `None` where it touches a blocked voxel.
    fn jump(&self, centre: Vec3, radius: f64, clearance: f64) -> Option<Jump> {
        let cell = self.grid.cell_of(centre);
        let index = self.grid.index(cell)?;
        let aside = distance(centre, self.grid.centre(cell));
        let to_blocked = self.to_blocked.voxels(index) * self.config.resolution;
        if self.to_blocked.is_exact(index) && to_blocked + aside < radius {
            return None;
        }
        let to_surface = self.to_surface.voxels(index) * self.config.resolution;
        Some(Jump {
            past_voxels: to_blocked - aside - radius,
            past_points: to_surface - aside - clearance,
        })
    }

    /// Exact: is every voxel that the ball touches on this piece free?
    fn voxels_are_free(&self, a: Vec3, b: Vec3, radius: f64) -> bool {
        let around = self.grid.around(a, b, radius);
        // Nothing beyond the grid is free.
        !around.is_clipped
            && around.rows(&self.grid).all(|(cell, indices)| {
                let row = &self.free[indices];
                row.iter().all(|&free| free)
                    || row.iter().zip(cell[2]..).all(|(&free, z)| {
                        free || !self.touches_cube([cell[0], cell[1], z], a, b, radius)
                    })
            })
    }

    fn touches_cube(&self, cell: [i64; 3], a: Vec3, b: Vec3, radius: f64) -> bool {
        if a == b {
            return self.grid.squared_to_cube(cell, a) <= radius * radius;
        }
        let low = self.grid.corner(cell);
        let high = self.grid.corner(cell.map(|c| c + 1));
        let corners: [Vec3; 8] = std::array::from_fn(|i| {
            let pick = |axis: usize| {
                if i >> axis & 1 == 1 {
                    high[axis]
                } else {
                    low[axis]
                }
            };
            [pick(0), pick(1), pick(2)]
        });
        separation(&corners, a, b, radius).lower <= radius
    }

    /// Exact: does the piece keep its distance from all surface points?
    fn points_are_away(&self, a: Vec3, b: Vec3, clearance: f64) -> bool {
        let around = self.grid.around(a, b, clearance);
        around.rows(&self.grid).all(|(_, indices)| {
            let points = self.surface.in_voxels(indices);
            points
                .iter()
                .all(|&(_, point)| distance_to_segment(point, a, b) >= clearance)
        })
    }
}

fn distance_to_segment(point: Vec3, a: Vec3, b: Vec3) -> f64 {
    let along = crate::vector::sub(b, a);
    let length_squared = crate::vector::norm_squared(along);
    if length_squared == 0.0 {
        return distance(point, a);
    }
    let t = crate::vector::dot(crate::vector::sub(point, a), along) / length_squared;
    distance(point, lerp(a, b, t.clamp(0.0, 1.0)))
}
