//! The settings of proven free space and their ranges.

use super::error::FreeSpaceError;
use super::ray::Ray;
use crate::vector::{distance, lerp};

/// Settings of [`FreeSpace`](crate::FreeSpace). Lengths are map units; the defaults are metres, use
/// [`scaled`](Self::scaled) for a map of another scale.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeSpaceConfig {
    /// Edge length of a voxel, more than 0. Default 0.1 m: with 0.08 m motions keep 0.01 to 0.02 m more from true walls of simulated
    /// apartments, but a tenth less space is proven and 84 % of the queries are solved in place of 91 %.
    pub resolution: f64,
    /// Share of a ray before its end that is not carved, because the range of a sparse point is
    /// uncertain. 0 to below 1. Default 0.1: the median error of real maps is 2 to 5 %, and with 10 %
    /// no true surface was carved on a real kitchen.
    pub range_margin: f64,
    /// A ray is carved no farther than this from its keyframe. More than 0. Default 8 m. Keeps points at
    /// a wild range from growing the grid.
    pub max_range: f64,
    /// A voxel is proven only if at least this many keyframes saw through it. 1 to 4. Default 2: one wrong match cannot
    /// open a wall. From 2 on it must also stay seen without any one of the points: several keyframes may agree on a wrong point,
    /// and its rays and triangles opened the blank ends of simulated walls.
    pub min_keyframes: usize,
    /// Least distance between the centre of a moving ball and a surface point; where the ball's radius
    /// is larger, that counts. At least 0. Default 0.22 m: 0.2 m, beyond which little true surface lies open in a real kitchen, and a
    /// quarter of a voxel.
    pub clearance: f64,
    /// Half the angle, in radians, of the cone that a ray carves. A feature is not a line of sight but
    /// an image patch: ORB describes 31 x 31 pixels, or 15/920 to each side at a Tello's focal length, and matching it shows that
    /// most of it was seen, but not at the edge of something. 0 carves lines. Below 0.2. Default 0: in simulated apartments
    /// cones of 15/920 bring motions 0.01 to 0.02 m nearer to true walls for 4 % more space, in a real kitchen they prove nothing more.
    pub patch_half_angle: f64,
    /// Between neighbouring points of a keyframe the space is taken to be seen through as well, where the
    /// angles between them are at most this, in radians. Such triangles count as witnesses, not against
    /// hits. 0 carves rays only. 0 to 1. Default 0.5 (29 degrees), with `max_gap` to bound what such a triangle can miss.
    pub max_triangle_angle: f64,
    /// A voxel is proven only if one ray at least passed through it, or one triangle whose corners' sight lines are at most this far apart
    /// there. More than 0. Default 0.4 m: a drone and the end of a wall fit between no such lines. Wider triangles from all along a
    /// line took the blank end of a wall that was seen end-on, with points on both sides of it, for seen through.
    pub max_gap: f64,
    /// Largest ratio of the depths of such points: a jump is the edge of something. At least 1. Default
    /// 1.25: at 1.5 a triangle from the last points of a wall to what lies behind its end took the end for seen
    /// through, and a simulated path crossed the wall there.
    pub max_depth_ratio: f64,
    /// Log-odds that a ray's end adds to its voxel for being occupied. At least 0. Default 0.85, as OctoMap
    /// (probability 0.7).
    pub hit_log_odds: f64,
    /// Log-odds that each crossing ray takes from a voxel. More than 0. Default 0.4, as OctoMap
    /// (probability 0.4).
    pub miss_log_odds: f64,
    /// A voxel is free only where its log-odds are at most this. Default 0: as many rays must have gone
    /// through as their weight against the ends needs, so few wrong rays cannot open a seen surface.
    pub free_log_odds: f64,
    /// A point is contradicted where its voxel is free and its log-odds are at most minus this. At least 0.
    /// Default 32: eighty more crossing rays than its hits need. With 8, rays that graze thin furniture and
    /// walls took true points off them: in thirty simulated apartments 10 of 1,329 planned paths crossed
    /// something solid, with 32 it were 2 of 1,311. See
    /// [`FreeSpace::contradicts`](crate::FreeSpace::contradicts). Rays to a point whose voxel has as little evidence prove nothing
    /// either, unless all points are trusted.
    pub contradiction_log_odds: f64,
    /// A point proves nothing if more than this share of its own rays pass through something solid: its keyframes cannot have seen
    /// it there. 0 to 1. Default 0.5. 1 trusts all points, contradicted ones too: for maps that drift, in which a wall that
    /// is seen again from elsewhere stands in the way of its own points.
    pub max_blocked_share: f64,
    /// Most voxels that the grid may hold; each costs 41 bytes. At least 1. Default 8 million (330 MB).
    pub max_voxels: usize,
}

impl Default for FreeSpaceConfig {
    fn default() -> Self {
        FreeSpaceConfig {
            resolution: 0.1,
            range_margin: 0.1,
            max_range: 8.0,
            min_keyframes: 2,
            clearance: 0.22,
            patch_half_angle: 0.0,
            max_triangle_angle: 0.5,
            max_gap: 0.4,
            max_depth_ratio: 1.25,
            hit_log_odds: 0.85,
            miss_log_odds: 0.4,
            free_log_odds: 0.0,
            contradiction_log_odds: 32.0,
            max_blocked_share: 0.5,
            max_voxels: 8_000_000,
        }
    }
}

impl FreeSpaceConfig {
    /// The same settings for a map in which a metre measures `units_per_metre`.
    #[must_use]
    pub fn scaled(mut self, units_per_metre: f64) -> Self {
        self.resolution *= units_per_metre;
        self.max_range *= units_per_metre;
        self.clearance *= units_per_metre;
        self.max_gap *= units_per_metre;
        self
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// The first field that is out of range, with its value.
    pub fn validate(&self) -> Result<(), FreeSpaceError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let not_negative = |value: f64| value >= 0.0 && value.is_finite();
        let check = |name, value, ok, range| {
            let error = FreeSpaceError::OutOfRange { name, value, range };
            if ok { Ok(()) } else { Err(error) }
        };
        let value = self.resolution;
        check("resolution", value, positive(value), "above 0")?;
        let value = self.range_margin;
        let ok = (0.0..1.0).contains(&value);
        check("range_margin", value, ok, "from 0 to below 1")?;
        let value = self.max_range;
        check("max_range", value, positive(value), "above 0")?;
        let ok = (1..=4).contains(&self.min_keyframes);
        check(
            "min_keyframes",
            self.min_keyframes as f64,
            ok,
            "from 1 to 4",
        )?;
        let value = self.clearance;
        check("clearance", value, not_negative(value), "at least 0")?;
        let value = self.patch_half_angle;
        let ok = (0.0..0.2).contains(&value);
        check("patch_half_angle", value, ok, "from 0 to below 0.2")?;
        let value = self.max_triangle_angle;
        let ok = (0.0..=1.0).contains(&value);
        check("max_triangle_angle", value, ok, "from 0 to 1")?;
        let value = self.max_gap;
        check("max_gap", value, value > 0.0, "above 0")?;
        let value = self.max_depth_ratio;
        check("max_depth_ratio", value, value >= 1.0, "at least 1")?;
        let value = self.hit_log_odds;
        check("hit_log_odds", value, not_negative(value), "at least 0")?;
        let value = self.miss_log_odds;
        check("miss_log_odds", value, positive(value), "above 0")?;
        let value = self.free_log_odds;
        check("free_log_odds", value, value.is_finite(), "finite")?;
        let value = self.contradiction_log_odds;
        check("contradiction_log_odds", value, value >= 0.0, "at least 0")?;
        let value = self.max_blocked_share;
        let ok = (0.0..=1.0).contains(&value);
        check("max_blocked_share", value, ok, "from 0 to 1")?;
        let ok = self.max_voxels > 0;
        check("max_voxels", self.max_voxels as f64, ok, "at least 1")
    }

    /// The end of a ray, or the place on it at `max_range` where that is nearer.
    pub(super) fn reach(&self, ray: &Ray) -> [f64; 3] {
        let length = distance(ray.origin, ray.end);
        if length <= self.max_range {
            ray.end
        } else {
            lerp(ray.origin, ray.end, self.max_range / length)
        }
    }

    /// How much of a ray of this length is carved.
    pub(super) fn carved_length(&self, length: f64) -> f64 {
        (length * (1.0 - self.range_margin)).min(self.max_range)
    }
}
