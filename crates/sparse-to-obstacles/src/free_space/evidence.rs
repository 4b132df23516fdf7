//! What is known about a voxel: which keyframes saw through it, and the rays for and against it.

use super::config::FreeSpaceConfig;
use super::error::FreeSpaceError;
use super::ray::Ray;
use std::collections::BTreeMap;

/// The number of a keyframe, from 1.
pub(super) type KeyframeId = u16;

const NOBODY: KeyframeId = 0;
const PRESENCE: KeyframeId = KeyframeId::MAX;

/// Evidence about one voxel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Evidence {
    /// The first keyframes that saw through, each once. A presence fills all.
    witnesses: [KeyframeId; 4],
    crossed: u16,
    ended: u16,
    /// The last ray that was counted.
    last_ray: u32,
}

impl Evidence {
    /// Counts a crossing ray, once however often it is reported in a row.
    #[inline]
    pub(super) fn cross(&mut self, keyframe: KeyframeId, ray: u32) {
        if self.last_ray == ray {
            return;
        }
        self.last_ray = ray;
        self.crossed = self.crossed.saturating_add(1);
        self.witness(keyframe);
    }

    /// Remembers a keyframe that saw through.
    #[inline]
    pub(super) fn witness(&mut self, keyframe: KeyframeId) {
        for witness in &mut self.witnesses {
            if *witness == NOBODY {
                *witness = keyframe;
            }
            if *witness == keyframe {
                return;
            }
        }
    }

    pub(super) fn end(&mut self) {
        self.ended = self.ended.saturating_add(1);
    }

    pub(super) fn prove_by_presence(&mut self) {
        self.witnesses = [PRESENCE; 4];
    }

    pub(super) fn is_free(&self, config: &FreeSpaceConfig) -> bool {
        let needed = config.min_keyframes.clamp(1, self.witnesses.len());
        let seen = self.witnesses[needed - 1] != NOBODY;
        let present = self.witnesses[0] == PRESENCE;
        seen && (present || self.log_odds(config) <= config.free_log_odds)
    }

    /// Log-odds of being occupied.
    pub(super) fn log_odds(&self, config: &FreeSpaceConfig) -> f64 {
        f64::from(self.ended) * config.hit_log_odds - f64::from(self.crossed) * config.miss_log_odds
    }
}

/// The keyframes met so far, told apart by their positions.
#[derive(Clone, Debug, Default)]
pub(super) struct Keyframes {
    ids: BTreeMap<[u64; 3], KeyframeId>,
}

impl Keyframes {
    pub(super) fn len(&self) -> usize {
        self.ids.len()
    }

    /// The keyframe of each ray, new ones numbered in the order of the rays.
    pub(super) fn identify(&mut self, rays: &[Ray]) -> Result<Vec<KeyframeId>, FreeSpaceError> {
        let mut last: Option<([u64; 3], KeyframeId)> = None;
        let mut ids = Vec::with_capacity(rays.len());
        for ray in rays {
            // Adding 0 makes -0 and 0 the same place.
            let key = ray.origin.map(|c| (c + 0.0).to_bits());
            let id = match last {
                Some((former, id)) if former == key => id,
                _ => {
                    let next = self.ids.len() + 1;
                    if next >= usize::from(PRESENCE) && !self.ids.contains_key(&key) {
                        let max = usize::from(PRESENCE) - 1;
                        return Err(FreeSpaceError::TooManyKeyframes { max });
                    }
                    *self.ids.entry(key).or_insert(next as KeyframeId)
                }
            };
            last = Some((key, id));
            ids.push(id);
        }
        Ok(ids)
    }
}

/// The rays of each keyframe, in their order.
pub(super) fn by_keyframe(
    rays: &[Ray],
    ids: &[KeyframeId],
) -> impl Iterator<Item = (KeyframeId, Vec<Ray>)> {
    let mut groups: BTreeMap<KeyframeId, Vec<Ray>> = BTreeMap::new();
    for (ray, &id) in rays.iter().zip(ids) {
        groups.entry(id).or_default().push(*ray);
    }
    groups.into_iter()
}
