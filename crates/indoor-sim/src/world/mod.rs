//! A world: what is solid, what can be seen, where the drone starts, and exact queries against the truth.

mod coverage;
mod error;
mod floor_plan;
mod generator;
mod landmark;
mod landmark_index;
mod presets;
mod reach;
mod solid;
mod solid_index;
mod texture;
mod walls;

pub use coverage::coverage;
pub use error::WorldError;
pub use floor_plan::{Door, FloorPlan, Furniture, Room, Start};
pub use generator::generate;
pub use landmark::Landmark;
pub use presets::PRESETS;
use presets::unknown;
pub use reach::Reach;
pub use solid::{Solid, SolidKind};
pub use texture::TextureConfig;

pub(crate) use coverage::FLYING_HEIGHT;

use crate::random::{Purpose, stream};
use landmark_index::Group;
use solid_index::SolidIndex;

/// A furnished storey with its landmarks: the truth that the simulator flies in. Immutable once built.
#[derive(Debug, Clone)]
pub struct World {
    plan: FloorPlan,
    solids: Vec<Solid>,
    landmarks: Vec<Landmark>,
    groups: Vec<Group>,
    index: SolidIndex,
}

impl World {
    /// A preset by name (see [`PRESETS`]) or `generated:SEED`; `seed` draws the texture.
    ///
    /// ```
    /// let world = indoor_sim::World::named("one-door-room", 7)?;
    /// assert_eq!(world.doors().len(), 1);
    /// assert!(indoor_sim::World::named("castle", 7).is_err());
    /// # Ok::<(), indoor_sim::WorldError>(())
    /// ```
    ///
    /// # Errors
    /// [`WorldError::UnknownName`] lists the names there are.
    pub fn named(name: &str, seed: u64) -> Result<Self, WorldError> {
        if let Some(layout) = name.strip_prefix("generated:") {
            let layout: u64 = layout.parse().map_err(|_| unknown(name))?;
            return Self::new(generate(layout)?, seed);
        }
        Self::new(presets::plan(name)?, seed)
    }

    /// Builds a plan; `seed` draws the texture, with [`TextureConfig::default`].
    ///
    /// # Errors
    /// All of [`FloorPlan::validate`], [`WorldError::DoorOffWall`] and [`WorldError::StartBlocked`].
    pub fn new(plan: FloorPlan, seed: u64) -> Result<Self, WorldError> {
        Self::with_texture(plan, &TextureConfig::default(), seed)
    }

    /// Builds a plan with its own densities of texture.
    ///
    /// # Errors
    /// As [`World::new`].
    pub fn with_texture(
        plan: FloorPlan,
        texture: &TextureConfig,
        seed: u64,
    ) -> Result<Self, WorldError> {
        texture.validate()?;
        let mut world = Self::untextured(plan)?;
        let mut rng = stream(seed, Purpose::Texture);
        let painted = texture::paint(&world.plan, &world.solids, texture, &mut rng);
        (world.landmarks, world.groups) = landmark_index::group(painted);
        Ok(world)
    }

    /// A world without landmarks, for queries about space alone.
    fn untextured(plan: FloorPlan) -> Result<Self, WorldError> {
        plan.validate()?;
        let solids = walls::solids(&plan)?;
        let index = SolidIndex::new(&solids);
        let world = Self {
            plan,
            solids,
            landmarks: Vec::new(),
            groups: Vec::new(),
            index,
        };
        let [x, y] = world.plan.start.position;
        let inside = world.room_at([x, y, 0.1]).is_some();
        let clearance = world.wall_clearance([x, y, 0.1]);
        if !inside || clearance < 0.15 {
            let clearance = if inside { clearance } else { 0.0 };
            return Err(WorldError::StartBlocked { x, y, clearance });
        }
        Ok(world)
    }

    /// The plan's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.plan.name
    }

    /// The plan the world was built from.
    #[must_use]
    pub fn plan(&self) -> &FloorPlan {
        &self.plan
    }

    /// All solids: floor, ceiling, walls, lintels, furniture.
    #[must_use]
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// All landmarks.
    #[must_use]
    pub fn landmarks(&self) -> &[Landmark] {
        &self.landmarks
    }

    /// The landmarks in groups that can be dismissed together.
    pub(crate) fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// The rooms.
    #[must_use]
    pub fn rooms(&self) -> &[Room] {
        &self.plan.rooms
    }

    /// The doors.
    #[must_use]
    pub fn doors(&self) -> &[Door] {
        &self.plan.doors
    }

    /// Where the drone stands at first.
    #[must_use]
    pub fn start(&self) -> Start {
        self.plan.start
    }

    /// Floor to ceiling, metres.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.plan.height
    }

    /// Lowest and highest corner of the space between floor, ceiling and outer walls, metres.
    #[must_use]
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let side = |axis: usize| {
            let low = self.plan.rooms.iter().map(|room| room.min[axis]);
            let high = self.plan.rooms.iter().map(|room| room.max[axis]);
            (
                low.fold(f64::INFINITY, f64::min),
                high.fold(f64::NEG_INFINITY, f64::max),
            )
        };
        let ((x0, x1), (y0, y1)) = (side(0), side(1));
        ([x0, y0, 0.0], [x1, y1, self.plan.height])
    }

    /// Number of the room that the point is in or above; `None` outside.
    #[must_use]
    pub fn room_at(&self, point: [f64; 3]) -> Option<usize> {
        self.plan.rooms.iter().position(|room| {
            (0..2).all(|axis| room.min[axis] <= point[axis] && point[axis] <= room.max[axis])
        })
    }

    /// Distance from the point to the nearest solid, metres; 0 inside a solid.
    #[must_use]
    pub fn clearance(&self, point: [f64; 3]) -> f64 {
        self.solids
            .iter()
            .map(|solid| solid.distance(point))
            .fold(f64::INFINITY, f64::min)
    }

    /// Distance to the nearest solid other than the floor, metres.
    pub(crate) fn wall_clearance(&self, point: [f64; 3]) -> f64 {
        self.solids
            .iter()
            .filter(|solid| solid.kind != SolidKind::Floor)
            .map(|solid| solid.distance(point))
            .fold(f64::INFINITY, f64::min)
    }

    /// Exact distance from the segment to the nearest solid, metres.
    #[must_use]
    pub fn segment_clearance(&self, start: [f64; 3], end: [f64; 3]) -> f64 {
        self.solids
            .iter()
            .map(|solid| solid.segment_distance(start, end))
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether a ball of `radius` metres can move along the segment without touching anything solid. Exact. False when a
    /// number is not finite.
    #[must_use]
    pub fn segment_is_free(&self, start: [f64; 3], end: [f64; 3], radius: f64) -> bool {
        let finite = start.iter().chain(&end).all(|value| value.is_finite());
        finite && self.segment_clearance(start, end) > radius
    }

    /// Where a ray from `origin` towards `direction` (any length above 0) first meets something solid: distance in metres
    /// and the number of the solid. `None` beyond `max_range` or when a number is not finite.
    #[must_use]
    pub fn ray_cast(
        &self,
        origin: [f64; 3],
        direction: [f64; 3],
        max_range: f64,
    ) -> Option<(f64, usize)> {
        let length = direction
            .iter()
            .map(|value| value * value)
            .sum::<f64>()
            .sqrt();
        let usable = length > 0.0 && length.is_finite() && max_range > 0.0 && max_range.is_finite();
        if !usable || !origin.iter().all(|value| value.is_finite()) {
            return None;
        }
        let end = core::array::from_fn(|axis| origin[axis] + direction[axis] / length * max_range);
        let (t, solid) = self.index.first_hit(&self.solids, origin, end)?;
        Some((t * max_range, solid))
    }

    /// Whether nothing solid lies between two points.
    #[must_use]
    pub fn sees(&self, from: [f64; 3], to: [f64; 3]) -> bool {
        let finite = from.iter().chain(&to).all(|value| value.is_finite());
        finite && self.index.first_hit(&self.solids, from, to).is_none()
    }

    /// Whether a camera at `from` can see the landmark, by distance, angle and occlusion.
    #[must_use]
    pub fn sees_landmark(&self, from: [f64; 3], landmark: &Landmark) -> bool {
        let toward: [f64; 3] = core::array::from_fn(|axis| from[axis] - landmark.position[axis]);
        let range = toward.iter().map(|value| value * value).sum::<f64>().sqrt();
        let cosine: f64 = (0..3)
            .map(|axis| toward[axis] * landmark.normal[axis])
            .sum::<f64>();
        let facing = cosine >= landmark.least_cosine * range;
        let resolved = range >= landmark.near && range <= landmark.far;
        facing && resolved && self.sees(from, landmark.sight_point())
    }

    /// Places at `height` that a ball of `radius` can reach from the start, on a grid of `resolution`, all metres.
    /// A resolution that would need more than four million cells is made coarser; one that is not positive too.
    #[must_use]
    pub fn reachable(&self, height: f64, resolution: f64, radius: f64) -> Reach {
        reach::reachable(self, height, resolution, radius)
    }
}
