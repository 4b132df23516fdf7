//! Which landmarks a picture shows: in the frustum, at a fitting distance and angle, not hidden, the strongest first.

use nalgebra::{Isometry3, Vector3};

use crate::camera::Camera;
use crate::world::World;

/// One landmark in one picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Detection {
    /// Number of the landmark in the world.
    pub(crate) landmark: u32,
    /// Distance from the camera, metres.
    pub(crate) range: f64,
}

/// Greatest distance at which a corner is found, metres.
const FARTHEST: f64 = 10.0;

/// Least distance, metres: nearer, the picture is out of focus and moves too fast.
const NEAREST: f64 = 0.3;

/// The detections of a picture, ascending by landmark. Cost: one test per group of landmarks, one per landmark of
/// the groups that pass, and one ray cast per landmark that passes.
pub(crate) fn detect(
    world: &World,
    camera: &Camera,
    world_from_camera: &Isometry3<f64>,
    budget: usize,
) -> Vec<Detection> {
    let center = world_from_camera.translation.vector;
    let camera_from_world = world_from_camera.inverse();
    let mut seen: Vec<(f64, Detection)> = Vec::new();
    for group in world.groups() {
        if !group.may_be_seen(camera, &camera_from_world) {
            continue;
        }
        for number in group.from..group.to {
            let landmark = &world.landmarks()[number as usize];
            let ray = Vector3::from(landmark.position) - center;
            let range = ray.norm();
            let resolved =
                range >= landmark.near.max(NEAREST) && range <= landmark.far.min(FARTHEST);
            if resolved
                && camera.contains(camera_from_world.rotation * ray)
                && world.sees_landmark(center.into(), landmark)
            {
                seen.push((
                    landmark.strength,
                    Detection {
                        landmark: number,
                        range,
                    },
                ));
            }
        }
    }
    if seen.len() > budget {
        seen.select_nth_unstable_by(budget, |a, b| {
            b.0.total_cmp(&a.0).then(a.1.landmark.cmp(&b.1.landmark))
        });
        seen.truncate(budget);
    }
    let mut detections: Vec<Detection> = seen.into_iter().map(|(_, detection)| detection).collect();
    detections.sort_unstable_by_key(|detection| detection.landmark);
    detections
}
