//! The map as others see it: in the first keyframe's camera frame, in units of arbitrary length.

use nalgebra::{Isometry3, Point3, Translation3, Vector3};
use slam_bridge::{KeyFrame, KeyFrameId, Map, MapPoint, PointId, Scale};

use super::SyntheticSlam;

impl SyntheticSlam {
    /// A snapshot of the map.
    pub(super) fn export(&self) -> Map {
        let Some(first) = self.mapping.frames.first() else {
            return Map {
                epoch: self.epoch,
                frustum: Some(self.camera.frustum()),
                ..Map::default()
            };
        };
        let map_from_space = first.estimate.inverse();
        let kept = self.mapping.points.iter().filter(|point| point.kept);
        let points = kept.map(|point| MapPoint {
            id: PointId(point.id),
            position: self.scaled(map_from_space * Point3::from(point.estimate)),
            viewing_direction: point
                .information
                .viewing_direction()
                .map(|direction| map_from_space.rotation * direction),
            max_distance: None,
            observers: point.observers.clone(),
        });
        let keyframes = self
            .mapping
            .frames
            .iter()
            .enumerate()
            .filter(|(_, frame)| frame.kept)
            .map(|(number, frame)| KeyFrame {
                id: KeyFrameId(number as u64),
                time: Some(frame.time),
                world_from_camera: self.in_map(&map_from_space, &frame.estimate),
            });
        Map {
            epoch: self.epoch,
            scale: Scale::Unknown,
            points: points.collect(),
            keyframes: keyframes.collect(),
            frustum: Some(self.camera.frustum()),
        }
    }

    fn scaled(&self, point: Point3<f64>) -> Point3<f64> {
        Point3::from(point.coords * self.units)
    }

    /// A pose of the drifted space, metres, in the map's frame and units.
    pub(super) fn in_map(
        &self,
        map_from_space: &Isometry3<f64>,
        pose: &Isometry3<f64>,
    ) -> Isometry3<f64> {
        let moved = map_from_space * pose;
        let place: Vector3<f64> = moved.translation.vector * self.units;
        Isometry3::from_parts(Translation3::from(place), moved.rotation)
    }
}
