//! A sparse map: points, keyframes, which keyframe saw which point, and what a map unit is worth.

use nalgebra::{Isometry3, Point3, Similarity3, Vector3};

/// Identity of a map point, stable while its map's [`Map::epoch`] stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PointId(pub u64);

/// Identity of a keyframe, stable while its map's [`Map::epoch`] stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct KeyFrameId(pub u64);

/// One triangulated landmark, in map units and the map's world frame.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPoint {
    /// Who this is.
    pub id: PointId,
    /// Where it is, map units.
    pub position: Point3<f64>,
    /// Mean viewing direction, from the cameras to the point, unit length, where the source gives it.
    pub viewing_direction: Option<Vector3<f64>>,
    /// The largest distance from which its image feature can be recognised, map units, above 0, where the source gives
    /// it (`max_distance` of ORB-SLAM). Over the viewing distance it tells how coarse the feature is.
    pub max_distance: Option<f64>,
    /// The keyframes that observe it, ascending; empty when the source tells no observations.
    pub observers: Vec<KeyFrameId>,
}

/// One keyframe: a camera pose that the map keeps.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyFrame {
    /// Who this is.
    pub id: KeyFrameId,
    /// When its image was taken, seconds of the source's clock, where known.
    pub time: Option<f64>,
    /// Camera-to-world: takes camera coordinates (x right, y down, z forward) to the map's frame.
    pub world_from_camera: Isometry3<f64>,
}

impl KeyFrame {
    /// The optical centre in the map's frame, map units.
    #[must_use]
    pub fn center(&self) -> Point3<f64> {
        Point3::from(self.world_from_camera.translation.vector)
    }

    /// The optical axis in the map's frame, unit length.
    #[must_use]
    pub fn forward(&self) -> Vector3<f64> {
        self.world_from_camera.rotation * Vector3::z()
    }
}

/// What one map unit is in metres.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Scale {
    /// A monocular map whose unit nobody has measured yet.
    #[default]
    Unknown,
    /// Metres per map unit, finite and positive.
    MetersPerUnit(f64),
}

impl Scale {
    /// Metres per map unit, if known.
    #[must_use]
    pub fn meters_per_unit(self) -> Option<f64> {
        match self {
            Self::Unknown => None,
            Self::MetersPerUnit(meters) => Some(meters),
        }
    }
}

/// Half opening angles of a pinhole camera, radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frustum {
    /// Half of the horizontal field of view, radians.
    pub half_horizontal: f64,
    /// Half of the vertical field of view, radians.
    pub half_vertical: f64,
}

/// A whole map at one moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// Counts resets, merges and re-initialisations: a new epoch voids all former coordinates.
    pub epoch: u64,
    /// What a map unit is in metres.
    pub scale: Scale,
    /// The points, each id once; from a file in the file's order, else ascending by id.
    pub points: Vec<MapPoint>,
    /// The keyframes, ascending by id; empty when the source tells none.
    pub keyframes: Vec<KeyFrame>,
    /// The camera's field of view, where known: tells what no keyframe looked at.
    pub frustum: Option<Frustum>,
}

impl Map {
    /// A map of bare points, with ids from 0 in the order given.
    #[must_use]
    pub fn from_positions(positions: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let points = positions
            .into_iter()
            .zip(0..)
            .map(|(position, id)| MapPoint {
                id: PointId(id),
                position: position.into(),
                viewing_direction: None,
                max_distance: None,
                observers: Vec::new(),
            });
        Self {
            points: points.collect(),
            ..Self::default()
        }
    }

    /// The same map with only the points at these places in [`Map::points`]; places beyond the end
    /// are ignored.
    #[must_use]
    pub fn with_points_at(&self, indices: &[usize]) -> Self {
        let points = indices
            .iter()
            .filter_map(|&index| self.points.get(index).cloned())
            .collect();
        Self {
            points,
            keyframes: self.keyframes.clone(),
            ..Self {
                points: Vec::new(),
                keyframes: Vec::new(),
                ..*self
            }
        }
    }

    /// Positions of all points, in order, map units.
    #[must_use]
    pub fn positions(&self) -> Vec<[f64; 3]> {
        self.points
            .iter()
            .map(|point| point.position.into())
            .collect()
    }

    /// Whether any point names a keyframe that sees it.
    #[must_use]
    pub fn has_observations(&self) -> bool {
        !self.keyframes.is_empty() && self.points.iter().any(|point| !point.observers.is_empty())
    }

    /// Where in [`Map::keyframes`] the keyframe with this id is. Cost: a binary search.
    #[must_use]
    pub fn keyframe_index(&self, id: KeyFrameId) -> Option<usize> {
        self.keyframes
            .binary_search_by_key(&id, |keyframe| keyframe.id)
            .ok()
    }

    /// The keyframe with this id. Cost: a binary search.
    #[must_use]
    pub fn keyframe(&self, id: KeyFrameId) -> Option<&KeyFrame> {
        self.keyframes.get(self.keyframe_index(id)?)
    }

    /// Takes everything in the map to another frame and unit: points, viewing directions, recognition distances,
    /// keyframes. A known [`Map::scale`] follows, so that lengths in metres stay what they were; the epoch stays.
    /// Cost: O(points + keyframes).
    ///
    /// ```
    /// use slam_bridge::{Map, Scale, nalgebra::Similarity3};
    /// let mut map = Map::from_positions([[1.0, 0.0, 0.0]]);
    /// map.scale = Scale::MetersPerUnit(2.0);
    /// map.transform(&Similarity3::from_scaling(2.0)); // to metres
    /// assert_eq!(map.positions(), [[2.0, 0.0, 0.0]]);
    /// assert_eq!(map.scale, Scale::MetersPerUnit(1.0));
    /// ```
    pub fn transform(&mut self, to: &Similarity3<f64>) {
        let rotation = to.isometry.rotation;
        for point in &mut self.points {
            point.position = to * point.position;
            point.viewing_direction = point.viewing_direction.map(|way| rotation * way);
            point.max_distance = point.max_distance.map(|length| to.scaling() * length);
        }
        for keyframe in &mut self.keyframes {
            let center = to * keyframe.center();
            let orientation = rotation * keyframe.world_from_camera.rotation;
            keyframe.world_from_camera = Isometry3::from_parts(center.coords.into(), orientation);
        }
        if let Scale::MetersPerUnit(meters) = &mut self.scale {
            *meters /= to.scaling();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transform_takes_along_all_that_has_a_place_or_a_length() {
        let mut map = Map::from_positions([[1.0, 2.0, 3.0]]);
        map.points[0].viewing_direction = Some(Vector3::x());
        map.points[0].max_distance = Some(5.0);
        let pose = Isometry3::new(Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.4, 0.0, 0.2));
        map.keyframes = vec![KeyFrame {
            id: KeyFrameId(7),
            time: None,
            world_from_camera: pose,
        }];
        let in_camera = pose.inverse() * map.points[0].position;
        let half_turn = Vector3::z() * std::f64::consts::PI;
        map.transform(&Similarity3::new(Vector3::x(), half_turn, 3.0));
        let (point, keyframe) = (&map.points[0], &map.keyframes[0]);
        assert!((point.position - Point3::new(-2.0, -6.0, 9.0)).norm() < 1e-12);
        assert!((point.viewing_direction.unwrap() + Vector3::x()).norm() < 1e-12);
        assert_eq!(point.max_distance, Some(15.0));
        let seen = keyframe.world_from_camera.inverse() * point.position;
        assert!((seen.coords - in_camera.coords * 3.0).norm() < 1e-12);
        assert_eq!(map.scale, Scale::Unknown);
        assert_eq!(map.keyframe_index(KeyFrameId(7)), Some(0));
        assert_eq!(map.keyframe_index(KeyFrameId(0)), None);
    }
}
