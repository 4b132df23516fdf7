//! The loop over the frames of a sequence.

use edge_slam::camera::Camera;
use edge_slam::depth::DepthImage;
use edge_slam::edge::{CannyConfig, canny, lift_chain, trace_chains};
use edge_slam::evaluation::TimedPose;
use edge_slam::feature::KltConfig;
use edge_slam::image::GrayView;
use edge_slam::odometry::{Odometry, OdometryConfig, Tracked, Tracker};
use edge_slam::sequence::{ImageSequence, LoadedFrame, SequenceError};
use rand::{Rng, SeedableRng as _};
use slam_bridge::nalgebra::Point3;

use super::{Depths, Epoch, Flight, Fusing, FusionReport};
use crate::args::{Slam, TrackerChoice};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::stopwatch::timed;

/// Everything that came out of a sequence.
#[derive(Debug)]
pub(crate) struct Tracking {
    /// Frames read.
    pub(crate) frames: usize,
    /// In the order of time; never empty.
    pub(crate) epochs: Vec<Epoch>,
    /// Milliseconds of each frame: tracking, and edges of keyframes.
    pub(crate) milliseconds: Vec<f64>,
    /// Whether the unit is the metre and epochs follow each other in one frame.
    pub(crate) is_metric: bool,
    /// Poses by the filter, of all epochs in one world and in metres; empty without telemetry.
    pub(crate) fused: Vec<TimedPose>,
    /// Which of these rest on telemetry alone: no visual pose, or one that the filter refused.
    pub(crate) reckoned: Vec<bool>,
    /// Times of all frames.
    pub(crate) times: Vec<f64>,
    pub(crate) fusion: FusionReport,
}

/// Shortest edge that goes into the map, pixels.
const SHORTEST_CHAIN: usize = 20;

/// The camera of the command line, else of the sequence.
pub(crate) fn camera_of(arguments: &Slam, sequence: &ImageSequence) -> Result<Camera, Failure> {
    arguments.camera.or(sequence.camera).ok_or_else(|| {
        let reason = format!("{} names no camera", arguments.sequence.display());
        let advice = "give --camera fx,fy,cx,cy or add camera-intrinsics.txt with the 3x3 matrix K";
        Failure::new(reason, advice)
    })
}

pub(crate) fn unreadable(error: SequenceError) -> Failure {
    use std::error::Error as _;
    let mut reason = error.to_string();
    let mut cause = error.source();
    while let Some(source) = cause {
        reason.push_str(&format!(": {source}"));
        cause = source.source();
    }
    Failure::new(
        reason,
        "check that the folder is a recorded sequence and complete",
    )
}

/// Tracks the whole sequence, or its first frames.
pub(crate) fn track(
    arguments: &Slam,
    sequence: &ImageSequence,
    camera: Camera,
    depths: &mut Depths,
    seed: u64,
    progress: &Progress,
) -> Result<Tracking, Failure> {
    let config = OdometryConfig {
        tracker: match arguments.tracker {
            TrackerChoice::Orb => Tracker::Orb,
            TrackerChoice::Klt => Tracker::Klt(KltConfig::default()),
        },
        ..OdometryConfig::default()
    };
    let mut odometry = Odometry::new(camera, config).map_err(Failure::internal)?;
    let rng = &mut rand_pcg::Pcg64::seed_from_u64(seed);
    let count = arguments.frames.unwrap_or(usize::MAX).min(sequence.len());
    let mut fusing = fusing(arguments, sequence, count)?;
    let mut tracking = Tracking {
        frames: count,
        epochs: vec![Epoch::default()],
        milliseconds: Vec::with_capacity(count),
        is_metric: depths.is_metric(),
        fused: Vec::new(),
        reckoned: Vec::new(),
        times: sequence.times().take(count).collect(),
        fusion: FusionReport::none(),
    };
    progress.count("tracking", count);
    for index in 0..count {
        let Some(loaded) = sequence.load(index).map_err(unreadable)? else {
            break;
        };
        let tracked = track_frame(&loaded, &mut odometry, camera, depths, rng, &mut tracking)?;
        if let Some(fusing) = &mut fusing {
            fuse(fusing, &mut tracking, loaded.time, &tracked, &odometry)?;
        }
        progress.advance();
    }
    if let Some(fusing) = fusing {
        tracking.fusion = fusing.report;
    }
    Ok(tracking)
}

/// One frame through the odometry; edges too, if it became a keyframe.
fn track_frame(
    loaded: &LoadedFrame,
    odometry: &mut Odometry,
    camera: Camera,
    depths: &mut Depths,
    rng: &mut impl Rng,
    tracking: &mut Tracking,
) -> Result<Tracked, Failure> {
    // A network is slow and only trusted as a whole: it looks at keyframes.
    let metric = if depths.is_metric() {
        depths.depth(&loaded.frame())?
    } else {
        None
    };
    let epoch = odometry.current_map().epoch;
    let (tracked, seconds) = timed(|| odometry.track(&loaded.frame(), metric.as_ref(), rng));
    if odometry.current_map().epoch != epoch {
        tracking.epochs.push(Epoch::default());
    }
    let mut milliseconds = 1e3 * seconds;
    if let Some(epoch) = tracking.epochs.last_mut() {
        record(epoch, loaded, &tracked, odometry);
        if tracked.is_keyframe {
            let metric = metric.as_ref();
            let (edges, seconds) =
                timed(|| edges(epoch, loaded, &tracked, camera, metric, depths, odometry));
            edges?;
            milliseconds += 1e3 * seconds;
        }
    }
    tracking.milliseconds.push(milliseconds);
    Ok(tracked)
}

/// The filter, where there is telemetry.
fn fusing(
    arguments: &Slam,
    sequence: &ImageSequence,
    count: usize,
) -> Result<Option<Fusing>, Failure> {
    let Some(flight) = Flight::open(arguments)? else {
        return Ok(None);
    };
    let times = sequence.times().take(count);
    let ends = times.fold(None, |ends: Option<[f64; 2]>, time| {
        let [first, last] = ends.unwrap_or([time; 2]);
        Some([first.min(time), last.max(time)])
    });
    ends.map(|ends| Fusing::new(flight, ends)).transpose()
}

fn fuse(
    fusing: &mut Fusing,
    tracking: &mut Tracking,
    time: f64,
    tracked: &Tracked,
    odometry: &Odometry,
) -> Result<(), Failure> {
    let epoch = odometry.current_map().epoch;
    if let Some((pose, is_seen)) = fusing.observe(time, tracked, epoch, odometry.is_metric())? {
        tracking.fused.push(TimedPose { time, pose });
        tracking.reckoned.push(!is_seen);
    }
    if let Some(epoch) = tracking.epochs.last_mut() {
        epoch.placed = fusing.placed();
    }
    Ok(())
}

fn record(epoch: &mut Epoch, loaded: &LoadedFrame, tracked: &Tracked, odometry: &Odometry) {
    if let Some(pose) = tracked.world_from_camera {
        epoch.poses.push(TimedPose {
            time: loaded.time,
            pose,
        });
    }
    if tracked.is_keyframe {
        epoch.keyframes += 1;
    }
    if tracked.is_keyframe || epoch.map.points.len() < odometry.current_map().points.len() {
        epoch.map = odometry.current_map().clone();
    }
}

/// Lifts a keyframe's edges by its depth; holds a network's depth against the points that are known.
fn edges(
    epoch: &mut Epoch,
    loaded: &LoadedFrame,
    tracked: &Tracked,
    camera: Camera,
    metric: Option<&DepthImage>,
    depths: &mut Depths,
    odometry: &Odometry,
) -> Result<(), Failure> {
    let predicted = match metric {
        Some(_) => None,
        None => depths.depth(&loaded.frame())?,
    };
    let (Some(pose), Some(depth)) = (tracked.world_from_camera, metric.or(predicted.as_ref()))
    else {
        return Ok(());
    };
    if predicted.is_some() {
        for ([x, y], z) in odometry.reference_points() {
            if let Some(guess) = depth.bilinear(x, y) {
                epoch.predicted.push(guess);
                epoch.triangulated.push(z);
            }
        }
    }
    epoch
        .edges
        .push((pose, lifted(&loaded.image.view(), &camera, depth)));
    Ok(())
}

fn lifted(image: &GrayView<'_>, camera: &Camera, depth: &DepthImage) -> Vec<Point3<f64>> {
    let Ok(edges) = canny(image, &CannyConfig::default()) else {
        return Vec::new();
    };
    let chains = trace_chains(&edges, SHORTEST_CHAIN);
    let farthest = OdometryConfig::default().farthest;
    let points = chains
        .iter()
        .flat_map(|chain| lift_chain(chain, camera, depth));
    points.filter(|point| point.z <= farthest).collect()
}
