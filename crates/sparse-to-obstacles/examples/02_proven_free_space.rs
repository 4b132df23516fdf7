//! Why points are not enough: a blank wall has none. A path among hulls crosses it, a path in proven
//! free space does not.
//!
//! Expected output: hulls say the way is free, proven free space says it is not, and the frontier shows
//! where to look next.
#![allow(clippy::print_stdout)]

use rand::SeedableRng;
use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, ObstacleConfig, ObstacleSet, Ray, Space};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A blank wall at x = 3 between two textured strips, seen by keyframes around the origin.
    let strips: Vec<[f64; 3]> = (0..600)
        .map(|i| {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            [
                3.0,
                side * (1.0 + 0.02 * f64::from(i % 50)),
                0.05 * f64::from(i / 50) - 0.3,
            ]
        })
        .collect();
    let keyframes = (0..8).map(|i| [0.1 * f64::from(i), 0.05 * f64::from(i % 3), 0.0]);
    let rays = keyframes.flat_map(|origin| strips.iter().map(move |&end| Ray { origin, end }));

    let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
    let hulls = ObstacleSet::from_points(&strips, &ObstacleConfig::with_clusters(20), &mut rng)?;
    let mut free = FreeSpace::from_rays(rays, &strips, &FreeSpaceConfig::default())?;
    free.add_ball([0.0, 0.0, 0.0], 0.4)?;

    let (a, b, radius) = ([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], 0.15);
    let space = Space::Hulls(&hulls);
    println!(
        "through the blank wall, hulls: free = {}",
        space.motion_is_free(a, b, radius)
    );
    let space = Space::ProvenFree {
        hulls: &hulls,
        free: &free,
    };
    println!(
        "through the blank wall, proven: free = {}",
        space.motion_is_free(a, b, radius)
    );
    let near = [0.2, 0.0, 0.0];
    println!(
        "within the start bubble: free = {}",
        space.motion_is_free(a, near, radius)
    );
    println!(
        "{} voxels of {} m are free, {} of them border on unknown space",
        free.voxel_count(),
        free.resolution(),
        free.frontier().len()
    );
    Ok(())
}
