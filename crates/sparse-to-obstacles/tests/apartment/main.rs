//! The experiment behind this crate: paths among hulls cross true walls, paths in proven free space do not.

mod planner;
mod scene;

use rand::SeedableRng;
use rand_pcg::Pcg64;
use scene::{Scene, Vec3};
use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, ObstacleConfig, ObstacleSet, Space};

const RADIUS: f64 = 0.15;

#[derive(Default)]
struct Tally {
    possible: usize,
    solved: usize,
    crossing: usize,
    touching: usize,
}

impl Tally {
    fn row(&self, name: &str) -> String {
        let Tally {
            possible,
            solved,
            crossing,
            touching,
        } = self;
        format!("| {name} | {possible} | {solved} | {crossing} | {touching} |")
    }
}

/// Plans every query. `space` makes the motion check of a query, or `None` where an end is not free.
fn fly<'a, F: Fn(Vec3, Vec3) -> bool + 'a>(
    scene: &'a Scene,
    space: impl Fn((Vec3, Vec3)) -> Option<F>,
) -> Tally {
    let mut tally = Tally::default();
    for (number, &query) in scene.queries.iter().enumerate() {
        let mut rng = Pcg64::seed_from_u64(number as u64);
        let Some(is_free) = space(query) else {
            continue;
        };
        tally.possible += 1;
        let Some(path) = planner::plan(query, scene.bounds, is_free, &mut rng) else {
            continue;
        };
        tally.solved += 1;
        let mut legs = path.windows(2);
        let clearance = legs
            .clone()
            .map(|leg| scene.clearance(leg[0], leg[1]))
            .fold(9.0, f64::min);
        tally.crossing += usize::from(legs.any(|leg| scene.crosses(leg[0], leg[1])));
        tally.touching += usize::from(clearance < RADIUS);
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
    let config = ObstacleConfig::with_clusters(300);
    let hulls = ObstacleSet::from_points(&scene.inliers, &config, &mut rng).unwrap();
    let config = FreeSpaceConfig::default();
    let free = FreeSpace::from_rays(scene.rays(6.0, 10, 2), &scene.inliers, &config).unwrap();

    println!("| space | queries with free ends | solved | cross true geometry | ball touches it |");
    println!("| --- | --- | --- | --- | --- |");
    let truth = fly(&scene, |_| Some(|a, b| scene.clearance(a, b) >= RADIUS));
    println!("{}", truth.row("true boxes"));
    let among_hulls = fly(&scene, |_| {
        Some(|a, b| Space::Hulls(&hulls).motion_is_free(a, b, RADIUS))
    });
    println!("{}", among_hulls.row("hulls"));
    let proven = fly(&scene, |(start, goal)| {
        let mut free = free.clone();
        free.add_ball(start, RADIUS).ok()?;
        let (hulls, radius) = (&hulls, RADIUS);
        let is_free =
            move |a, b| Space::ProvenFree { hulls, free: &free }.motion_is_free(a, b, radius);
        (is_free(start, start) && is_free(goal, goal)).then_some(is_free)
    });
    println!("{}", proven.row("proven free"));

    assert_eq!(truth.crossing, 0);
    assert!(
        among_hulls.crossing >= 25,
        "the hulls of sparse points leak"
    );
    assert_eq!(proven.crossing, 0);
    assert!(proven.possible >= 20 && 10 * proven.solved >= 9 * proven.possible);
}
