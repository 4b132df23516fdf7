//! One look at a map: cleaned points, obstacles, and the space that is proven free.
//!
//! Input:  a map with observations, metres per map unit, and the places where the drone itself has been.
//! Output: a [`Scene`] that answers whether a motion is free.
//! Method: 1. outlier removal; 2. rays from keyframes to the kept points that they see carve proven-free voxels; 3. K-means and
//!         hulls (paper, section IV-B). A motion is free when it stays clear of all hulls *and* inside what was
//!         seen through: blank walls have no points, so hulls alone leak (paper's rule: hulls alone).
//! Degenerate input: fewer than five points are all kept; a map without observations proves nothing free.

use exit_finder::{AffinePlane, ExitConfig, ExitError, PlaneError};
use nalgebra::{Point3, Vector3};
use rand::Rng;
use slam_bridge::Map;
use sparse_to_obstacles::{
    FreeSpace, FreeSpaceError, ObstacleConfig, ObstacleError, ObstacleSet, Ray, Space,
};
use submodular_minimax::{OutlierError, ViewsError, remove_outliers};

use crate::config::{MissionConfig, PerceptionConfig};
use crate::exit_search::{ExitCloud, ExitSearch, ExitSeeker};
use crate::heading::LevelPose;
use crate::map_views::map_views;
use crate::reach::Room;
use crate::sight::Sight;
use crate::stage::{Stage, StageObserver, staged};

/// So many other observers of a point make one keyframe's view of it unnecessary.
const ENOUGH_WITNESSES: usize = 2;
/// A keyframe is unnecessary when this share of its points is (ORB-SLAM culls keyframes by a share of 0.9).
const SPARE_SHARE: f64 = 0.8;
/// Keyframes look the same way that are this near, metres, and whose axes have this cosine.
const SAME_VIEW: (f64, f64) = (0.2, 0.94);

/// Halvings when a clearance is searched.
const CLEARANCE_BITS: u32 = 5;

/// What one look at a map yields. All coordinates in map units.
#[derive(Debug, Clone)]
pub struct Scene {
    /// All points of the map.
    pub points: Vec<[f64; 3]>,
    /// Indices of the points that were kept, ascending.
    pub kept: Vec<usize>,
    /// Indices of the points that were removed, ascending.
    pub removed: Vec<usize>,
    /// The convex obstacles.
    pub obstacles: ObstacleSet,
    /// The space that rays have proven free.
    pub free: FreeSpace,
    /// Which points the camera sees from where.
    pub sight: Sight,
    /// Metres per map unit.
    pub meters_per_unit: f64,
}

/// Why no scene could be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The scale is unusable.
    #[error("the map's scale is {meters_per_unit} metres per unit; it must be finite and positive")]
    Scale {
        /// What was given.
        meters_per_unit: f64,
    },
    /// The observations contradict themselves.
    #[error(transparent)]
    Views(#[from] ViewsError),
    /// Outlier removal failed.
    #[error(transparent)]
    Clean(#[from] OutlierError),
    /// Obstacles could not be built.
    #[error(transparent)]
    Obstacles(#[from] ObstacleError),
    /// Proven-free space could not be built.
    #[error(transparent)]
    FreeSpace(#[from] FreeSpaceError),
    /// No ground-parallel plane.
    #[error(transparent)]
    Plane(#[from] PlaneError),
    /// Exits could not be looked for.
    #[error(transparent)]
    Exits(#[from] ExitError),
}

/// A place where the drone's body has been, so that it is free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Presence {
    /// Centre, map units.
    pub center: [f64; 3],
    /// Radius, map units.
    pub radius: f64,
}

impl Presence {
    fn holds(&self, point: &[f64; 3]) -> bool {
        (Point3::from(*point) - Point3::from(self.center)).norm() < self.radius
    }
}

impl Scene {
    /// Looks at `map`.
    ///
    /// # Errors
    /// The first stage that fails, with its reason.
    pub fn new(
        map: &Map,
        meters_per_unit: f64,
        presence: &[Presence],
        config: &MissionConfig,
        rng: &mut impl Rng,
        stages: &mut dyn StageObserver,
    ) -> Result<Self, SceneError> {
        if !(meters_per_unit.is_finite() && meters_per_unit > 0.0) {
            return Err(SceneError::Scale { meters_per_unit });
        }
        let perception = &config.perception;
        let points = map.positions();
        let removal = staged(stages, Stage::Clean, || clean(map, &points, perception))?;
        let solid: Vec<[f64; 3]> = removal
            .kept
            .iter()
            .filter_map(|&index| points.get(index).copied())
            .filter(|point| !presence.iter().any(|place| place.holds(point)))
            .collect();
        let free = staged(stages, Stage::FreeSpace, || {
            proven_free(
                map,
                &removal.kept,
                &solid,
                meters_per_unit,
                presence,
                config,
            )
        })?;
        let obstacles = staged(stages, Stage::Obstacles, || {
            obstacles(&solid, meters_per_unit, perception, rng)
        })?;
        let sight = Sight::new(map, &removal.kept);
        Ok(Self {
            points,
            sight,
            kept: removal.kept,
            removed: removal.removed,
            obstacles,
            free,
            meters_per_unit,
        })
    }

    /// Metres in map units.
    #[must_use]
    pub fn units(&self, meters: f64) -> f64 {
        meters / self.meters_per_unit
    }

    /// Whether a ball of `radius` map units may fly straight from `a` to `b`.
    #[must_use]
    pub fn motion_is_free(&self, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> bool {
        let space = Space::ProvenFree {
            hulls: &self.obstacles,
            free: &self.free,
        };
        space.motion_is_free((*a).into(), (*b).into(), radius)
    }

    /// Radius of the largest free ball around `place`, map units, up to `most`; known to one part in 32 of that. 0 where nothing fits.
    #[must_use]
    pub fn clearance(&self, place: &Point3<f64>, most: f64) -> f64 {
        let fits = |radius: f64| self.motion_is_free(place, place, radius);
        if fits(most) {
            return most;
        }
        let (mut low, mut high) = (0.0, most);
        for _ in 0..CLEARANCE_BITS {
            let middle = 0.5 * (low + high);
            if fits(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Whether the straight line between two places is proven free: what lies there has been seen through.
    #[must_use]
    pub fn sees(&self, a: &Point3<f64>, b: &Point3<f64>) -> bool {
        self.free.motion_is_free((*a).into(), (*b).into(), 0.0)
    }

    /// Positions of the points that were kept.
    #[must_use]
    pub fn kept_points(&self) -> Vec<[f64; 3]> {
        self.kept
            .iter()
            .filter_map(|&index| self.points.get(index).copied())
            .collect()
    }

    /// Looks for exits around `pose` among what was seen from about there: points of other rooms, seen from there, lie behind walls
    /// like those seen through a door. `map` tells where the camera looked and who saw what, the points `closed` stand in openings that have been used.
    ///
    /// # Errors
    /// Too few points around the agent, or a degenerate plane.
    pub fn exits(
        &self,
        map: &Map,
        pose: &LevelPose,
        closed: &[[f64; 3]],
        config: &MissionConfig,
    ) -> Result<ExitSearch, SceneError> {
        let plane = AffinePlane::from_up(pose.up.into(), pose.position.into())?;
        let seeker = ExitSeeker {
            plane: &plane,
            position: pose.position.into(),
            heading: Some(pose.forward.into()),
            closed,
        };
        let need = 2.0 * config.planning_radius_m();
        let exits = ExitConfig {
            min_width: Some(self.units(need)),
            ..config.perception.exits
        };
        let near = self.units(config.perception.exit_view_m);
        // Rays and removed points gained flights nothing: docs/missions.md has the figures.
        let about = &pose.position;
        let mut cloud = ExitCloud::seen_about(map, &self.kept, &[], about, near).without_rays();
        let mut report = cloud.exits(map, &seeker, &exits);
        if matches!(report, Err(ExitError::InsufficientMap { .. })) {
            // No keyframe is near enough, or the map does not tell who saw what.
            cloud = ExitCloud::of(map, &self.kept, &[]).without_rays();
            report = cloud.exits(map, &seeker, &exits);
        }
        Ok(ExitSearch {
            report: report?,
            cloud: cloud.kept,
        })
    }
}

impl Room for Scene {
    fn clearance(&self, place: &Point3<f64>, most: f64) -> f64 {
        Self::clearance(self, place, most)
    }

    fn motion_is_free(&self, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> bool {
        Self::motion_is_free(self, a, b, radius)
    }
}

fn clean(
    map: &Map,
    points: &[[f64; 3]],
    config: &PerceptionConfig,
) -> Result<submodular_minimax::OutlierRemoval, SceneError> {
    let views = map_views(map)?;
    Ok(remove_outliers(points, views.as_ref(), &config.clean)?)
}

fn proven_free(
    map: &Map,
    kept: &[usize],
    solid: &[[f64; 3]],
    meters_per_unit: f64,
    presence: &[Presence],
    config: &MissionConfig,
) -> Result<FreeSpace, SceneError> {
    let settings = config
        .perception
        .free_space
        .clone()
        .scaled(1.0 / meters_per_unit);
    let mut free = FreeSpace::from_rays(rays(map, kept, meters_per_unit), solid, &settings)?;
    for places in presence.chunk_by(|a, b| a.radius == b.radius) {
        let centers: Vec<[f64; 3]> = places.iter().map(|place| place.center).collect();
        free.add_balls(&centers, places.first().map_or(0.0, |place| place.radius))?;
    }
    Ok(free)
}

/// One ray from every keyframe that is needed to every point of `kept` that it sees.
///
/// SLAM keeps about ten observers to a point; a proof needs two. A keyframe is left out where an older one is near that looks the same
/// way and [`ENOUGH_WITNESSES`] others see most of its points as well. Those from elsewhere stay: they prove what lies before blank
/// walls, which rays from one place alone never cross.
fn rays(map: &Map, kept: &[usize], meters_per_unit: f64) -> Vec<Ray> {
    let mut seen: Vec<Vec<usize>> = vec![Vec::new(); map.keyframes.len()];
    let mut witnesses = vec![0_usize; map.points.len()];
    for &index in kept {
        let Some(point) = map.points.get(index) else {
            continue;
        };
        for keyframe in point
            .observers
            .iter()
            .filter_map(|&id| map.keyframe_index(id))
        {
            seen[keyframe].push(index);
            witnesses[index] += 1;
        }
    }
    let mut rays = Vec::new();
    let mut views: Vec<(Point3<f64>, Vector3<f64>)> = Vec::new();
    for (keyframe, points) in map.keyframes.iter().zip(&seen) {
        let (center, forward) = (keyframe.center(), Vector3::from(keyframe.forward()));
        let spare = points
            .iter()
            .filter(|&&index| witnesses[index] > ENOUGH_WITNESSES)
            .count();
        let redundant = spare as f64 >= SPARE_SHARE * points.len() as f64
            && views.iter().any(|(place, axis)| {
                (place - center).norm() * meters_per_unit < SAME_VIEW.0
                    && axis.dot(&forward) > SAME_VIEW.1
            });
        if redundant {
            for &index in points {
                witnesses[index] -= 1;
            }
            continue;
        }
        views.push((center, forward));
        let origin = center.into();
        rays.extend(points.iter().map(|&index| Ray {
            origin,
            end: map.points[index].position.into(),
        }));
    }
    rays
}

fn obstacles(
    solid: &[[f64; 3]],
    meters_per_unit: f64,
    config: &PerceptionConfig,
    rng: &mut impl Rng,
) -> Result<ObstacleSet, SceneError> {
    let clusters = (solid.len() / config.points_per_cluster.max(1)).max(1);
    let settings = ObstacleConfig {
        max_diameter: config.largest_obstacle_m / meters_per_unit,
        ..ObstacleConfig::with_clusters(clusters)
    };
    Ok(ObstacleSet::from_points(solid, &settings, rng)?)
}

#[cfg(test)]
impl Scene {
    /// A scene in metres with these points, in which the balls about `free` are proven free.
    pub(crate) fn proven(
        points: Vec<[f64; 3]>,
        free: &[[f64; 3]],
        radius: f64,
        config: &MissionConfig,
    ) -> Self {
        use rand::SeedableRng;

        let settings = config.perception.free_space.clone();
        let mut space = FreeSpace::from_rays([], &points, &settings).unwrap();
        space.add_balls(free, radius).unwrap();
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        Self {
            obstacles: obstacles(&points, 1.0, &config.perception, &mut rng).unwrap(),
            kept: (0..points.len()).collect(),
            removed: Vec::new(),
            free: space,
            sight: Sight::new(&Map::default(), &[]),
            meters_per_unit: 1.0,
            points,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Isometry3, Translation3};
    use slam_bridge::{KeyFrame, KeyFrameId, MapPoint, PointId};

    /// A closed room of 4 m by 4 m about the drone, y down, in a hall of 12 m by 12 m. A keyframe in the room saw the room, one far
    /// off saw the stretch of the hall that lies behind the wall towards z, as if through a door there.
    fn map(tells_observers: bool) -> Map {
        let square = |half: f64, bearing: f64| half / bearing.cos().abs().max(bearing.sin().abs());
        let mut points = Vec::new();
        let mut add = |half: f64, bearing: f64, keyframe: u64| {
            let range = square(half, bearing);
            for height in -4..=4 {
                let position = [
                    range * bearing.cos(),
                    0.1 * f64::from(height),
                    range * bearing.sin(),
                ];
                points.push(MapPoint {
                    id: PointId(points.len() as u64),
                    position: position.into(),
                    viewing_direction: None,
                    max_distance: None,
                    observers: tells_observers
                        .then_some(KeyFrameId(keyframe))
                        .into_iter()
                        .collect(),
                });
            }
        };
        for step in 0..720 {
            let bearing = (f64::from(step) * 0.5 + 0.25).to_radians();
            let towards_z = (75..105).contains(&(step / 2));
            if towards_z {
                // Few points on a bare wall, many of the hall behind it.
                add(6.0, bearing, 2);
            }
            if !towards_z || step % 6 == 0 {
                add(2.0, bearing, 1);
            }
        }
        let keyframe = |id, z| KeyFrame {
            id: KeyFrameId(id),
            time: None,
            world_from_camera: Isometry3::from(Translation3::new(0.0, 0.0, z)),
        };
        Map {
            points,
            keyframes: vec![keyframe(1, 0.0), keyframe(2, 4.0)],
            ..Map::default()
        }
    }

    #[test]
    fn rooms_behind_a_wall_that_others_saw_open_no_exit() {
        let config = MissionConfig::default();
        let up = Vector3::new(0.0, -1.0, 0.0);
        let pose = LevelPose::from_camera(&Isometry3::identity(), up).unwrap();
        let [told, untold] = [true, false].map(|tells_observers| {
            let map = map(tells_observers);
            let scene = Scene::proven(map.positions(), &[], 0.0, &config);
            scene.exits(&map, &pose, &[], &config).unwrap()
        });
        // Without observations nothing tells the hall's points from those seen through a door.
        assert_eq!(untold.report.exits.len(), 1);
        assert_eq!(told.report.exits.len(), 0);
        assert!(told.cloud.len() < untold.cloud.len());
    }
}
