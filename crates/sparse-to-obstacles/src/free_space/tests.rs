//! Tests of proven free space: carving, evidence, exact motions against their definition, wrong input.

use super::*;
use crate::vector::{add, distance, lerp};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const NOTHING: [Vec3; 0] = [];

fn config() -> FreeSpaceConfig {
    FreeSpaceConfig {
        resolution: 0.1,
        min_keyframes: 1,
        clearance: 0.0,
        ..FreeSpaceConfig::default()
    }
}

/// Rays from a few keyframes to random points of a room.
fn scan(seed: u64, rays: usize) -> (Vec<Ray>, Vec<Vec3>) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let points: Vec<Vec3> = (0..rays)
        .map(|i| {
            let mut point = [4.0, 3.0, 2.5].map(|size| size * rng.random::<f64>());
            point[i % 2] = if i % 4 < 2 { 0.0 } else { 4.0 - (i % 2) as f64 };
            point
        })
        .collect();
    let keyframes = [
        [1.0, 1.0, 1.2],
        [1.6, 1.4, 1.2],
        [2.5, 1.7, 1.4],
        [3.0, 2.0, 1.1],
    ];
    let rays = points
        .iter()
        .flat_map(|&end| keyframes.map(|origin| Ray { origin, end }))
        .collect();
    (rays, points)
}

/// The definition, cell by cell, with sampled places of the ball.
fn sampled_free(space: &FreeSpace, surface: &[Vec3], a: Vec3, b: Vec3, radius: f64) -> bool {
    (0..=300).all(|i| {
        let centre = lerp(a, b, f64::from(i) / 300.0);
        let mut all = true;
        let mut touched = 0;
        space.grid.for_each_touched(centre, radius, |index| {
            touched += 1;
            all &= space.free[index];
        });
        let keep = space.config.clearance.max(radius);
        all && touched > 0 && surface.iter().all(|&point| distance(point, centre) >= keep)
    })
}

#[test]
fn motions_agree_with_the_definition() {
    let (rays, points) = scan(1, 900);
    let config = FreeSpaceConfig {
        min_keyframes: 2,
        ..FreeSpaceConfig::default()
    };
    let space = FreeSpace::from_rays(rays, &points, &config).unwrap();
    let mut rng = Pcg64::seed_from_u64(2);
    let (mut free, mut blocked) = (0, 0);
    for _ in 0..1500 {
        let a = [4.0, 3.0, 2.5].map(|size| size * rng.random::<f64>());
        let b = add(a, [0, 1, 2].map(|_| 1.2 * rng.random::<f64>() - 0.6));
        for radius in [0.0, 0.07, 0.15] {
            let exact = space.motion_is_free(a, b, radius);
            // The sweep may clip what the samples miss, never the other way round.
            let sampled = sampled_free(&space, &points, a, b, radius);
            assert!(!exact || sampled, "{a:?} {b:?} {radius}");
            if sampled && !exact {
                assert!(!sampled_free(&space, &points, a, b, radius + 2e-3));
            }
            if exact { free += 1 } else { blocked += 1 }
        }
    }
    assert!(free > 200 && blocked > 200, "{free} {blocked}");
}

#[test]
fn a_ray_carves_what_it_crosses_up_to_its_margin() {
    let ray = Ray {
        origin: [0.05, 0.05, 0.05],
        end: [2.05, 0.05, 0.05],
    };
    let space = FreeSpace::from_rays([ray], &NOTHING, &config()).unwrap();
    assert_eq!(space.state([0.05, 0.05, 0.05]), VoxelState::Free);
    assert_eq!(space.state([1.84, 0.05, 0.05]), VoxelState::Free);
    assert_eq!(space.state([1.95, 0.05, 0.05]), VoxelState::Unknown);
    assert_eq!(space.state([2.05, 0.05, 0.05]), VoxelState::Occupied);
    assert_eq!(space.state([1.0, 0.15, 0.05]), VoxelState::Unknown);
    assert_eq!(space.state([f64::NAN; 3]), VoxelState::Unknown);
    assert_eq!(space.state([1e300; 3]), VoxelState::Unknown);
    assert_eq!(space.voxel_count(), 19);
    assert_eq!(space.voxel_centers().len(), 19);
    assert_eq!(space.frontier().len(), 19);
}

#[test]
fn every_voxel_on_a_ray_is_carved() {
    let mut rng = Pcg64::seed_from_u64(7);
    for _ in 0..200 {
        let mut end = || [0, 1, 2].map(|_| 4.0 * rng.random::<f64>() - 2.0);
        let ray = Ray {
            origin: end(),
            end: end(),
        };
        let config = FreeSpaceConfig {
            patch_half_angle: 0.0,
            hit_log_odds: 0.0,
            ..config()
        };
        let space = FreeSpace::from_rays([ray], &NOTHING, &config).unwrap();
        for i in 0..=500 {
            let place = lerp(ray.origin, ray.end, 0.9 * f64::from(i) / 500.0);
            assert_eq!(space.state(place), VoxelState::Free);
        }
    }
}

#[test]
fn a_cone_carves_its_width() {
    let ray = Ray {
        origin: [0.0, 0.05, 0.05],
        end: [4.0, 0.05, 0.05],
    };
    let wide = FreeSpaceConfig {
        patch_half_angle: 0.1,
        ..config()
    };
    let space = FreeSpace::from_rays([ray], &NOTHING, &wide).unwrap();
    for (place, state) in [
        ([3.5, 0.35, 0.05], VoxelState::Free),
        ([3.5, 0.05, -0.25], VoxelState::Free),
        ([3.5, 0.55, 0.05], VoxelState::Unknown),
        ([0.5, 0.15, 0.05], VoxelState::Unknown),
    ] {
        assert_eq!(space.state(place), state, "{place:?}");
    }
}

#[test]
fn two_different_keyframes_and_points_are_needed() {
    let [origin, other_origin] = [[0.0, 0.05, 0.05], [-0.3, 0.05, 0.05]];
    let [end, other_end] = [[2.0, 0.05, 0.05], [2.0, 0.05, 0.06]];
    let ray = |origin, end| Ray { origin, end };
    let a = ray(origin, end);
    let b = ray(other_origin, other_end);
    let config = FreeSpaceConfig {
        min_keyframes: 2,
        ..config()
    };
    let state = |rays: &[Ray]| {
        let space = FreeSpace::from_rays(rays.iter().copied(), &NOTHING, &config).unwrap();
        space.state([1.0, 0.05, 0.05])
    };
    assert_eq!(state(&[a, a, a]), VoxelState::Unknown);
    let one_keyframe = [a, ray(origin, other_end)];
    assert_eq!(state(&one_keyframe), VoxelState::Unknown);
    // They may agree on a wrong point.
    let one_point = [a, ray(other_origin, end)];
    assert_eq!(state(&one_point), VoxelState::Unknown);
    assert_eq!(state(&[a, b]), VoxelState::Free);
    let mut grown = FreeSpace::from_rays([a], &NOTHING, &config).unwrap();
    grown.insert([a], &NOTHING).unwrap();
    assert_eq!(grown.state([1.0, 0.05, 0.05]), VoxelState::Unknown);
    grown.insert([b], &NOTHING).unwrap();
    assert_eq!(grown.state([1.0, 0.05, 0.05]), VoxelState::Free);
    assert_eq!(grown.keyframe_count(), 2);
}

#[test]
fn few_wrong_rays_do_not_open_a_seen_surface() {
    // Ten rays end in a voxel of the wall, three wrong ones go through it.
    let wall = [2.05, 0.05, 0.05];
    let right = (0..10).map(|i| Ray {
        origin: [0.0, 0.01 * f64::from(i), 0.05],
        end: wall,
    });
    let wrong = (0..3).map(|i| Ray {
        origin: [0.0, 0.01 * f64::from(i), 0.05],
        end: [5.0, 0.05, 0.05],
    });
    let space = FreeSpace::from_rays(right.chain(wrong), &NOTHING, &config()).unwrap();
    assert_eq!(space.state(wall), VoxelState::Occupied);
    assert!(!space.motion_is_free([1.0, 0.05, 0.05], [3.0, 0.05, 0.05], 0.01));
}

#[test]
fn growing_in_steps_equals_building_at_once() {
    let (rays, points) = scan(3, 300);
    let config = FreeSpaceConfig {
        max_triangle_angle: 0.0,
        ..FreeSpaceConfig::default()
    };
    let whole = FreeSpace::from_rays(rays.clone(), &points, &config).unwrap();
    let mut grown = FreeSpace::from_rays(rays[..400].to_vec(), &points[..100], &config).unwrap();
    grown.insert(rays[400..].to_vec(), &points[100..]).unwrap();
    assert!(whole.voxel_centers() == grown.voxel_centers());
    assert!(whole.frontier() == grown.frontier());
    let (a, b) = ([1.0, 1.0, 1.2], [2.5, 1.7, 1.3]);
    for radius in [0.0, 0.1, 0.15, 0.2] {
        assert_eq!(
            whole.motion_is_free(a, b, radius),
            grown.motion_is_free(a, b, radius)
        );
    }
}

#[test]
fn the_space_between_near_rays_of_a_keyframe_is_carved() {
    let sides = [[2.0, 0.05, 0.05], [2.0, 0.35, 0.05], [2.0, 0.05, 0.35]];
    let rays = sides.map(|end| Ray {
        origin: [0.0, 0.15, 0.15],
        end,
    });
    let between = [1.7, 0.15, 0.15];
    let state = |rays: &[Ray], max_triangle_angle: f64| {
        let config = FreeSpaceConfig {
            max_triangle_angle,
            ..config()
        };
        FreeSpace::from_rays(rays.iter().copied(), &NOTHING, &config)
            .unwrap()
            .state(between)
    };
    assert_eq!(state(&rays, 0.3), VoxelState::Free);
    assert_eq!(state(&rays, 0.05), VoxelState::Unknown);
    let mut jump = rays;
    jump[0].end = [6.0, -0.15, -0.15];
    assert_eq!(state(&jump, 0.3), VoxelState::Unknown);
    assert_eq!(state(&rays[..2], 0.3), VoxelState::Unknown);
}

#[test]
fn presence_is_proof() {
    let mut space =
        FreeSpace::from_rays([], &[[0.1, 0.0, 0.0]], &FreeSpaceConfig::default()).unwrap();
    assert!(!space.ball_is_free([0.0; 3], 0.15));
    assert_eq!(space.voxel_count(), 0);
    space.add_ball([0.0; 3], 0.25).unwrap();
    assert!(space.ball_is_free([0.0; 3], 0.25));
    assert!(space.motion_is_free([0.0; 3], [0.05, 0.0, 0.0], 0.15));
    assert!(!space.ball_is_free([0.3, 0.0, 0.0], 0.25));
    space.insert([], &[[0.2, 0.0, 0.0]]).unwrap();
    assert!(space.ball_is_free([0.0; 3], 0.25));
    space.insert([], &[[0.26, 0.0, 0.0]]).unwrap();
    assert!(!space.ball_is_free([0.1, 0.0, 0.0], 0.15));
    space
        .add_balls(&[[0.3, 0.0, 0.0], [0.6, 0.0, 0.0]], 0.25)
        .unwrap();
    assert!(space.motion_is_free([0.0; 3], [0.6, 0.0, 0.0], 0.05));
}

#[test]
fn without_observations_rays_start_at_the_agent() {
    let points: Vec<Vec3> = (0..100)
        .map(|i| [2.0, 0.05 * f64::from(i) - 2.5, 0.0])
        .collect();
    let rays = Ray::from_position([0.0; 3], &points);
    let space = FreeSpace::from_rays(rays, &points, &config()).unwrap();
    assert!(space.motion_is_free([0.0; 3], [1.5, 0.0, 0.0], 0.0));
    assert!(!space.motion_is_free([0.0; 3], [2.5, 0.0, 0.0], 0.0));
}

#[test]
fn wrong_input_is_refused_with_numbers() {
    let build = |rays: &[Ray], points: &[Vec3], config: FreeSpaceConfig| {
        FreeSpace::from_rays(rays.iter().copied(), points, &config).err()
    };
    let good = Ray {
        origin: [0.0; 3],
        end: [1.0; 3],
    };
    let nan = Ray {
        origin: [0.0; 3],
        end: [f64::NAN; 3],
    };
    let refused = build(&[good, nan], &NOTHING, config());
    assert_eq!(refused, Some(FreeSpaceError::RayNotFinite { index: 1 }));
    let refused = build(&[], &[[f64::INFINITY; 3]], config());
    assert_eq!(refused, Some(FreeSpaceError::PointNotFinite { index: 0 }));
    let far = Ray {
        origin: [1e9; 3],
        end: [0.0; 3],
    };
    let refused = build(&[good, far], &NOTHING, config());
    assert!(matches!(
        refused,
        Some(FreeSpaceError::TooManyVoxels { .. })
    ));
}

#[test]
fn settings_out_of_range_are_refused() {
    let good = Ray {
        origin: [0.0; 3],
        end: [1.0; 3],
    };
    for wrong in [
        FreeSpaceConfig {
            resolution: 0.0,
            ..config()
        },
        FreeSpaceConfig {
            range_margin: 1.0,
            ..config()
        },
        FreeSpaceConfig {
            max_range: f64::NAN,
            ..config()
        },
        FreeSpaceConfig {
            min_keyframes: 0,
            ..config()
        },
        FreeSpaceConfig {
            min_keyframes: 5,
            ..config()
        },
        FreeSpaceConfig {
            clearance: -1.0,
            ..config()
        },
        FreeSpaceConfig {
            patch_half_angle: 0.5,
            ..config()
        },
        FreeSpaceConfig {
            miss_log_odds: 0.0,
            ..config()
        },
        FreeSpaceConfig {
            max_blocked_share: f64::NAN,
            ..config()
        },
        FreeSpaceConfig {
            max_blocked_share: 1.5,
            ..config()
        },
    ] {
        let refused = FreeSpace::from_rays([good], &NOTHING, &wrong).err();
        assert!(matches!(refused, Some(FreeSpaceError::OutOfRange { .. })));
    }
}

#[test]
fn a_refused_extension_changes_nothing() {
    let good = Ray {
        origin: [0.0; 3],
        end: [1.0; 3],
    };
    let far = Ray {
        origin: [1e9; 3],
        end: [0.0; 3],
    };
    let unusable = Ray {
        origin: [1e300; 3],
        end: [-1e300; 3],
    };
    let refused = FreeSpace::from_rays([unusable], &NOTHING, &config()).err();
    assert!(matches!(
        refused,
        Some(FreeSpaceError::TooManyVoxels { .. })
    ));
    let mut space = FreeSpace::from_rays([good], &NOTHING, &config()).unwrap();
    let before = space.voxel_centers();
    assert!(space.insert([far], &NOTHING).is_err());
    assert!(space.add_ball([f64::NAN; 3], 0.1).is_err());
    assert!(space.add_ball([0.0; 3], -0.1).is_err());
    assert_eq!(space.voxel_centers(), before);
    assert!(!space.motion_is_free([f64::NAN; 3], [0.0; 3], 0.1));
    assert!(!space.motion_is_free([0.0; 3], [0.0; 3], -0.1));
}

#[test]
fn no_rays_prove_nothing() {
    let space = FreeSpace::from_rays([], &NOTHING, &FreeSpaceConfig::default()).unwrap();
    assert_eq!(space.voxel_count(), 0);
    assert!(!space.ball_is_free([0.0; 3], 0.0));
    assert!(space.frontier().is_empty());
    let point = Ray {
        origin: [1.0; 3],
        end: [1.0; 3],
    };
    let space = FreeSpace::from_rays([point], &NOTHING, &config()).unwrap();
    assert_eq!(space.voxel_count(), 0);
}

#[test]
fn enormous_balls_are_refused_at_once() {
    let (rays, points) = scan(4, 200);
    let space = FreeSpace::from_rays(rays, &points, &FreeSpaceConfig::default()).unwrap();
    for radius in [3.0, 1e9, 1e300] {
        assert!(!space.motion_is_free([1.0, 1.0, 1.2], [1.6, 1.4, 1.2], radius));
    }
}

#[test]
fn a_way_too_long_to_measure_is_refused_at_once() {
    // One voxel holds coordinates whose squares overflow.
    let config = FreeSpaceConfig {
        resolution: 1e200,
        ..config()
    };
    let mut space = FreeSpace::from_rays([], &NOTHING, &config).unwrap();
    space.add_ball([1e180, 1.0, 1.0], 0.0).unwrap();
    assert!(space.motion_is_free([1e180, 1.0, 1.0], [1e180, 1.0, 1.0], 0.0));
    assert!(!space.motion_is_free([1e180, 1.0, 1.0], [1.0, 1.0, 1.0], 0.0));
}

#[test]
fn balls_beyond_the_reach_of_the_distance_field_are_exact() {
    // A block of free space 2 m wide at a fine resolution: 50 voxels.
    let mut space = FreeSpace::from_rays(
        [],
        &NOTHING,
        &FreeSpaceConfig {
            resolution: 0.04,
            ..config()
        },
    )
    .unwrap();
    let line: Vec<Vec3> = (0..=20).map(|i| [0.1 * f64::from(i), 0.02, 0.02]).collect();
    space.add_balls(&line, 1.0).unwrap();
    assert!(space.motion_is_free([0.0, 0.02, 0.02], [2.0, 0.02, 0.02], 0.9));
    assert!(!space.motion_is_free([0.0, 0.02, 0.02], [2.0, 0.02, 0.02], 1.1));
    assert!(!space.motion_is_free([0.0, 0.02, 0.02], [2.3, 0.02, 0.02], 0.9));
}

#[test]
fn a_point_that_many_rays_pass_is_contradicted() {
    let lone = [1.05, 0.05, 0.05];
    let rays = |count: u32| {
        (0..count).map(|i| Ray {
            origin: [0.0, 0.05, 0.01 + 0.0005 * f64::from(i)],
            end: [3.0, 0.05, 0.05],
        })
    };
    let hit = Ray {
        origin: [0.0, 0.0, 0.0],
        end: lone,
    };
    for (through, contradicted) in [(70, false), (100, true)] {
        let rays = rays(through).chain([hit]);
        let space = FreeSpace::from_rays(rays, &NOTHING, &config()).unwrap();
        assert_eq!(space.contradicts(lone), contradicted, "{through} rays");
        assert!(
            !space.contradicts([1.05, 0.55, 0.05]),
            "nobody looked there"
        );
        assert!(!space.contradicts([f64::NAN; 3]) && !space.contradicts([1e300; 3]));
    }
}

#[test]
fn places_keep_their_distance() {
    let (rays, points) = scan(5, 900);
    let space = FreeSpace::from_rays(rays, &points, &FreeSpaceConfig::default()).unwrap();
    let places = space.places(0.15);
    assert!(!places.is_empty() && places.len() < space.voxel_count());
    for place in &places {
        assert!(points.iter().all(|&point| distance(point, *place) >= 0.2));
        for step in [-0.1, 0.1] {
            for axis in 0..3 {
                let mut beside = *place;
                beside[axis] += step;
                assert_ne!(space.state(beside), VoxelState::Unknown);
            }
        }
    }
    // What the ball sweeps exactly is asked for more voxels.
    let fits = |place: &Vec3| space.ball_is_free(*place, 0.15);
    assert!(
        space
            .voxel_centers()
            .iter()
            .filter(|p| fits(p))
            .all(|p| places.contains(p))
    );
    for radius in [1e9, f64::INFINITY, f64::NAN, -1.0] {
        assert!(space.places(radius).is_empty());
    }
}
