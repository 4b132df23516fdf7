//! The true surfaces of a place, from depth images.

use std::collections::BTreeMap;
use std::error::Error;

use edge_slam::camera::Camera;
use edge_slam::depth::DepthImage;
use edge_slam::evaluation::TimedPose;
use edge_slam::nalgebra::Point3;
use edge_slam::sequence::ImageSequence;

use crate::arguments::Arguments;
use crate::map::pose_at;

/// One pixel of so many in a row and in a column is used.
const PIXEL_STRIDE: usize = 4;
/// Depths that structured light measures well, metres.
const RANGE: std::ops::Range<f64> = 0.4..3.5;
/// A voxel is surface from so many readings.
const MIN_READINGS: usize = 10;

/// Voxels that hold true surface.
pub(crate) struct Surface {
    pub(crate) centers: Vec<[f64; 3]>,
    pub(crate) voxel: f64,
    /// Depth images that were used.
    pub(crate) images: usize,
}

impl Surface {
    pub(crate) fn len(&self) -> usize {
        self.centers.len()
    }
}

/// The voxel that holds a place; voxels lie at whole multiples of their edge.
pub(crate) fn cell(place: [f64; 3], voxel: f64) -> [i64; 3] {
    place.map(|c| (c / voxel).floor() as i64)
}

/// The surface in the reference's frame. `progress` hears of each image.
pub(crate) fn surface(
    arguments: &Arguments,
    reference: &[TimedPose],
    progress: impl Fn(usize, usize),
) -> Result<Surface, Box<dyn Error>> {
    let folder = arguments.sequence.display();
    let sequence = ImageSequence::open(&arguments.sequence)?;
    let camera = (sequence.camera)
        .ok_or_else(|| format!("{folder} names no camera: put K into camera-intrinsics.txt"))?;
    let times: Vec<f64> = sequence.times().collect();
    let mut readings: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    let mut images = 0;
    for (index, &time) in times.iter().enumerate().step_by(arguments.every) {
        progress(
            index / arguments.every + 1,
            times.len().div_ceil(arguments.every),
        );
        let Some(TimedPose { pose, .. }) = pose_at(reference, time) else {
            continue;
        };
        let Some(depth) = sequence.load(index)?.and_then(|frame| frame.depth) else {
            continue;
        };
        images += 1;
        for point in back_project(&depth, &camera) {
            let place = cell((pose * point).into(), arguments.voxel);
            *readings.entry(place).or_default() += 1;
        }
    }
    let enough = (readings.into_iter()).filter(|&(_, count)| count >= MIN_READINGS);
    let center = |cell: [i64; 3]| cell.map(|c| (c as f64 + 0.5) * arguments.voxel);
    let centers: Vec<[f64; 3]> = enough.map(|(cell, _)| center(cell)).collect();
    if centers.is_empty() {
        return Err(format!("{folder} shows no surface: {images} depth images have a pose of the reference at their time (try --every 1)").into());
    }
    Ok(Surface {
        centers,
        voxel: arguments.voxel,
        images,
    })
}

/// Points in the camera's frame, metres.
fn back_project(depth: &DepthImage, camera: &Camera) -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for v in (0..depth.height()).step_by(PIXEL_STRIDE) {
        for u in (0..depth.width()).step_by(PIXEL_STRIDE) {
            let Some(range) = depth.get(u, v).filter(|range| RANGE.contains(range)) else {
                continue;
            };
            if let Some(pixel) = camera.undistort(&[u as f64, v as f64].into()) {
                points.push((camera.pinhole.ray(&pixel) * range).into());
            }
        }
    }
    points
}
