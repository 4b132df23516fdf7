//! The space in which `explorer plan` looks for paths, the bubble at the start left out.

use std::collections::BTreeSet;
use std::error::Error;

use rand::SeedableRng;
use rand_pcg::Pcg64;
use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, ObstacleConfig, ObstacleSet, Space, kmeans};
use submodular_minimax::{OutlierConfig, remove_outliers};

use crate::arguments::Arguments;
use crate::map::AlignedMap;
use crate::measure::Open;
use crate::truth::{Surface, cell};

/// As the command chooses K.
const POINTS_PER_CLUSTER: usize = 12;

/// What a motion check lets the drone's ball be in.
pub(crate) struct Planner {
    pub(crate) config: FreeSpaceConfig,
    /// Open surface voxels among the hulls alone, those of the paper's view.
    pub(crate) hulls: usize,
    /// Among hulls and in proven free space. Places are voxels of the truth's size.
    pub(crate) proven: Open,
    /// Outliers and points that rays contradict: those of no hull.
    pub(crate) dropped: usize,
}

/// Outliers and contradicted points make no hulls; proven free space keeps away from outliers too, as in the export.
pub(crate) fn measured(
    map: &AlignedMap,
    surface: &Surface,
    arguments: &Arguments,
) -> Result<Planner, Box<dyn Error>> {
    let removed =
        remove_outliers(&map.points, Some(&map.views), &OutlierConfig::default())?.removed;
    let outliers: BTreeSet<usize> = removed.into_iter().collect();
    let kept: Vec<usize> = (0..map.points.len())
        .filter(|i| !outliers.contains(i))
        .collect();
    let config = FreeSpaceConfig {
        resolution: arguments.voxel,
        contradiction_log_odds: arguments.contradiction,
        ..FreeSpaceConfig::default()
    };
    let nothing: [[f64; 3]; 0] = [];
    let mut free = FreeSpace::from_rays(map.all_rays(), &nothing, &config)?;
    let uncontradicted = |points: Vec<[f64; 3]>| -> Vec<[f64; 3]> {
        let points = points.into_iter();
        points.filter(|&point| !free.contradicts(point)).collect()
    };
    let surface_points = uncontradicted(map.points.clone());
    let solid = uncontradicted(kept.iter().map(|&i| map.points[i]).collect());
    free.insert([], &surface_points)?;
    let clusters = (kept.len() / POINTS_PER_CLUSTER).clamp(1, solid.len().max(1));
    let hulls = hulls(&solid, clusters)?;
    let open = |space: Space<'_>, places: &[[f64; 3]]| {
        let fits = |place: &&[f64; 3]| space.ball_is_free(**place, arguments.radius);
        places.iter().filter(fits).count()
    };
    let proven = Space::ProvenFree {
        hulls: &hulls,
        free: &free,
    };
    Ok(Planner {
        hulls: open(Space::Hulls(&hulls), &surface.centers),
        proven: Open {
            surface: open(proven, &surface.centers),
            places: open(proven, &seen_through(&free, surface.voxel)),
        },
        dropped: map.points.len() - solid.len(),
        config,
    })
}

fn hulls(points: &[[f64; 3]], clusters: usize) -> Result<ObstacleSet, Box<dyn Error>> {
    let mut rng = Pcg64::seed_from_u64(0);
    let clustering = kmeans(
        points,
        &ObstacleConfig::with_clusters(clusters).kmeans,
        &mut rng,
    )?;
    Ok(ObstacleSet::from_clustering(points, &clustering)?)
}

/// The centres of the truth's voxels that touch a voxel which was seen through.
fn seen_through(free: &FreeSpace, voxel: f64) -> Vec<[f64; 3]> {
    let half = 0.5 * free.resolution();
    let mut cells = BTreeSet::new();
    for center in free.voxel_centers() {
        let low = cell(center.map(|c| c - half), voxel);
        let high = cell(center.map(|c| c + half), voxel);
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                cells.extend((low[2]..=high[2]).map(|z| [x, y, z]));
            }
        }
    }
    let center = |cell: [i64; 3]| cell.map(|c| (c as f64 + 0.5) * voxel);
    cells.into_iter().map(center).collect()
}
