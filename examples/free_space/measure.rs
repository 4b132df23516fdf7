//! What is open to the drone's centre: surface, which must not be, and room.

use std::collections::HashSet;

use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, FreeSpaceError};

use crate::arguments::Arguments;
use crate::map::AlignedMap;
use crate::truth::{Surface, cell};

/// What the hulls' view keeps from every point, metres.
pub(crate) const HULLS_CLEARANCE: f64 = 0.2;

/// One row of the table.
pub(crate) struct Setting {
    pub(crate) config: FreeSpaceConfig,
    /// Points that rays contradict are no surface.
    pub(crate) drops_contradicted: bool,
}

/// Voxels open to the drone's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Open {
    pub(crate) surface: usize,
    pub(crate) places: usize,
}

/// Both ways to ask where a ball fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measured {
    /// All voxels whose centres lie in the ball are free: how maps are measured and exported.
    pub(crate) by_centers: Open,
    /// All voxels that the ball touches are free: how motions are checked.
    pub(crate) by_touch: Open,
    /// Points that rays contradict.
    pub(crate) dropped: usize,
}

/// The library's settings, with rays only and two widths of triangles. The last is what `explorer obstacles --proven-free` exports.
pub(crate) fn settings(arguments: &Arguments) -> Vec<Setting> {
    let default = FreeSpaceConfig {
        resolution: arguments.voxel,
        contradiction_log_odds: arguments.contradiction,
        ..FreeSpaceConfig::default()
    };
    let mut settings = Vec::new();
    for drops_contradicted in [false, true] {
        for max_triangle_angle in [0.0, 0.1, default.max_triangle_angle] {
            let config = FreeSpaceConfig {
                max_triangle_angle,
                ..default.clone()
            };
            settings.push(Setting {
                config,
                drops_contradicted,
            });
        }
    }
    settings
}

/// How many surface voxels are farther than 0.2 m from every point: hulls do not keep the drone out of them.
pub(crate) fn hulls_view(map: &AlignedMap, surface: &Surface) -> usize {
    let squared = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>();
    let away = |place: &&[f64; 3]| {
        let near = |point| squared(point, place) < HULLS_CLEARANCE * HULLS_CLEARANCE;
        !map.points.iter().any(near)
    };
    surface.centers.iter().filter(away).count()
}

/// What proven free space leaves open.
pub(crate) fn proven(
    map: &AlignedMap,
    surface: &Surface,
    setting: &Setting,
    radius: f64,
) -> Result<Measured, FreeSpaceError> {
    let (space, dropped) = space(map, setting)?;
    let places = space.places(radius);
    let cells: HashSet<[i64; 3]> = places.iter().map(|&p| cell(p, surface.voxel)).collect();
    let held = |center: &&[f64; 3]| cells.contains(&cell(**center, surface.voxel));
    let fits = |center: &&[f64; 3]| space.ball_is_free(**center, radius);
    Ok(Measured {
        by_centers: Open {
            surface: surface.centers.iter().filter(held).count(),
            places: places.len(),
        },
        by_touch: Open {
            surface: surface.centers.iter().filter(fits).count(),
            places: space.voxel_centers().iter().filter(fits).count(),
        },
        dropped,
    })
}

/// Proven free space, and how many points were dropped.
fn space(map: &AlignedMap, setting: &Setting) -> Result<(FreeSpace, usize), FreeSpaceError> {
    let nothing: [[f64; 3]; 0] = [];
    let mut space = FreeSpace::from_rays(map.all_rays(), &nothing, &setting.config)?;
    let mut solid = map.points.clone();
    if setting.drops_contradicted {
        solid.retain(|&point| !space.contradicts(point));
    }
    space.insert([], &solid)?;
    Ok((space, map.points.len() - solid.len()))
}
