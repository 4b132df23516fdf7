//! What a map tells the search for exits: kept points, those that a cleaning took out, who saw which, and where the camera looked.
//!
//! Missions, `explorer exits` and `explorer map` ask in this one way. The two commands hand over what the cleaning took out as doubtful: far
//! points behind a door are sparse and go first. Missions hand over the kept points alone. Everything is in map units. Cost: O(observations · log keyframes).

use std::collections::BTreeSet;

use exit_finder::{
    AffinePlane, ExitConfig, ExitError, ExitReport, ExitView, Gaze, Ray, find_exits,
};
use nalgebra::{Point3, Vector3};
use slam_bridge::{KeyFrame, KeyFrameId, Map};

/// Exits around a place, and the points among which they were found.
#[derive(Debug, Clone, PartialEq)]
pub struct ExitSearch {
    /// The exits.
    pub report: ExitReport,
    /// The kept ones, map units.
    pub cloud: Vec<[f64; 3]>,
}

/// Who looks for exits.
#[derive(Debug, Clone, Copy)]
pub struct ExitSeeker<'a> {
    /// Through the agent, parallel to the ground.
    pub plane: &'a AffinePlane,
    /// The agent, map units.
    pub position: [f64; 3],
    /// Where its nose points; `None`: unknown.
    pub heading: Option<[f64; 3]>,
    /// Points that stand in openings which have been used.
    pub closed: &'a [[f64; 3]],
}

/// Points of a cleaned map, by how they are to be taken, and who saw them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ExitCloud {
    /// What the cleaning kept.
    pub kept: Vec<[f64; 3]>,
    /// What it took out.
    pub doubtful: Vec<[f64; 3]>,
    /// From a keyframe to one of either, those to one point in a row.
    pub rays: Vec<Ray>,
}

impl ExitCloud {
    /// All points with these indices; indices that the map does not have are left out.
    #[must_use]
    pub fn of(map: &Map, kept: &[usize], removed: &[usize]) -> Self {
        Self::seen_by(map, kept, removed, |_| true, false)
    }

    /// Those of them that keyframes within `near` of `place` saw, and only their rays: points of other rooms, seen from there, lie
    /// behind walls like those seen through a door.
    #[must_use]
    pub fn seen_about(
        map: &Map,
        kept: &[usize],
        removed: &[usize],
        place: &Point3<f64>,
        near: f64,
    ) -> Self {
        let is_near = |keyframe: &&KeyFrame| (keyframe.center() - place).norm() < near;
        let about = map.keyframes.iter().filter(is_near);
        let about: BTreeSet<KeyFrameId> = about.map(|keyframe| keyframe.id).collect();
        Self::seen_by(map, kept, removed, |id| about.contains(&id), true)
    }

    /// The points alone.
    #[must_use]
    pub fn without_rays(self) -> Self {
        Self {
            rays: Vec::new(),
            ..self
        }
    }

    /// `seen`: without those that no such keyframe saw.
    fn seen_by(
        map: &Map,
        kept: &[usize],
        removed: &[usize],
        counts: impl Fn(KeyFrameId) -> bool,
        seen: bool,
    ) -> Self {
        let mut cloud = Self::default();
        for (indices, is_kept) in [(kept, true), (removed, false)] {
            for point in indices.iter().filter_map(|&index| map.points.get(index)) {
                let end = point.position.into();
                let observers = point.observers.iter().filter(|&&id| counts(id));
                let keyframes = observers.filter_map(|&id| map.keyframe(id));
                let rays_before = cloud.rays.len();
                cloud.rays.extend(keyframes.map(|keyframe| Ray {
                    origin: keyframe.center().into(),
                    end,
                }));
                if seen && cloud.rays.len() == rays_before {
                    continue;
                }
                let list = if is_kept {
                    &mut cloud.kept
                } else {
                    &mut cloud.doubtful
                };
                list.push(end);
            }
        }
        cloud
    }

    /// Looks for exits among these points of `map`, which tells where the camera looked.
    ///
    /// # Errors
    /// Too few points, or a config out of range.
    pub fn exits(
        &self,
        map: &Map,
        seeker: &ExitSeeker<'_>,
        config: &ExitConfig,
    ) -> Result<ExitReport, ExitError> {
        let gazes = gazes(map);
        let view = ExitView {
            heading: seeker.heading,
            gazes: &gazes,
            virtual_points: seeker.closed,
            doubtful: &self.doubtful,
            rays: &self.rays,
        };
        find_exits(&self.kept, seeker.position, seeker.plane, &view, config)
    }
}

/// Where the keyframes looked; none for a map that does not know the camera's field of view.
fn gazes(map: &Map) -> Vec<Gaze> {
    let Some(frustum) = map.frustum else {
        return Vec::new();
    };
    let gaze = |keyframe: &KeyFrame| Gaze {
        position: keyframe.center().into(),
        forward: Vector3::from(keyframe.forward()).into(),
        half_fov_rad: frustum.half_horizontal,
    };
    map.keyframes.iter().map(gaze).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use slam_bridge::nalgebra::Isometry3;

    fn map() -> Map {
        let mut map = Map::from_positions([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]);
        map.keyframes = [0, 5].map(keyframe).to_vec();
        map.points[0].observers = [0, 5, 8].map(KeyFrameId).to_vec();
        map.points[1].observers = vec![KeyFrameId(5)];
        map.points[2].observers = vec![KeyFrameId(0)];
        map
    }

    fn keyframe(id: u64) -> KeyFrame {
        KeyFrame {
            id: KeyFrameId(id),
            time: None,
            world_from_camera: Isometry3::translation(id as f64, 0.0, 0.0),
        }
    }

    #[test]
    fn only_what_near_keyframes_saw_counts_and_removed_points_are_doubtful() {
        let near = ExitCloud::seen_about(&map(), &[0, 1, 7], &[2], &Point3::origin(), 1.0);
        assert_eq!(near.kept, [[1.0, 0.0, 0.0]]);
        assert_eq!(near.doubtful, [[3.0, 0.0, 0.0]]);
        let from: Vec<[f64; 3]> = near.rays.iter().map(|ray| ray.origin).collect();
        assert_eq!(from, [[0.0; 3], [0.0; 3]]);
        let all = ExitCloud::of(&map(), &[0, 1], &[2]);
        assert_eq!((all.kept.len(), all.doubtful.len()), (2, 1));
        assert_eq!(all.rays.len(), 4);
    }

    #[test]
    fn a_map_without_observations_gives_its_points_and_no_rays() {
        let map = Map::from_positions([[1.0, 0.0, 0.0]; 4]);
        let all = ExitCloud::of(&map, &[0, 1], &[3]);
        assert_eq!((all.kept.len(), all.doubtful.len()), (2, 1));
        assert!(all.rays.is_empty());
        let near = ExitCloud::seen_about(&map, &[0, 1], &[3], &Point3::origin(), 9.0);
        assert_eq!(near, ExitCloud::default());
    }
}
