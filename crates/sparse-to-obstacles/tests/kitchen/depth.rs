//! The true surfaces of a room from the images of a depth camera.

use crate::map::{Pose, Vec3};
use std::collections::BTreeMap;
use std::path::Path;

/// Focal length and centre of the depth camera, pixels.
const FOCAL: f64 = 585.0;
const CENTRE: [f64; 2] = [320.0, 240.0];
/// Every so many frames and pixels are used.
const FRAME_STRIDE: usize = 5;
const PIXEL_STRIDE: usize = 4;
/// Depths that the sensor measures well, metres.
const RANGE: std::ops::Range<f64> = 0.4..3.5;
/// A voxel is surface from so many readings.
const MIN_READINGS: usize = 10;

/// The poses of all frames in order.
pub(crate) fn poses(folder: &Path) -> Option<Vec<Pose>> {
    let pose = |frame: usize| {
        let file = folder.join(format!("seven_scenes_redkitchen_part1/pose/{frame:06}.txt"));
        Pose::parse(&std::fs::read_to_string(file).ok()?)
    };
    let poses: Vec<Pose> = (0..).map_while(pose).collect();
    (poses.len() > 100).then_some(poses)
}

/// The centres of the voxels that hold true surface.
pub(crate) fn surface(folder: &Path, poses: &[Pose], resolution: f64) -> Option<Vec<Vec3>> {
    let mut readings: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    for (frame, pose) in poses.iter().enumerate().step_by(FRAME_STRIDE) {
        let file = folder.join(format!(
            "seven_scenes_redkitchen_part1/depth/{frame:06}.png"
        ));
        for point in back_project(&file)? {
            let cell = pose.apply(point).map(|c| (c / resolution).floor() as i64);
            *readings.entry(cell).or_default() += 1;
        }
    }
    let enough = readings
        .into_iter()
        .filter(|&(_, count)| count >= MIN_READINGS);
    Some(
        enough
            .map(|(cell, _)| cell.map(|c| (c as f64 + 0.5) * resolution))
            .collect(),
    )
}

fn back_project(file: &Path) -> Option<Vec<Vec3>> {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(file).ok()?));
    let mut reader = decoder.read_info().ok()?;
    let mut bytes = vec![0; reader.output_buffer_size()?];
    let width = reader.next_frame(&mut bytes).ok()?.width as usize;
    let height = bytes.len() / (2 * width);
    let mut points = Vec::new();
    for v in (0..height).step_by(PIXEL_STRIDE) {
        for u in (0..width).step_by(PIXEL_STRIDE) {
            let at = 2 * (v * width + u);
            let depth = f64::from(u16::from_be_bytes([bytes[at], bytes[at + 1]])) / 1000.0;
            if RANGE.contains(&depth) {
                let [x, y] = [u as f64 - CENTRE[0], v as f64 - CENTRE[1]];
                points.push([x / FOCAL * depth, y / FOCAL * depth, depth]);
            }
        }
    }
    Some(points)
}
