//! Landmarks in small groups that a camera can dismiss at once.

use nalgebra::{Isometry3, Vector3};

use super::landmark::Landmark;
use crate::camera::Camera;

/// Landmarks that lie close together and face the same way.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    /// The numbers `from..to` of the landmarks.
    pub(crate) from: u32,
    pub(crate) to: u32,
    center: Vector3<f64>,
    radius: f64,
    normal: Vector3<f64>,
    /// Whether a camera behind the surface sees none of them.
    flat: bool,
    /// Greatest distance at which any of them is resolved, metres.
    far: f64,
}

/// Side of the cells that groups are made from, metres.
const CELL: f64 = 0.8;

/// Sorts landmarks into groups; the numbers of the landmarks are their new places.
pub(crate) fn group(mut landmarks: Vec<Landmark>) -> (Vec<Landmark>, Vec<Group>) {
    landmarks.sort_by_cached_key(key);
    let mut groups = Vec::new();
    let mut from = 0;
    for members in landmarks.chunk_by(|a, b| key(a) == key(b)) {
        groups.push(bound(from, members));
        from += members.len() as u32;
    }
    (landmarks, groups)
}

/// Cell and rounded normal.
fn key(landmark: &Landmark) -> ([i32; 3], [i8; 3]) {
    let cell = landmark.position.map(|value| (value / CELL).floor() as i32);
    (
        cell,
        landmark.normal.map(|value| (value * 10.0).round() as i8),
    )
}

fn bound(from: u32, members: &[Landmark]) -> Group {
    let extreme = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        core::array::from_fn(|axis| members.iter().map(|m| m.position[axis]).fold(start, pick))
    };
    let low = Vector3::from(extreme(f64::min, f64::INFINITY));
    let high = Vector3::from(extreme(f64::max, f64::NEG_INFINITY));
    Group {
        from,
        to: from + members.len() as u32,
        center: (low + high) * 0.5,
        radius: (high - low).norm() * 0.5,
        normal: members
            .first()
            .map_or_else(Vector3::z, |member| Vector3::from(member.normal)),
        flat: members.iter().all(|member| member.least_cosine >= 0.0),
        far: members.iter().map(|member| member.far).fold(0.0, f64::max),
    }
}

impl Group {
    /// Whether some member may be seen: false only when none can.
    pub(crate) fn may_be_seen(&self, camera: &Camera, camera_from_world: &Isometry3<f64>) -> bool {
        let place = camera_from_world * nalgebra::Point3::from(self.center);
        if place.coords.norm() - self.radius > self.far {
            return false;
        }
        let eye = camera_from_world.inverse_transform_point(&nalgebra::Point3::origin());
        let in_front = (eye.coords - self.center).dot(&self.normal) > -self.radius;
        (in_front || !self.flat) && camera.may_show(place.coords, self.radius)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Vector3};
    use proptest::prelude::*;

    use super::group;
    use crate::camera::Camera;
    use crate::world::World;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn no_landmark_in_view_is_in_a_dismissed_group(
            place in [0.3..12.0_f64, 0.3..7.0_f64, 0.3..2.3_f64], turn in [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64]
        ) {
            let world = World::named("apartment", 3).unwrap();
            let (landmarks, groups) = group(world.landmarks().to_vec());
            let camera = Camera::default();
            let pose = Isometry3::new(Vector3::from(place), Vector3::from(turn));
            for group in &groups {
                let dismissed = !group.may_be_seen(&camera, &pose.inverse());
                for member in &landmarks[group.from as usize..group.to as usize] {
                    let ray = pose.inverse() * nalgebra::Point3::from(member.position);
                    let seen = camera.contains(ray.coords) && world.sees_landmark(place, member);
                    prop_assert!(!(dismissed && seen));
                }
            }
        }
    }
}
