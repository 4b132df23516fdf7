//! The surface that a sequence's depth images show from the true poses: the truth for maps.
//!
//! Input: depth images in metres, a camera, poses (world from camera) by time. Output: points of the world, at most one for each
//! cube of `spacing` metres (the first that fell into it).
//! Method: a grid of 160 x 120 places in each image is lifted where the four pixels around agree (nothing across a jump of depth).
//! Cost: O(pixels log points). The depth camera's noise and errors of the poses stay in it.

use std::collections::BTreeMap;
use std::path::Path;

use edge_slam::camera::Camera;
use edge_slam::depth::DepthImage;
use edge_slam::evaluation::{TimedPose, associate};
use edge_slam::nalgebra::{Isometry3, Point2, Point3, Vector3};
use edge_slam::odometry::OdometryConfig;
use edge_slam::sequence::ImageSequence;

use crate::failure::Failure;
use crate::progress::Progress;
use crate::tracking::unreadable;

/// Pixels of an image that are lifted, about: a denser grid of a large image costs time and fills no more cubes.
const LIFTED_PIXELS: usize = 160 * 120;

/// What the depth images show.
pub(super) struct Surface {
    /// Metres, in the frame of the true poses.
    pub(super) points: Vec<[f64; 3]>,
    /// Images that have both readings and a true pose.
    pub(super) images: usize,
}

impl Surface {
    /// Lifts the depth images that have a pose within `max_difference` seconds.
    pub(super) fn read(
        folder: &Path,
        camera: Option<Camera>,
        truth: &[TimedPose],
        max_difference: f64,
        spacing: f64,
    ) -> Result<Self, Failure> {
        let sequence = ImageSequence::open(folder).map_err(unreadable)?;
        let named = |reason: &str| format!("{} {reason}", folder.display());
        if !sequence.has_depth() {
            let advice = "a map can only be measured against recorded depth";
            return Err(Failure::new(named("has no depth image"), advice));
        }
        let camera = camera.or(sequence.camera).ok_or_else(|| {
            let advice = "give --camera fx,fy,cx,cy or add camera-intrinsics.txt";
            Failure::new(named("names no camera"), advice)
        })?;
        let poses = poses(&sequence, truth, max_difference)?;
        if poses.is_empty() {
            let reason =
                format!("has no frame within {max_difference} s of a pose of the reference");
            let advice = "give the sequence that belongs to it, or a larger --max-difference";
            return Err(Failure::new(named(&reason), advice));
        }
        let surface = lift(&sequence, &camera, &poses, spacing)?;
        if surface.points.is_empty() {
            let reason = named("has no usable reading in the depth images of these frames");
            return Err(Failure::new(reason, "record the depth again"));
        }
        Ok(surface)
    }
}

/// Frame numbers with their true poses, in the order of the frames.
fn poses(
    sequence: &ImageSequence,
    truth: &[TimedPose],
    max_difference: f64,
) -> Result<BTreeMap<usize, Isometry3<f64>>, Failure> {
    let at = |time| TimedPose {
        time,
        pose: Isometry3::identity(),
    };
    let frames: Vec<TimedPose> = sequence.times().map(at).collect();
    let pairs = associate(&frames, truth, max_difference).map_err(super::failure)?;
    let posed = |(i, j): (usize, usize)| Some((i, truth.get(j)?.pose));
    Ok(pairs.into_iter().filter_map(posed).collect())
}

fn lift(
    sequence: &ImageSequence,
    camera: &Camera,
    poses: &BTreeMap<usize, Isometry3<f64>>,
    spacing: f64,
) -> Result<Surface, Failure> {
    let progress = Progress::begin("depth images");
    progress.count("depth images", poses.len());
    let mut cells: BTreeMap<[i64; 3], [f64; 3]> = BTreeMap::new();
    let mut rays = Rays::default();
    let mut images = 0;
    for (&index, pose) in poses {
        let frame = sequence.load(index).map_err(unreadable)?;
        if let Some(depth) = frame.and_then(|frame| frame.depth) {
            let mut readings = false;
            for point in rays.of(camera, &depth).lift(&depth) {
                let point: [f64; 3] = (pose * point).into();
                let cell = point.map(|value| (value / spacing).floor() as i64);
                cells.entry(cell).or_insert(point);
                readings = true;
            }
            images += usize::from(readings);
        }
        progress.advance();
    }
    Ok(Surface {
        points: cells.into_values().collect(),
        images,
    })
}

/// The undistorted rays of the lifted pixels; all images of a sequence share them.
#[derive(Default)]
struct Rays {
    size: (usize, usize),
    /// Place in the image (between four pixels), and the ray with z = 1.
    rays: Vec<([f64; 2], Vector3<f64>)>,
}

impl Rays {
    fn of(&mut self, camera: &Camera, depth: &DepthImage) -> &Self {
        let size = (depth.width(), depth.height());
        if self.size != size {
            let step = (size.0 * size.1 / LIFTED_PIXELS).isqrt().max(1);
            let rows = (0..size.1).step_by(step);
            let places = rows.flat_map(|y| (0..size.0).step_by(step).map(move |x| (x, y)));
            let ray = |(x, y): (usize, usize)| {
                let place = [x as f64 + 0.5, y as f64 + 0.5];
                let ideal = camera.undistort(&Point2::from(place))?;
                Some((place, camera.pinhole.ray(&ideal)))
            };
            *self = Self {
                size,
                rays: places.filter_map(ray).collect(),
            };
        }
        self
    }

    /// Points in the camera's frame, no farther than a map's.
    fn lift<'a>(&'a self, depth: &'a DepthImage) -> impl Iterator<Item = Point3<f64>> + 'a {
        let farthest = OdometryConfig::default().farthest;
        self.rays.iter().filter_map(move |([x, y], ray)| {
            let z = depth.bilinear(*x, *y).filter(|&z| z <= farthest)?;
            Some(Point3::from(ray * z))
        })
    }
}
