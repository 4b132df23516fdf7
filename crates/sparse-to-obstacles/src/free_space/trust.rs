//! Which points are wrong by what all rays say together, so that rays to them prove nothing.
//!
//! A point is wrong when it is contradicted (many more rays crossed its voxel than ended there,
//! [`FreeSpaceConfig::contradiction_log_odds`]), or when too large a share of its own rays
//! ([`FreeSpaceConfig::max_blocked_share`]) pass through something solid: through [`SOLID`] voxels in which more rays ended than
//! passed. The keyframes cannot have seen it there.
//!
//! Of the points that are too far off to be true (as wrong matches are that open walls) two thirds of the rays pass through something
//! solid in simulated apartments, of the others one in twenty-three.

use super::config::FreeSpaceConfig;
use super::evidence::{Evidence, PointId, Sighting};
use super::grid::Grid;
use super::traverse::{carved, visit_line};
use std::ops::ControlFlow;

/// So many occupied voxels are something solid; one may be grazed.
const SOLID: usize = 2;

/// What is thought of the points of a call.
#[derive(Debug)]
pub(super) struct Trust {
    /// By the number of the point; none when all are trusted.
    views: Vec<Views>,
    max_blocked_share: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Views {
    rays: u32,
    /// Rays that pass through something solid.
    blocked: u32,
    contradicted: bool,
}

impl Trust {
    /// Judges the points of these sightings, numbered up to `points`, by all rays that have been counted.
    pub(super) fn new<'a>(
        sightings: impl Iterator<Item = &'a Sighting>,
        points: usize,
        grid: &Grid,
        evidence: &[Evidence],
        config: &FreeSpaceConfig,
    ) -> Self {
        let max_blocked_share = config.max_blocked_share;
        if max_blocked_share >= 1.0 {
            let views = Vec::new();
            return Trust {
                views,
                max_blocked_share,
            };
        }
        let mut views = vec![Views::default(); points + 1];
        for sighting in sightings {
            let own = grid.index_of(sighting.ray.end);
            let view = &mut views[sighting.point as usize];
            view.rays += 1;
            view.contradicted = own.is_some_and(|own| evidence[own].is_contradicted(config));
            let mut solid = 0;
            let mut blocked = |index: usize| {
                // Its own voxel is occupied if the point is true.
                solid += usize::from(Some(index) != own && evidence[index].is_occupied(config));
                if solid == SOLID {
                    return ControlFlow::Break(());
                }
                ControlFlow::Continue(())
            };
            if let Some(segment) = carved(&sighting.ray, config) {
                view.blocked += u32::from(visit_line(grid, segment, &mut blocked).is_break());
            }
        }
        Trust {
            views,
            max_blocked_share,
        }
    }

    pub(super) fn is_wrong(&self, point: PointId) -> bool {
        self.views.get(point as usize).is_some_and(|view| {
            view.contradicted
                || f64::from(view.blocked) > self.max_blocked_share * f64::from(view.rays)
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::vector::Vec3;
    use crate::{FreeSpace, FreeSpaceConfig, Ray, VoxelState};

    const NOTHING: [Vec3; 0] = [];

    /// What rays prove, from keyframes 0.02 m above each other and others.
    fn space_with(sightings: &[(u8, Vec3)], others: impl Iterator<Item = Ray>) -> FreeSpace {
        let config = FreeSpaceConfig {
            max_triangle_angle: 0.0,
            clearance: 0.0,
            ..FreeSpaceConfig::default()
        };
        let rays = sightings.iter().map(|&(keyframe, end)| Ray {
            origin: [0.05, 0.05, 0.02 * f64::from(keyframe)],
            end,
        });
        FreeSpace::from_rays(rays.chain(others), &NOTHING, &config).unwrap()
    }

    fn space(sightings: &[(u8, Vec3)]) -> FreeSpace {
        space_with(sightings, std::iter::empty())
    }

    /// Two points farther away than the voxels about x = 3, each seen by two keyframes.
    fn two_points() -> Vec<(u8, Vec3)> {
        let ends = [[4.05, 0.05, 0.05], [4.05, 0.06, 0.05]];
        (ends.into_iter())
            .flat_map(|end| [(0, end), (1, end)])
            .collect()
    }

    /// A wall of so many voxels, ten points in each, seen by a keyframe.
    fn wall(voxels: usize) -> Vec<(u8, Vec3)> {
        (0..10 * voxels)
            .map(|i| (2, [2.05 + 0.1 * (i % voxels) as f64, 0.05, 0.05]))
            .collect()
    }

    #[test]
    fn a_share_of_one_trusts_all_points() {
        let behind = [3.05, 0.05, 0.05];
        let sightings = [two_points(), wall(2)].concat();
        let rays = sightings.iter().map(|&(keyframe, end)| Ray {
            origin: [0.05, 0.05, 0.02 * f64::from(keyframe)],
            end,
        });
        let config = FreeSpaceConfig {
            max_triangle_angle: 0.0,
            clearance: 0.0,
            max_blocked_share: 1.0,
            ..FreeSpaceConfig::default()
        };
        let space = FreeSpace::from_rays(rays, &NOTHING, &config).unwrap();
        assert_eq!(space.state(behind), VoxelState::Free);
    }

    #[test]
    fn what_is_seen_through_something_solid_proves_nothing() {
        let behind = [3.05, 0.05, 0.05];
        assert_eq!(space(&two_points()).state(behind), VoxelState::Free);
        for (voxels, state) in [(1, VoxelState::Free), (2, VoxelState::Unknown)] {
            let space = space(&[two_points(), wall(voxels)].concat());
            assert_eq!(space.state(behind), state, "{voxels} voxels");
            assert_eq!(space.state([2.05, 0.05, 0.05]), VoxelState::Occupied);
        }
    }

    #[test]
    fn a_point_is_wrong_only_if_most_of_its_rays_are_blocked() {
        let [point, other] = [[4.05, 0.05, 0.05], [4.05, 0.06, 0.05]];
        // Keyframes high above see past the wall, and both points through the same voxels; alone the other one proves nothing.
        let above = |count: u8, end: Vec3| (0..count).map(move |i| (100 + i, end));
        for (count, state) in [(1, VoxelState::Unknown), (2, VoxelState::Free)] {
            let mut sightings = wall(2);
            sightings.extend([(0, point), (1, point)]);
            sightings.extend(above(count, point).chain(above(2, other)));
            let on_the_way = [3.05, 0.05, 0.54];
            let state_there = space(&sightings).state(on_the_way);
            assert_eq!(state_there, state, "{count} rays past the wall");
        }
    }

    #[test]
    fn a_point_that_rays_contradict_proves_nothing() {
        let behind = [3.05, 0.05, 0.05];
        // Rays through the voxel of both points, but not through the one about x = 3.
        let across = |count: usize| {
            (0..count).map(|i| Ray {
                origin: [4.05, -1.0, 0.05 + 0.01 * (i % 2) as f64],
                end: [4.05, 1.0, 0.05 + 1e-5 * i as f64],
            })
        };
        // Four ends weigh 3.4, each crossing ray 0.4 against them: 89 make -32.2.
        for (count, state) in [(88, VoxelState::Free), (89, VoxelState::Unknown)] {
            let space = space_with(&two_points(), across(count));
            assert_eq!(space.state(behind), state, "{count} rays across");
        }
    }
}
