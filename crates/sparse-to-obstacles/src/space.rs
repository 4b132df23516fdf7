//! Where a motion is allowed: everywhere but in hulls (the paper), or only in proven free space.

use crate::free_space::FreeSpace;
use crate::obstacle::ObstacleSet;

/// The space that a planner may use.
///
/// Sparse points leave blank walls empty, so a path among hulls can cross a true wall.
/// [`Space::ProvenFree`] also asks that the camera has seen through the whole motion.
#[derive(Clone, Copy, Debug)]
pub enum Space<'a> {
    /// Free is what lies in no hull: the paper's view.
    Hulls(&'a ObstacleSet),
    /// Free is what lies in no hull and has been seen through: for flying.
    ProvenFree {
        /// The obstacles.
        hulls: &'a ObstacleSet,
        /// What has been seen through, the start bubble included ([`FreeSpace::add_ball`]).
        free: &'a FreeSpace,
    },
}

impl Space<'_> {
    /// Can a ball of this radius move in a straight line from `a` to `b`? Exact for the whole sweep; a
    /// coordinate that is not finite is not free.
    #[must_use]
    pub fn motion_is_free(&self, a: [f64; 3], b: [f64; 3], radius: f64) -> bool {
        match self {
            Space::Hulls(hulls) => hulls.motion_is_free(a, b, radius),
            Space::ProvenFree { hulls, free } => {
                free.motion_is_free(a, b, radius) && hulls.motion_is_free(a, b, radius)
            }
        }
    }

    /// Can a ball of this radius be at this place?
    #[must_use]
    pub fn ball_is_free(&self, centre: [f64; 3], radius: f64) -> bool {
        self.motion_is_free(centre, centre, radius)
    }
}
