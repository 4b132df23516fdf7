//! What counts as proof and what does not, at the borders of every rule.

use super::evidence::Evidence;
use super::*;
use crate::VoxelState;

const NOTHING: [Vec3; 0] = [];

fn config() -> FreeSpaceConfig {
    FreeSpaceConfig {
        max_triangle_angle: 0.0,
        clearance: 0.0,
        ..FreeSpaceConfig::default()
    }
}

fn space(rays: &[Ray], config: &FreeSpaceConfig) -> FreeSpace {
    FreeSpace::from_rays(rays.iter().copied(), &NOTHING, config).unwrap()
}

/// Rays to different ends around this one, two from each of two keyframes.
fn bundle(end: Vec3) -> Vec<Ray> {
    let ray = |i: usize| {
        let mut ray = Ray {
            origin: [0.0, 0.05, 0.05 + 0.02 * (i % 2) as f64],
            end,
        };
        ray.end[1] += 1e-3 * i as f64;
        ray
    };
    (0..4).map(ray).collect()
}

#[test]
fn a_ray_counts_once_in_a_voxel() {
    let mut voxel = Evidence::default();
    for _ in 0..3 {
        voxel.cross(7);
    }
    assert_eq!(voxel.log_odds(&config()), -0.4);
}

#[test]
fn zeros_of_either_sign_are_one_place() {
    let end = [1.0, 0.0, 0.0];
    let origins = [[0.0, 0.0, 0.0], [-0.0, 0.0, -0.0]];
    let rays = origins.map(|origin| Ray { origin, end });
    assert_eq!(space(&rays, &config()).keyframe_count(), 1);
}

#[test]
fn beyond_its_range_a_ray_proves_nothing() {
    let config = FreeSpaceConfig {
        max_range: 2.0,
        ..config()
    };
    let mut rays = bundle([5.0, 0.05, 0.05]);
    // Others, from farther on, make the grid large enough for all of the long ones.
    let side = |y: f64| Ray {
        origin: [5.5, y, 0.05],
        end: [5.5, y + 0.5, 0.05],
    };
    rays.extend([side(1.0), side(1.01)]);
    let space = space(&rays, &config);
    assert_eq!(space.state([1.75, 0.05, 0.05]), VoxelState::Free);
    for x in [2.15, 3.0, 4.95, 5.02] {
        assert_eq!(space.state([x, 0.05, 0.05]), VoxelState::Unknown, "{x}");
    }
}

#[test]
fn all_lengths_are_scaled_and_nothing_else() {
    let default = FreeSpaceConfig::default();
    let scaled = default.clone().scaled(3.0);
    let expected = FreeSpaceConfig {
        resolution: 3.0 * default.resolution,
        max_range: 3.0 * default.max_range,
        clearance: 3.0 * default.clearance,
        max_gap: 3.0 * default.max_gap,
        ..default
    };
    assert_eq!(scaled, expected);
}

#[test]
fn one_keyframe_contradicts_no_point() {
    let point = [2.0, 0.05, 0.05];
    let one: Vec<Ray> = (0..200)
        .map(|i| Ray {
            origin: [0.0, 0.05, 0.05],
            end: [4.0, 0.05 + 1e-4 * f64::from(i), 0.05],
        })
        .collect();
    assert!(!space(&one, &config()).contradicts(point));
    let mut two = one.clone();
    two[0].origin[2] = 0.051;
    assert!(space(&two, &config()).contradicts(point));
}

/// Two keyframes and a triangle of points for each, turned about the line of sight; the three corners at these angles from
/// it, radians, and depths.
fn triangles(turn: f64, corners: [(f64, f64, f64); 3]) -> Vec<Ray> {
    let keyframes = [[0.0, 0.05, 0.05], [0.0, 0.051, 0.05]];
    let rays = keyframes.iter().zip([0.0, 1e-4]).map(|(&origin, aside)| {
        corners.map(|(right, up, depth)| {
            let (sin, cos) = turn.sin_cos();
            let direction = [1.0, right * cos - up * sin + aside, right * sin + up * cos];
            let length = crate::vector::norm(direction);
            let end = [0, 1, 2].map(|i| origin[i] + depth * direction[i] / length);
            Ray { origin, end }
        })
    });
    rays.flatten().collect()
}

fn between(turn: f64, corners: [(f64, f64, f64); 3], place: Vec3) -> VoxelState {
    let config = FreeSpaceConfig {
        max_triangle_angle: 0.3,
        max_gap: 2.0,
        ..config()
    };
    space(&triangles(turn, corners), &config).state(place)
}

#[test]
fn every_edge_of_a_triangle_must_be_short_enough() {
    // No ray passes through the voxel in their middle. Flat triangles: two edges of 0.2 rad at most, and the third of 0.26 or 0.38.
    for step in 0..24 {
        let turn = f64::from(step) * std::f64::consts::TAU / 24.0;
        let flat = |half: f64| {
            let corners = [(-half, -0.02, 3.0), (half, -0.02, 3.0), (0.0, 0.04, 3.0)];
            between(turn, corners, [2.45, 0.05, 0.05])
        };
        assert_eq!(flat(0.13), VoxelState::Free, "{turn}");
        assert_eq!(flat(0.19), VoxelState::Unknown, "{turn}");
    }
}

#[test]
fn a_jump_in_depth_is_an_edge() {
    for (far, state) in [(3.7, VoxelState::Free), (3.8, VoxelState::Unknown)] {
        let corners = [(-0.1, -0.08, 3.0), (0.1, -0.08, far), (0.0, 0.1, 3.0)];
        assert_eq!(between(0.0, corners, [1.55, 0.05, 0.05]), state, "{far}");
    }
}

#[test]
fn a_triangle_is_seen_through_as_far_as_its_rays_are_carved() {
    let depth = 4.0 * (1.0_f64 + 0.02).sqrt();
    let corners = [(-0.1, -0.1, depth), (0.1, -0.1, depth), (0.0, 0.1, depth)];
    // Carved to nine tenths: 3.6 m and a little more, since the corner above is nearer to the line of sight.
    for (x, state) in [(3.55, VoxelState::Free), (3.75, VoxelState::Unknown)] {
        assert_eq!(between(0.0, corners, [x, 0.05, 0.05]), state, "{x}");
    }
    // One that leans: near its nearest corner its plane is crossed at 3.04 m, well within the box around it.
    let corners = [(-0.1, -0.1, 4.0), (0.1, -0.1, 4.0), (0.0, 0.1, 3.3)];
    for (x, state) in [(2.95, VoxelState::Free), (3.15, VoxelState::Unknown)] {
        assert_eq!(between(0.0, corners, [x, 0.05, 0.25]), state, "{x}");
    }
}

#[test]
fn the_frontier_borders_on_unknown_space_on_any_side() {
    let fan = (0..600).map(|i| {
        let (turn, rise) = (0.01 * f64::from(i % 60), 0.03 * f64::from(i / 60));
        Ray {
            origin: [0.0, 0.02 * f64::from(i % 3), 0.05],
            end: [3.0 * turn.cos(), 3.0 * turn.sin(), rise],
        }
    });
    let space = space(&fan.collect::<Vec<_>>(), &config());
    let edge = space.resolution();
    let borders = |center: &Vec3| {
        (0..6).any(|side| {
            let mut beside = *center;
            beside[side / 2] += if side % 2 == 0 { edge } else { -edge };
            space.state(beside) == VoxelState::Unknown
        })
    };
    let expected: Vec<Vec3> = space.voxel_centers().into_iter().filter(borders).collect();
    assert_eq!(space.frontier(), expected);
    // Some of them only above or below.
    let level = |center: &&Vec3| {
        (0..4).all(|side| {
            let mut beside = **center;
            beside[side / 2] += if side % 2 == 0 { edge } else { -edge };
            space.state(beside) != VoxelState::Unknown
        })
    };
    assert!(expected.iter().filter(level).count() > 0);
}
