//! The map that keyframes leave behind, in the form that every SLAM source gives.

use slam_bridge::{KeyFrame, KeyFrameId, Map, MapPoint, PointId, Scale};

use super::keyframe::Keyframe;

/// Points and keyframes of the present epoch.
#[derive(Debug, Clone, Default)]
pub(super) struct MapBuilder {
    map: Map,
}

impl MapBuilder {
    pub(super) fn map(&self) -> &Map {
        &self.map
    }

    /// Forgets everything: coordinates before and after have nothing in common.
    pub(super) fn begin_epoch(&mut self) {
        self.map = Map {
            epoch: self.map.epoch + 1,
            ..Map::default()
        };
    }

    /// Adds a keyframe, its new points, and itself as an observer of the old ones.
    pub(super) fn add(&mut self, keyframe: &mut Keyframe, time: f64, is_metric: bool) {
        self.map.scale = if is_metric {
            Scale::MetersPerUnit(1.0)
        } else {
            Scale::Unknown
        };
        let id = KeyFrameId(self.map.keyframes.len() as u64);
        let world_from_camera = keyframe.world_from_camera;
        self.map.keyframes.push(KeyFrame {
            id,
            time: Some(time),
            world_from_camera,
        });
        self.add_points(keyframe, id);
    }

    /// Adds the points of the newest keyframe that were triangulated after it was added.
    pub(super) fn complete(&mut self, keyframe: &mut Keyframe) {
        if let Some(id) = self.map.keyframes.last().map(|keyframe| keyframe.id) {
            self.add_points(keyframe, id);
        }
    }

    fn add_points(&mut self, keyframe: &mut Keyframe, id: KeyFrameId) {
        for (point, slot) in keyframe.sight.points.iter().zip(&mut keyframe.in_map) {
            let Some(point) = point else { continue };
            if let Some(known) = slot.and_then(|index| self.map.points.get_mut(index)) {
                if known.observers == [id] {
                    // It may have been triangulated again from farther aside.
                    known.position = keyframe.world_from_camera * point;
                } else if known.observers.last() != Some(&id) {
                    known.observers.push(id);
                }
                continue;
            }
            *slot = Some(self.map.points.len());
            let position = keyframe.world_from_camera * point;
            let centre = keyframe.world_from_camera.translation.vector;
            self.map.points.push(MapPoint {
                id: PointId(self.map.points.len() as u64),
                position,
                viewing_direction: (position.coords - centre).try_normalize(1e-12),
                max_distance: None,
                observers: vec![id],
            });
        }
    }
}
