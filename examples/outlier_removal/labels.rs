//! Which points are known to be wrong: read from a file of labels, or told by a depth sensor's images.

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

use edge_slam::depth::DepthImage;
use edge_slam::nalgebra::Point3;
use edge_slam::sequence::ImageSequence;
use slam_bridge::{KeyFrameId, Map, PointId};

use crate::score::Labels;

/// A point is wrong if its depth differs by more than this share.
const WRONG: f64 = 0.2;
/// A keyframe and a depth image belong together up to this many seconds apart.
const PAIRING: f64 = 0.02;
/// Depths are compared with all of a window that reaches this many pixels to every side.
const WINDOW: usize = 2;

/// Labels from a file: `.npy` bytes, one a point, 0 for right; or a table whose first column is a point's id and whose
/// last is its relative depth error; or one number a line and point, 0 for right.
pub(crate) fn read(map: &Map, path: &Path) -> Result<Labels, Box<dyn Error>> {
    let labels = if path.extension().is_some_and(|e| e == "npy") {
        let bytes = std::fs::read(path)?;
        let begin = bytes.len().checked_sub(map.points.len());
        let begin = begin.ok_or("fewer bytes than points")?;
        bytes[begin..].iter().map(|&b| Some(b != 0)).collect()
    } else {
        let text = std::fs::read_to_string(path)?;
        if text.lines().next().is_some_and(|line| line.contains(',')) {
            by_id(map, &text)?
        } else {
            let parse = |line: &str| Ok(Some(line.trim().parse::<f64>()? != 0.0));
            text.lines()
                .map(parse)
                .collect::<Result<Labels, Box<dyn Error>>>()?
        }
    };
    if labels.len() != map.points.len() {
        let (found, points) = (labels.len(), map.points.len());
        let path = path.display();
        return Err(format!("{path}: {found} labels for {points} points").into());
    }
    Ok(labels)
}

fn by_id(map: &Map, text: &str) -> Result<Labels, Box<dyn Error>> {
    let mut wrong = HashMap::new();
    for line in text.lines().skip(1) {
        let (Some((id, _)), Some((_, error))) = (line.split_once(','), line.rsplit_once(','))
        else {
            continue;
        };
        let error: f64 = error.trim().parse()?;
        wrong.insert(PointId(id.trim().parse()?), error.abs() > WRONG);
    }
    let known = |id: &PointId| wrong.get(id).copied();
    Ok(map.points.iter().map(|point| known(&point.id)).collect())
}

/// Labels from the depth images of the sequence that the map was made from.
///
/// Each point is projected into each keyframe that saw it and has a depth image; the map's scale is the median ratio of
/// all depths. Within the least and largest depth around the pixel the error is zero; a point's error is the median.
pub(crate) fn from_depth(map: &Map, folder: &Path) -> Result<Labels, Box<dyn Error>> {
    let sequence = ImageSequence::open(folder)?;
    let camera = (sequence.camera).ok_or("the sequence names no camera (camera-intrinsics.txt)")?;
    let pixel = |point: &Point3<f64>| {
        let ideal = camera.pinhole.project(point)?;
        Some(camera.distort(&ideal))
    };
    let mut readings: Vec<(usize, f64, f64, f64, f64)> = Vec::new();
    for at in 0..sequence.len() {
        let Some(frame) = sequence.load(at)? else {
            break;
        };
        let Some(depth) = &frame.depth else { continue };
        let near = |time: Option<f64>| time.is_some_and(|t| (t - frame.time).abs() <= PAIRING);
        for keyframe in map.keyframes.iter().filter(|k| near(k.time)) {
            for (index, point) in seen_by(map, keyframe.id) {
                let local = keyframe.world_from_camera.inverse_transform_point(&point);
                let window = pixel(&local).and_then(|at| around(depth, at.x, at.y));
                if let Some([low, middle, high]) = window {
                    readings.push((index, local.z, low, middle, high));
                }
            }
        }
    }
    let mut ratios: Vec<f64> = readings.iter().map(|r| r.3 / r.1).collect();
    let scale = median(&mut ratios).ok_or("no keyframe has a depth image of its time")?;
    let mut errors = vec![Vec::new(); map.points.len()];
    for (index, z, low, _, high) in readings {
        let z = scale * z;
        errors[index].push((z.min(low) - low + z.max(high) - high) / z);
    }
    let label = |errors: &mut Vec<f64>| median(errors).map(|error| error.abs() > WRONG);
    Ok(errors.iter_mut().map(label).collect())
}

/// The points that a keyframe saw.
fn seen_by(map: &Map, keyframe: KeyFrameId) -> impl Iterator<Item = (usize, Point3<f64>)> + '_ {
    let seen = map.points.iter().enumerate();
    seen.filter(move |(_, point)| point.observers.contains(&keyframe))
        .map(|(index, point)| (index, point.position))
}

/// Least, middle and largest known depth around a pixel; `None` at the border and where nothing is known.
fn around(depth: &DepthImage, x: f64, y: f64) -> Option<[f64; 3]> {
    let (width, height) = (depth.width() as f64, depth.height() as f64);
    let (x, y, reach) = (x.round(), y.round(), WINDOW as f64);
    if !(x >= reach && y >= reach && x + reach < width && y + reach < height) {
        return None;
    }
    let (left, top, side) = (x as usize - WINDOW, y as usize - WINDOW, 2 * WINDOW + 1);
    let pixels = (top..top + side).flat_map(|y| (left..left + side).map(move |x| (x, y)));
    let mut known: Vec<f64> = pixels.filter_map(|(x, y)| depth.get(x, y)).collect();
    let middle = median(&mut known)?;
    Some([*known.first()?, middle, *known.last()?])
}

/// The mean of the middle two for an even count; sorts.
fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let upper = values.get(values.len() / 2)?;
    Some(0.5 * (values[(values.len() - 1) / 2] + upper))
}
