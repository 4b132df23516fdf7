//! A sparse map in the frame and the metres of a reference trajectory.

use std::error::Error;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use edge_slam::evaluation::{Alignment, TimedPose, align_points};
use explorer::map_views;
use slam_bridge::nalgebra::Similarity3;
use slam_bridge::{Map, read_map, read_tum};
use sparse_to_obstacles::Ray;
use submodular_minimax::Views;

use crate::arguments::Arguments;

/// A time and a pose belong together up to this many seconds apart.
const PAIRING: f64 = 0.02;

/// Points, and which camera places see them, metres.
pub(crate) struct AlignedMap {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) views: Views,
    /// Keyframes with a reference pose.
    pub(crate) matches: usize,
    /// Root mean square distance of those to the reference, metres.
    pub(crate) residual: f64,
}

/// The trajectory that is named, or the sequence's own.
pub(crate) fn reference(arguments: &Arguments) -> Result<Vec<TimedPose>, Box<dyn Error>> {
    let own = ["groundtruth_tum.txt", "groundtruth.txt"];
    let mut found = own.iter().map(|name| arguments.sequence.join(name));
    let path = arguments.reference.clone();
    let path = path.or_else(|| found.find(|path| path.is_file()));
    let path = path.ok_or_else(|| {
        let folder = arguments.sequence.display();
        format!(
            "{folder} has no {}: name a trajectory after the folders",
            own.join(" or ")
        )
    })?;
    let named = |error: &dyn Error| format!("{} cannot be read: {error}", path.display());
    let file = File::open(&path).map_err(|error| named(&error))?;
    Ok(read_tum(BufReader::new(file)).map_err(|error| named(&error))?)
}

/// The pose nearest in time, if any is near. Cost: O(n).
pub(crate) fn pose_at(reference: &[TimedPose], time: f64) -> Option<&TimedPose> {
    let off = |pose: &&TimedPose| (pose.time - time).abs();
    let nearest = (reference.iter()).min_by(|a, b| off(a).total_cmp(&off(b)))?;
    (off(&nearest) <= PAIRING).then_some(nearest)
}

/// Reads a map with observations and brings it to the reference.
pub(crate) fn aligned(
    folder: &Path,
    reference: &[TimedPose],
) -> Result<AlignedMap, Box<dyn Error>> {
    let mut map = read_map(folder)?;
    if !map.has_observations() {
        let folder = folder.display();
        let needed = "keyframes.csv and observations.csv(.gz) beside map.ply";
        return Err(
            format!("{folder} does not tell which keyframe saw what: it needs {needed}").into(),
        );
    }
    let (own, truth) = matches(&map, reference);
    let similarity = align_points(&own, &truth, Alignment::Sim3).map_err(|error| {
        let count = own.len();
        format!("{count} keyframes have a pose of the reference within {PAIRING} s of their time, and do not tell how the map lies to it: {error}")
    })?;
    let squared = own.iter().zip(&truth).map(|(&own, &truth)| {
        let truth: edge_slam::nalgebra::Point3<f64> = truth.into();
        (similarity.apply(&own.into()) - truth).norm_squared()
    });
    let residual = (squared.sum::<f64>() / own.len() as f64).sqrt();
    map.transform(&Similarity3::from_isometry(
        similarity.motion,
        similarity.scale,
    ));
    let views = map_views(&map)?.ok_or("no keyframe sees anything")?;
    Ok(AlignedMap {
        points: map.positions(),
        views,
        matches: own.len(),
        residual,
    })
}

/// Places of keyframes, and where they are in the reference.
fn matches(map: &Map, reference: &[TimedPose]) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let pair = |keyframe: &slam_bridge::KeyFrame| -> Option<([f64; 3], [f64; 3])> {
        let pose = pose_at(reference, keyframe.time?)?.pose;
        Some((keyframe.center().into(), pose.translation.vector.into()))
    };
    map.keyframes.iter().filter_map(pair).unzip()
}

impl AlignedMap {
    /// From every keyframe to every one of these points that it sees.
    pub(crate) fn rays(&self, points: impl IntoIterator<Item = usize>) -> Vec<Ray> {
        let mut rays = Vec::new();
        for point in points {
            let origins = self.views.observers(point);
            rays.extend(origins.map(|camera| Ray {
                origin: self.views.viewpoints()[camera],
                end: self.points[point],
            }));
        }
        rays
    }

    /// From every keyframe to every point that it sees.
    pub(crate) fn all_rays(&self) -> Vec<Ray> {
        self.rays(0..self.points.len())
    }
}
