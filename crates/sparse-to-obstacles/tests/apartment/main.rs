//! The experiment behind this crate: paths among hulls cross true walls, paths in proven free space do not.

mod planner;
mod scene;

use rand::SeedableRng;
use rand_pcg::Pcg64;
use scene::{Scene, Vec3};
use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, ObstacleConfig, ObstacleSet, Space};

const RADIUS: f64 = 0.15;

#[derive(Debug, Default)]
struct Tally {
    solved: usize,
    crossing: usize,
    touching: usize,
    least_clearance: f64,
}

fn fly(scene: &Scene, is_free: impl Fn(usize, Vec3, Vec3) -> bool) -> Tally {
    let mut tally = Tally {
        least_clearance: f64::INFINITY,
        ..Tally::default()
    };
    for (number, &query) in scene.queries.iter().enumerate() {
        let mut rng = Pcg64::seed_from_u64(number as u64);
        let allowed = |a: Vec3, b: Vec3| is_free(number, a, b);
        let Some(path) = planner::plan(query, scene.bounds, allowed, &mut rng) else {
            continue;
        };
        tally.solved += 1;
        let legs = path.windows(2);
        tally.crossing += usize::from(legs.clone().any(|leg| scene.crosses(leg[0], leg[1])));
        let clearance = legs
            .map(|leg| scene.clearance(leg[0], leg[1]))
            .fold(9.0, f64::min);
        tally.touching += usize::from(clearance < RADIUS);
        tally.least_clearance = tally.least_clearance.min(clearance);
    }
    tally
}

#[test]
fn paths_in_proven_free_space_never_cross_true_geometry() {
    let Some(scene) = Scene::load() else {
        println!("skipped: the synthetic apartment is not there (set EXPLORER_DATA)");
        return;
    };
    let mut rng = Pcg64::seed_from_u64(1);
    let hulls = ObstacleSet::from_points(
        &scene.inliers,
        &ObstacleConfig::with_clusters(300),
        &mut rng,
    )
    .unwrap();
    let truth = fly(&scene, |_, a, b| scene.clearance(a, b) >= RADIUS);
    println!("true boxes   {truth:?}");
    let space = Space::Hulls(&hulls);
    let among_hulls = fly(&scene, |_, a, b| space.motion_is_free(a, b, RADIUS));
    println!("hulls        {among_hulls:?}");
    for angle in [0.0, 0.21, 0.4] {
        for observers in [10, 1000] {
            for clearance in [0.2] {
                for resolution in [0.05, 0.1] {
                    let config = FreeSpaceConfig {
                        clearance,
                        resolution,
                        max_triangle_angle: angle,
                        ..Default::default()
                    };
                    let rays = scene.rays(6.0, observers, 2);
                    let count = rays.len();
                    let free = FreeSpace::from_rays(rays, &scene.inliers, &config).unwrap();
                    let bubbles: Vec<FreeSpace> = scene
                        .queries
                        .iter()
                        .map(|&(start, _)| {
                            let mut free = free.clone();
                            free.add_ball(start, 0.2).unwrap();
                            free
                        })
                        .collect();
                    let proven = fly(&scene, |query, a, b| {
                        Space::ProvenFree {
                            hulls: &hulls,
                            free: &bubbles[query],
                        }
                        .motion_is_free(a, b, RADIUS)
                    });
                    println!(
                        "proven {angle} {observers} {clearance} {resolution} ({count} rays, {} voxels) {proven:?}",
                        free.voxel_count()
                    );
                }
            }
        }
    }
}
