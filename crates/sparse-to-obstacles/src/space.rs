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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FreeSpaceConfig, ObstacleConfig, Ray};
    use rand::SeedableRng;

    #[test]
    fn proven_free_asks_for_both() {
        let post = [[2.0, 0.0, 0.0], [2.0, 0.0, 0.5]];
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        let config = ObstacleConfig::with_clusters(1);
        let hulls = ObstacleSet::from_points(&post, &config, &mut rng).unwrap();
        let rays = (0..2).flat_map(|i| {
            (0..40).map(move |j| Ray {
                origin: [0.0, 0.05 * f64::from(i), 0.2],
                end: [4.0, 0.05 * f64::from(j) - 1.0, 0.2],
            })
        });
        let config = FreeSpaceConfig {
            clearance: 0.0,
            ..FreeSpaceConfig::default()
        };
        let none: [[f64; 3]; 0] = [];
        let free = FreeSpace::from_rays(rays, &none, &config).unwrap();
        let proven = Space::ProvenFree {
            hulls: &hulls,
            free: &free,
        };
        let paper = Space::Hulls(&hulls);
        // Seen and empty; in the post although seen through; never seen.
        for (a, b, in_paper, in_proven) in [
            ([1.0, 0.1, 0.25], [1.5, 0.1, 0.25], true, true),
            ([1.0, 0.0, 0.25], [3.0, 0.0, 0.25], false, false),
            ([1.0, 0.1, 0.25], [1.0, 0.1, 2.0], true, false),
        ] {
            assert_eq!(paper.motion_is_free(a, b, 0.01), in_paper);
            assert_eq!(proven.motion_is_free(a, b, 0.01), in_proven);
        }
        assert!(proven.ball_is_free([1.0, 0.1, 0.25], 0.01));
    }
}
