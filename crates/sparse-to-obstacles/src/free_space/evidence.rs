//! What is known about a voxel: which keyframes saw through it, and the rays for and against it.

use super::config::FreeSpaceConfig;
use super::ray::Ray;
use crate::vector::Vec3;
use std::collections::{BTreeMap, HashMap};

/// The number of a keyframe, from 1.
pub(super) type KeyframeId = u16;
/// The number of a point that rays end at, from 1.
pub(super) type PointId = u32;

const NOBODY: KeyframeId = 0;
/// No point.
const NO_POINT: PointId = 0;
const PRESENCE: KeyframeId = KeyframeId::MAX;

/// Evidence about one voxel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Evidence {
    /// The first keyframes that saw through, each once. A presence fills all.
    witnesses: [KeyframeId; 4],
    /// The points that all sightings have in common: of a ray its end, of a triangle its corners.
    shared: [PointId; 3],
    crossed: u16,
    ended: u16,
    /// The last ray that was counted.
    last_ray: u32,
    /// Did a ray pass, or a triangle that is narrow here?
    closely_seen: bool,
}

impl Evidence {
    /// Counts a crossing ray, once however often it is reported in a row.
    #[inline]
    pub(super) fn cross(&mut self, ray: u32) {
        if self.last_ray != ray {
            self.last_ray = ray;
            self.crossed = self.crossed.saturating_add(1);
        }
    }

    /// Remembers a keyframe that saw through, if these points are where the map has them; closely along a ray, or between rays that are
    /// near to each other here.
    #[inline]
    pub(super) fn witness(&mut self, keyframe: KeyframeId, points: [PointId; 3], closely: bool) {
        self.closely_seen |= closely;
        if self.witnesses[0] == NOBODY {
            self.shared = points;
        } else if self.shared != [NO_POINT; 3] {
            for point in &mut self.shared {
                if !points.contains(point) {
                    *point = NO_POINT;
                }
            }
        }
        remember(&mut self.witnesses, keyframe);
    }

    pub(super) fn end(&mut self) {
        self.ended = self.ended.saturating_add(1);
    }

    pub(super) fn prove_by_presence(&mut self) {
        self.witnesses = [PRESENCE; 4];
    }

    pub(super) fn is_free(&self, config: &FreeSpaceConfig) -> bool {
        if self.witnesses[0] == PRESENCE {
            return true;
        }
        let last = config.min_keyframes.clamp(1, self.witnesses.len()) - 1;
        // One wrong point, on which several keyframes agree, is at the end of a pencil of rays and a corner of many triangles:
        // together they open a window in whatever stands before it.
        let corroborated = last == 0 || self.shared == [NO_POINT; 3];
        let seen = corroborated && self.witnesses[last] != NOBODY;
        // Wide triangles alone miss what stands between their corners.
        seen && self.closely_seen && !self.is_occupied(config)
    }

    /// Did more rays end here than pass?
    #[inline]
    pub(super) fn is_occupied(&self, config: &FreeSpaceConfig) -> bool {
        self.log_odds(config) > config.free_log_odds
    }

    /// Did so many more pass than end that there can be no point here?
    pub(super) fn is_contradicted(&self, config: &FreeSpaceConfig) -> bool {
        self.log_odds(config) <= -config.contradiction_log_odds
    }

    /// Log-odds of being occupied.
    pub(super) fn log_odds(&self, config: &FreeSpaceConfig) -> f64 {
        f64::from(self.ended) * config.hit_log_odds - f64::from(self.crossed) * config.miss_log_odds
    }
}

/// Adds a keyframe to a list that holds each once, if there is room.
#[inline]
fn remember(list: &mut [KeyframeId; 4], keyframe: KeyframeId) {
    for known in list {
        if *known == NOBODY {
            *known = keyframe;
        }
        if *known == keyframe {
            return;
        }
    }
}

/// The keyframes or points met so far, told apart by their positions.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    numbers: HashMap<[u64; 3], u32>,
}

impl Known {
    pub(super) fn len(&self) -> usize {
        self.numbers.len()
    }

    /// The number of each place, from 1, new ones in their order.
    pub(super) fn number(&mut self, places: impl Iterator<Item = Vec3>) -> Vec<u32> {
        let mut last: Option<([u64; 3], u32)> = None;
        let number = |place: Vec3| {
            // Adding 0 makes -0 and 0 the same place.
            let key = place.map(|c| (c + 0.0).to_bits());
            let number = match last {
                Some((former, number)) if former == key => number,
                _ => {
                    let next = self.numbers.len() as u32 + 1;
                    *self.numbers.entry(key).or_insert(next)
                }
            };
            last = Some((key, number));
            number
        };
        places.map(number).collect()
    }
}

/// A ray and the point that it ends at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sighting {
    pub(super) ray: Ray,
    pub(super) point: PointId,
}

impl Sighting {
    /// Its point, as the corners of a triangle are given.
    pub(super) fn alone(&self) -> [PointId; 3] {
        [self.point, NO_POINT, NO_POINT]
    }
}

/// The rays of each keyframe, by their direction.
pub(super) fn by_keyframe(
    rays: &[Ray],
    keyframes: &[u32],
    points: &[PointId],
) -> Vec<(KeyframeId, Vec<Sighting>)> {
    let mut groups: BTreeMap<KeyframeId, Vec<Sighting>> = BTreeMap::new();
    for ((&ray, &keyframe), &point) in rays.iter().zip(keyframes).zip(points) {
        let group = groups.entry(keyframe as KeyframeId).or_default();
        group.push(Sighting { ray, point });
    }
    // Rays in similar directions cross the same voxels while they are at hand.
    for sightings in groups.values_mut() {
        sightings.sort_by_cached_key(|sighting| sighting.ray.sector());
    }
    groups.into_iter().collect()
}

/// Most keyframes that can be told apart.
pub(super) const MOST_KEYFRAMES: usize = PRESENCE as usize - 1;
