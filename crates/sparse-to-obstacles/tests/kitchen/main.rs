//! Proven free space of a real monocular map against the surfaces that a depth camera measured.

mod depth;
mod map;

use map::{Map, Vec3};
use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, FreeSpaceError, VoxelState};
use std::path::PathBuf;

const RADIUS: f64 = 0.15;
const RESOLUTION: f64 = 0.08;

fn load() -> Option<(Map, Vec<Vec3>)> {
    let folder = std::env::var("EXPLORER_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared").to_owned());
    let folder = PathBuf::from(folder).join("data");
    let poses = depth::poses(&folder)?;
    let map = map::load(&folder, &poses)?;
    let surface = depth::surface(&folder, &poses, RESOLUTION)?;
    Some((map, surface))
}

/// How many surface voxels the ball's centre may enter, and how many voxels it may be in at all.
fn open(surface: &[Vec3], voxels: &[Vec3], free: impl Fn(Vec3) -> bool) -> (usize, usize) {
    let count = |places: &[Vec3]| places.iter().filter(|&&place| free(place)).count();
    (count(surface), count(voxels))
}

/// The prototype's looser rule: of the voxels, only the centres must lie in the ball to be asked for.
fn centres_are_free(space: &FreeSpace, place: Vec3) -> bool {
    let reach = (RADIUS / RESOLUTION).ceil() as i64 + 1;
    let middle = place.map(|c| ((c / RESOLUTION).floor() + 0.5) * RESOLUTION);
    let offsets = (-reach..=reach)
        .flat_map(|x| (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |z| [x, y, z])));
    let inside = |offset: &[i64; 3]| {
        let offset = offset.map(|c| c as f64 * RESOLUTION);
        let to = [0, 1, 2].map(|i| middle[i] + offset[i] - place[i]);
        to.iter().map(|c| c * c).sum::<f64>() <= RADIUS * RADIUS
    };
    space.ball_is_free(place, 0.0)
        && offsets.filter(inside).all(|offset| {
            let voxel = [0, 1, 2].map(|i| middle[i] + offset[i] as f64 * RESOLUTION);
            space.state(voxel) == VoxelState::Free
        })
}

#[test]
fn true_surfaces_stay_closed() {
    let Some((map, surface)) = load() else {
        println!("skipped: the kitchen map or its depth images are not there (set EXPLORER_DATA)");
        return;
    };
    let away = |place: &&Vec3| {
        let squared = |point: &Vec3| (0..3).map(|i| (point[i] - place[i]).powi(2)).sum::<f64>();
        map.points.iter().all(|point| squared(point) >= 0.2 * 0.2)
    };
    let leaking = surface.iter().filter(away).count();
    println!(
        "surface voxels {}, farther than 0.2 m from every point {leaking}",
        surface.len()
    );
    println!(
        "| carved between, rad | voxels touched: open | flyable | voxel centres: open | flyable |"
    );
    println!("| --- | --- | --- | --- | --- |");
    for (max_triangle_angle, most_open) in [(0.0, 0), (0.1, 2), (0.21, 2)] {
        let base = FreeSpaceConfig {
            resolution: RESOLUTION,
            ..FreeSpaceConfig::default()
        };
        let config = FreeSpaceConfig {
            max_triangle_angle,
            ..base
        };
        let space = FreeSpace::from_rays(map.rays.iter().copied(), &map.points, &config).unwrap();
        let voxels = space.voxel_centers();
        let (wrong, flyable) = open(&surface, &voxels, |place| space.ball_is_free(place, RADIUS));
        let (wrong2, flyable2) = open(&surface, &voxels, |place| centres_are_free(&space, place));
        println!("| {max_triangle_angle} | {wrong} | {flyable} | {wrong2} | {flyable2} |");
        assert!(wrong <= most_open && wrong2 <= 5 && flyable > 1800);
    }
}

/// Proven free space whose surface are the points that its rays do not contradict, and how many they do.
fn without_contradicted(
    map: &Map,
    config: &FreeSpaceConfig,
) -> Result<(FreeSpace, usize), FreeSpaceError> {
    let nothing: [Vec3; 0] = [];
    let mut space = FreeSpace::from_rays(map.rays.iter().copied(), &nothing, config)?;
    let mut solid = map.points.clone();
    solid.retain(|&point| !space.contradicts(point));
    space.insert([], &solid)?;
    Ok((space, map.points.len() - solid.len()))
}

#[test]
fn without_contradicted_points_there_is_more_room() {
    let Some((map, surface)) = load() else {
        println!("skipped: the kitchen map or its depth images are not there (set EXPLORER_DATA)");
        return;
    };
    println!("| log-odds | carved between, rad | clearance | dropped | open | flyable |");
    println!("| --- | --- | --- | --- | --- | --- |");
    let measure = |config: &FreeSpaceConfig| {
        let (space, dropped) = without_contradicted(&map, config).unwrap();
        let voxels = space.voxel_centers();
        let (wrong, flyable) = open(&surface, &voxels, |place| centres_are_free(&space, place));
        let (odds, gap) = (config.contradiction_log_odds, config.max_triangle_angle);
        let clearance = config.clearance;
        println!("| {odds} | {gap} | {clearance} | {dropped} | {wrong} | {flyable} |");
        (wrong, flyable)
    };
    let base = FreeSpaceConfig {
        resolution: RESOLUTION,
        ..FreeSpaceConfig::default()
    };
    for contradiction_log_odds in [8.0, 32.0] {
        for max_triangle_angle in [0.0, 0.1] {
            measure(&FreeSpaceConfig {
                contradiction_log_odds,
                max_triangle_angle,
                ..base.clone()
            });
        }
    }
    // What `explorer obstacles --proven-free` exports: most room at the least share of open surface.
    let (wrong, flyable) = measure(&FreeSpaceConfig {
        clearance: 0.22,
        max_triangle_angle: 0.21,
        max_depth_ratio: 1.5,
        ..base
    });
    assert!(wrong * 2_000 <= surface.len(), "{wrong} open");
    assert!(flyable >= 4_673, "{flyable} places");
}
