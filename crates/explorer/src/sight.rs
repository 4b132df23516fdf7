//! How many map points the camera would see from a pose: where tracking will hold.
//!
//! Input:  map points with their observing keyframes, a camera's field of view. Output: a count for any level pose.
//! Method: ORB-SLAM's own test for the points it searches in a frame: inside the frustum, not more than 60 degrees off the mean direction
//!         from which the point was seen before, and at a distance between half the nearest and twice the farthest so far.
//! Cost:   O(points) a pose.
//! Degenerate input: points without observers are not counted, they cannot be matched from anywhere known.

use nalgebra::{Point3, Vector3};
use slam_bridge::{Frustum, Map};

/// Field of view taken when the map tells none: a Tello's, from its published calibrations (54 to 55 by 42 to 43 degrees).
const TELLO: Frustum = Frustum {
    half_horizontal: 0.48,
    half_vertical: 0.37,
};

/// Largest change of direction at which a feature is still matched: cos 60 degrees (ORB-SLAM).
const LEAST_COSINE: f64 = 0.5;

/// Which map points can be seen from where.
#[derive(Debug, Clone, PartialEq)]
pub struct Sight {
    frustum: Frustum,
    landmarks: Vec<Landmark>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Landmark {
    position: Point3<f64>,
    /// Mean unit vector from the cameras to the point.
    direction: Vector3<f64>,
    nearest: f64,
    farthest: f64,
}

impl Sight {
    /// Collects the points of `map` with the indices `kept`.
    #[must_use]
    pub fn new(map: &Map, kept: &[usize]) -> Self {
        let points = kept.iter().filter_map(|&index| map.points.get(index));
        let landmarks = points.filter_map(|point| {
            let centers = point
                .observers
                .iter()
                .filter_map(|&id| Some(map.keyframe(id)?.center()));
            landmark(point.position, centers)
        });
        Self {
            frustum: map.frustum.unwrap_or(TELLO),
            landmarks: landmarks.collect(),
        }
    }

    /// How many points a camera at `position` sees that looks along `forward` (unit, level) with `up` above it.
    #[must_use]
    pub fn expected(
        &self,
        position: &Point3<f64>,
        forward: &Vector3<f64>,
        up: &Vector3<f64>,
    ) -> usize {
        let left = up.cross(forward);
        let (wide, high) = (
            self.frustum.half_horizontal.tan(),
            self.frustum.half_vertical.tan(),
        );
        self.landmarks
            .iter()
            .filter(|landmark| {
                let ray = landmark.position - position;
                let depth = ray.dot(forward);
                let range = ray.norm();
                depth > 0.0
                    && ray.dot(&left).abs() <= depth * wide
                    && ray.dot(up).abs() <= depth * high
                    && (0.5 * landmark.nearest..=2.0 * landmark.farthest).contains(&range)
                    && ray.dot(&landmark.direction) >= LEAST_COSINE * range
            })
            .count()
    }
}

fn landmark(position: Point3<f64>, centers: impl Iterator<Item = Point3<f64>>) -> Option<Landmark> {
    let mut direction = Vector3::zeros();
    let (mut nearest, mut farthest) = (f64::INFINITY, 0.0_f64);
    for center in centers {
        let ray = position - center;
        let range = ray.norm();
        direction += ray.try_normalize(f64::EPSILON)?;
        nearest = nearest.min(range);
        farthest = farthest.max(range);
    }
    Some(Landmark {
        position,
        direction: direction.try_normalize(f64::EPSILON)?,
        nearest,
        farthest,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Isometry3, Translation3};
    use slam_bridge::{KeyFrame, KeyFrameId, MapPoint, PointId};

    fn map() -> Map {
        let keyframe = |id: u64, x: f64| KeyFrame {
            id: KeyFrameId(id),
            time: None,
            world_from_camera: Isometry3::from_parts(
                Translation3::new(x, 0.0, 0.0),
                nalgebra::UnitQuaternion::identity(),
            ),
        };
        let point = |id: u64, x: f64| MapPoint {
            id: PointId(id),
            position: Point3::new(x, 0.0, 4.0),
            viewing_direction: None,
            max_distance: None,
            observers: vec![KeyFrameId(0), KeyFrameId(1)],
        };
        Map {
            points: vec![point(0, -0.5), point(1, 0.0), point(2, 9.0)],
            keyframes: vec![keyframe(0, -0.1), keyframe(1, 0.1)],
            ..Map::default()
        }
    }

    #[test]
    fn counts_what_lies_ahead_and_was_seen_from_a_like_direction() {
        let sight = Sight::new(&map(), &[0, 1, 2]);
        let up = Vector3::new(0.0, -1.0, 0.0);
        let count = |x: f64, y: f64, z: f64, forward: Vector3<f64>| {
            sight.expected(&Point3::new(x, y, z), &forward, &up)
        };
        assert_eq!(count(0.0, 0.0, 0.0, Vector3::z()), 2);
        assert_eq!(count(0.0, 0.0, 0.0, -Vector3::z()), 0);
        // From behind the wall, from much too near and from much too far nothing matches.
        assert_eq!(count(0.0, 0.0, 8.0, -Vector3::z()), 0);
        assert_eq!(count(0.0, 0.0, 3.0, Vector3::z()), 0);
        assert_eq!(count(0.0, 0.0, -9.0, Vector3::z()), 0);
    }

    #[test]
    fn points_without_observers_are_not_expected() {
        let mut map = map();
        for point in &mut map.points {
            point.observers.clear();
        }
        let sight = Sight::new(&map, &[0, 1, 2]);
        assert_eq!(
            sight.expected(
                &Point3::origin(),
                &Vector3::z(),
                &Vector3::new(0.0, -1.0, 0.0)
            ),
            0
        );
    }
}
