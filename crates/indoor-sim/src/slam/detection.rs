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

/// The detections of a picture, ascending by landmark. Cost: one test per group of landmarks, one per landmark of the
/// groups that pass, and one ray cast per landmark that passes.
pub(crate) fn detect(
    world: &World,
    camera: &Camera,
    world_from_camera: &Isometry3<f64>,
    budget: usize,
) -> Vec<Detection> {
    let camera_from_world = world_from_camera.inverse();
    let groups = world.groups().iter();
    let mut seen: Vec<Seen> = groups
        .filter(|group| group.may_be_seen(camera, &camera_from_world))
        .flat_map(|group| group.from..group.to)
        .filter_map(|number| look(world, camera, world_from_camera, number))
        .collect();
    spread(&mut seen, budget);
    let mut detections: Vec<Detection> = seen.into_iter().map(|seen| seen.detection).collect();
    detections.sort_unstable_by_key(|detection| detection.landmark);
    detections
}

/// A landmark, if the picture shows it.
fn look(
    world: &World,
    camera: &Camera,
    world_from_camera: &Isometry3<f64>,
    number: u32,
) -> Option<Seen> {
    let landmark = &world.landmarks()[number as usize];
    let center = world_from_camera.translation.vector;
    let ray = Vector3::from(landmark.position) - center;
    let range = ray.norm();
    let resolved = range >= landmark.near.max(NEAREST) && range <= landmark.far.min(FARTHEST);
    let in_camera = world_from_camera.rotation.inverse_transform_vector(&ray);
    let shown = resolved && camera.contains(in_camera);
    if !shown || !world.sees_landmark(center.into(), landmark) {
        return None;
    }
    let detection = Detection {
        landmark: number,
        range,
    };
    let cell = cell_of(camera, in_camera);
    Some(Seen {
        cell,
        rank: 0,
        strength: landmark.strength,
        detection,
    })
}

/// A visible landmark before the budget is spent.
struct Seen {
    cell: u32,
    rank: u32,
    strength: f64,
    detection: Detection,
}

/// Cells across and down the picture that share the budget, as detectors spread their corners.
const CELLS: (f64, f64) = (8.0, 6.0);

fn cell_of(camera: &Camera, in_camera: Vector3<f64>) -> u32 {
    let place = |value: f64, focal: f64, size: f64, cells: f64| {
        ((value / in_camera.z * focal / size + 0.5) * cells).clamp(0.0, cells - 1.0) as u32
    };
    let column = place(in_camera.x, camera.fx, camera.width, CELLS.0);
    let row = place(in_camera.y, camera.fy, camera.height, CELLS.1);
    row * CELLS.0 as u32 + column
}

/// Keeps `budget` of what is seen: the strongest of each cell, then the second strongest of each, and so on.
fn spread(seen: &mut Vec<Seen>, budget: usize) {
    if seen.len() <= budget {
        return;
    }
    let by_strength = |a: &Seen, b: &Seen| {
        b.strength
            .total_cmp(&a.strength)
            .then(a.detection.landmark.cmp(&b.detection.landmark))
    };
    seen.sort_unstable_by(|a, b| a.cell.cmp(&b.cell).then(by_strength(a, b)));
    let (mut cell, mut rank) = (u32::MAX, 0);
    for one in seen.iter_mut() {
        rank = if one.cell == cell { rank + 1 } else { 0 };
        cell = one.cell;
        one.rank = rank;
    }
    seen.select_nth_unstable_by(budget, |a, b| a.rank.cmp(&b.rank).then(by_strength(a, b)));
    seen.truncate(budget);
}
