//! Space that rays have proven free: what the camera has seen through, in voxels.

mod carve;
mod config;
mod distance_field;
mod error;
mod evidence;
mod frontier;
mod grid;
mod interpolate;
mod panorama;
mod query;
mod ray;
mod surface;
mod traverse;
mod trust;

pub use config::FreeSpaceConfig;
pub use error::FreeSpaceError;
pub use query::VoxelState;
pub use ray::Ray;

use crate::point::{PointLike, finite_points, is_finite};
use crate::vector::{Vec3, max, min};
use carve::Carver;
use distance_field::DistanceField;
use evidence::{Evidence, KeyframeId, Known, Sighting};
use grid::{Cell, Grid};
use surface::Surface;
use trust::Trust;

/// Proven free space: voxels that rays from enough keyframes have crossed, and the surface points that
/// a motion must stay away from.
///
/// What no ray has crossed is not free, whether or not there are points: blank walls, windows and all
/// that the camera never looked at. Voxels are cubes of [`FreeSpaceConfig::resolution`] whose corners are
/// multiples of it. A crossed voxel counts as free as a whole, and points and keyframes are noisy: a surface without
/// points that rays graze may be entered by up to a voxel, which is the accuracy of the proof. Nothing hangs on a single point,
/// and a point proves nothing that the other rays contradict, or most of whose own rays pass through something solid.
#[derive(Clone, Debug)]
pub struct FreeSpace {
    config: FreeSpaceConfig,
    grid: Grid,
    evidence: Vec<Evidence>,
    keyframes: Known,
    points: Known,
    rays: u32,
    surface: Surface,
    presence: Vec<(Vec3, f64)>,
    free: Vec<bool>,
    to_blocked: DistanceField,
    to_surface: DistanceField,
}

impl FreeSpace {
    /// Carves the space along the rays. `surface` are the points that motions keep
    /// [`FreeSpaceConfig::clearance`] from: pass the cleaned map.
    ///
    /// Cost: O(voxels crossed) for the rays, which are followed three times (twice where all points are trusted), then O(voxels of the grid). No rays give a space in which
    /// nothing is free.
    ///
    /// # Errors
    /// A coordinate that is not finite, a configuration out of its range, more than 65,534 keyframes, or
    /// an extent that needs more than [`FreeSpaceConfig::max_voxels`] voxels.
    ///
    /// # Example
    /// ```
    /// use sparse_to_obstacles::{FreeSpace, FreeSpaceConfig, Ray};
    ///
    /// // Four keyframes see the same patch of wall at x = 3.
    /// let wall: Vec<[f64; 3]> = (0..400)
    ///     .map(|i| [3.0, f64::from(i % 20) * 0.1 - 1.0, f64::from(i / 20) * 0.1 - 1.0])
    ///     .collect();
    /// let keyframes = [[0.0, 0.0, 0.0], [0.1, 0.2, 0.0], [0.2, -0.1, 0.1], [0.3, 0.1, -0.1]];
    /// let rays = keyframes
    ///     .iter()
    ///     .flat_map(|&origin| wall.iter().map(move |&end| Ray { origin, end }));
    /// let free = FreeSpace::from_rays(rays, &wall, &FreeSpaceConfig::default())?;
    /// assert!(free.motion_is_free([2.0, 0.0, 0.0], [2.4, 0.0, 0.0], 0.15));
    /// assert!(!free.motion_is_free([2.0, 0.0, 0.0], [3.5, 0.0, 0.0], 0.15));
    /// # Ok::<(), sparse_to_obstacles::FreeSpaceError>(())
    /// ```
    pub fn from_rays<P: PointLike>(
        rays: impl IntoIterator<Item = Ray>,
        surface: &[P],
        config: &FreeSpaceConfig,
    ) -> Result<Self, FreeSpaceError> {
        config.validate()?;
        let mut space = FreeSpace {
            config: config.clone(),
            grid: Grid::empty(config.resolution),
            evidence: Vec::new(),
            keyframes: Known::default(),
            points: Known::default(),
            rays: 0,
            surface: Surface::default(),
            presence: Vec::new(),
            free: Vec::new(),
            to_blocked: DistanceField::default(),
            to_surface: DistanceField::default(),
        };
        space.insert(rays, surface)?;
        Ok(space)
    }

    /// Adds rays and surface points of a map that has grown. Rays with the same origin belong to the
    /// same keyframe, also across calls, but the space between rays is carved only among those of one
    /// call: pass all rays of a keyframe at once. A point is judged by all rays so far when it is added, not again later. On an
    /// error nothing is added.
    ///
    /// # Errors
    /// As [`from_rays`](Self::from_rays).
    pub fn insert<P: PointLike>(
        &mut self,
        rays: impl IntoIterator<Item = Ray>,
        surface: &[P],
    ) -> Result<(), FreeSpaceError> {
        let rays: Vec<Ray> = rays.into_iter().collect();
        if let Some(index) = rays.iter().position(|ray| !ray.is_finite()) {
            return Err(FreeSpaceError::RayNotFinite { index });
        }
        let surface =
            finite_points(surface).map_err(|index| FreeSpaceError::PointNotFinite { index })?;
        let mut keyframes = self.keyframes.clone();
        let ids = keyframes.number(rays.iter().map(|ray| ray.origin));
        if keyframes.len() > evidence::MOST_KEYFRAMES {
            let max = evidence::MOST_KEYFRAMES;
            return Err(FreeSpaceError::TooManyKeyframes { max });
        }
        let config = self.config.clone();
        self.reserve(rays.iter().flat_map(|ray| [ray.origin, config.reach(ray)]))?;
        self.keyframes = keyframes;
        let points = self.points.number(rays.iter().map(|ray| ray.end));
        self.carve(&evidence::by_keyframe(&rays, &ids, &points));
        let presence = &self.presence;
        let stands = |point: &Vec3| !presence.iter().any(|&ball| contains(ball, *point));
        self.surface.extend(surface.into_iter().filter(stands));
        self.refresh();
        Ok(())
    }

    /// Counts all rays before any proves something: together they tell which points are wrong.
    fn carve(&mut self, keyframes: &[(KeyframeId, Vec<Sighting>)]) {
        let mut carver = Carver {
            config: &self.config,
            grid: &self.grid,
            evidence: &mut self.evidence,
            rays: &mut self.rays,
        };
        let sightings = || keyframes.iter().flat_map(|(_, sightings)| sightings);
        for sighting in sightings() {
            carver.count(sighting);
        }
        let (points, evidence) = (self.points.len(), &*carver.evidence);
        let trust = Trust::new(sightings(), points, &self.grid, evidence, &self.config);
        for (keyframe, sightings) in keyframes {
            carver.prove(sightings, *keyframe, &trust);
        }
    }

    /// Marks a ball as free because the drone itself is, or was, there: the start bubble of a mission.
    ///
    /// All voxels that the ball touches become free, and surface points inside the ball are dropped,
    /// since nothing can be where the drone was.
    ///
    /// # Errors
    /// A centre or radius that is not finite, a negative radius, or an extent beyond
    /// [`FreeSpaceConfig::max_voxels`].
    pub fn add_ball(&mut self, centre: [f64; 3], radius: f64) -> Result<(), FreeSpaceError> {
        self.add_balls(&[centre], radius)
    }

    /// [`add_ball`](Self::add_ball) along a flown trajectory, at the cost of one.
    ///
    /// # Errors
    /// As [`add_ball`](Self::add_ball).
    pub fn add_balls<P: PointLike>(
        &mut self,
        centres: &[P],
        radius: f64,
    ) -> Result<(), FreeSpaceError> {
        let centres = finite_points(centres).map_err(|_| FreeSpaceError::Ball { radius })?;
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(FreeSpaceError::Ball { radius });
        }
        self.reserve(
            centres
                .iter()
                .flat_map(|centre| [centre.map(|c| c - radius), centre.map(|c| c + radius)]),
        )?;
        for &centre in &centres {
            let (grid, evidence) = (&self.grid, &mut self.evidence);
            grid.for_each_touched(centre, radius, |index| evidence[index].prove_by_presence());
            self.surface
                .retain(|point| !contains((centre, radius), *point));
            self.presence.push((centre, radius));
        }
        self.refresh();
        Ok(())
    }

    /// Grows the grid so that it holds the points and a border in which nothing is free.
    fn reserve(&mut self, points: impl Iterator<Item = Vec3>) -> Result<(), FreeSpaceError> {
        let bounds = points.fold(None, |bounds: Option<(Vec3, Vec3)>, point| match bounds {
            None => Some((point, point)),
            Some((low, high)) => Some((min(low, point), max(high, point))),
        });
        let Some((low, high)) = bounds else {
            return Ok(());
        };
        let cone = self.config.max_range * self.config.patch_half_angle.tan();
        let border = self.config.clearance + cone + 2.0 * self.config.resolution;
        let grown = self.grid.grown(
            low.map(|c| c - border),
            high.map(|c| c + border),
            self.config.max_voxels,
        )?;
        if grown != self.grid {
            let mut evidence = vec![Evidence::default(); grown.len()];
            for (index, &old) in self.evidence.iter().enumerate() {
                if let Some(to) = grown.index(self.grid.cell_at(index)) {
                    evidence[to] = old;
                }
            }
            self.evidence = evidence;
            self.grid = grown;
        }
        Ok(())
    }

    /// Recomputes what follows from the evidence.
    fn refresh(&mut self) {
        let config = &self.config;
        self.free = self
            .evidence
            .iter()
            .map(|evidence| evidence.is_free(config))
            .collect();
        self.surface.sort_into(&self.grid);
        let free = &self.free;
        self.to_blocked = DistanceField::new(&self.grid, |index| !free[index]);
        let surface = &self.surface;
        self.to_surface = DistanceField::new(&self.grid, |index| surface.occupies(index));
    }

    /// Edge length of a voxel, map units.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.config.resolution
    }

    /// How many voxels are proven free.
    #[must_use]
    pub fn voxel_count(&self) -> usize {
        self.free.iter().filter(|&&free| free).count()
    }

    /// The centres of the proven-free voxels, in the order of their coordinates (x, then y, then z).
    #[must_use]
    pub fn voxel_centers(&self) -> Vec<[f64; 3]> {
        self.free_cells()
            .map(|cell| self.grid.centre(cell))
            .collect()
    }

    /// How many keyframes have contributed rays.
    #[must_use]
    pub fn keyframe_count(&self) -> usize {
        self.keyframes.len()
    }

    fn free_cells(&self) -> impl Iterator<Item = Cell> + '_ {
        let indices = self.free.iter().enumerate().filter(|&(_, &free)| free);
        indices.map(|(index, _)| self.grid.cell_at(index))
    }
}

fn contains((centre, radius): (Vec3, f64), point: Vec3) -> bool {
    is_finite(point) && crate::vector::distance(centre, point) < radius
}

#[cfg(test)]
mod proof_tests;
#[cfg(test)]
mod tests;
