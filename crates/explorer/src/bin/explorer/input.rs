//! From the command line's INPUT to a map, and what lengths are worth in it.

use explorer::map_views;
use slam_bridge::nalgebra::Vector3;
use slam_bridge::{Map, MapFileError, ReadError, Scale, read_map};
use sparse_to_obstacles::Ray;
use submodular_minimax::Views;

use crate::args::{Input, Vector};
use crate::failure::Failure;
use crate::planning::quantiles;
use crate::stopwatch::median;

/// Median distance from camera to point that a map without scale is taken to have, metres: the middle of three
/// maps of known scale (desk 1.4, kitchen 1.9, hall 2.2). Too long a guess would make the body too small.
const ASSUMED_MEDIAN_RANGE_M: f64 = 1.9;

/// A map with its points as plain coordinates.
#[derive(Debug)]
pub(crate) struct LoadedMap {
    pub(crate) map: Map,
    pub(crate) points: Vec<[f64; 3]>,
}

/// Reads the map of a command.
pub(crate) fn load(input: &Input) -> Result<LoadedMap, Failure> {
    let mut map = read_map(&input.path).map_err(|error| Failure::new(&error, advice(&error)))?;
    if let Some(meters) = input.scale {
        map.scale = Scale::MetersPerUnit(meters);
    }
    let points = map.positions();
    Ok(LoadedMap { map, points })
}

fn advice(error: &MapFileError) -> &'static str {
    match error {
        MapFileError::NotFound { .. } => "check the path",
        MapFileError::UnknownExtension { .. } => "rename or convert the file",
        MapFileError::NoMapInFolder { .. } => "give the map file itself or another folder",
        MapFileError::Io { .. } => "check that the file can be read",
        MapFileError::Read { source, .. } => match source {
            ReadError::Empty | ReadError::NoPoints => "export the map again, it needs points",
            ReadError::Truncated { .. } | ReadError::Surplus { .. } => {
                "copy the file again or correct the count in its header"
            }
            ReadError::At { .. } => "correct that place or leave it out",
            _ => "check that the file is what its name says",
        },
        _ => "check the input",
    }
}

impl LoadedMap {
    /// "m" where a map unit is a metre.
    pub(crate) fn unit(&self) -> &'static str {
        // Coordinates stay in map units, whatever these are worth.
        if self.map.scale == Scale::MetersPerUnit(1.0) {
            "m"
        } else {
            "map units"
        }
    }

    /// Map units for a metre: by the scale, else as if the median range were 1.9 m.
    pub(crate) fn units_per_meter(&self, position: Option<Vector>) -> f64 {
        match self.map.scale.meters_per_unit() {
            Some(meters) => 1.0 / meters,
            None => self.median_range(position) / ASSUMED_MEDIAN_RANGE_M,
        }
    }

    /// Median distance from the cameras to what they see; without cameras from the agent, or from
    /// the middle of the map.
    fn median_range(&self, position: Option<Vector>) -> f64 {
        let ranges: Vec<f64> = match self.map.has_observations() {
            true => self
                .rays(0..self.points.len())
                .iter()
                .map(|r| distance(r.origin, r.end))
                .collect(),
            false => {
                let from = position.unwrap_or_else(|| self.middle());
                self.points
                    .iter()
                    .map(|point| distance(*point, from))
                    .collect()
            }
        };
        let range = median(ranges);
        if range > 0.0 { range } else { 1.0 }
    }

    fn middle(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| median(self.points.iter().map(|point| point[axis]).collect()))
    }

    /// Refuses a position that has nothing to do with the map.
    pub(crate) fn check_position(&self, flag: &str, position: Vector) -> Result<(), Failure> {
        let low = quantiles(&self.points, 0.02).unwrap_or_default();
        let high = quantiles(&self.points, 0.98).unwrap_or_default();
        let spans = [0, 1, 2].map(|axis| (low[axis], high[axis]));
        let size = spans
            .iter()
            .map(|(low, high)| (high - low).powi(2))
            .sum::<f64>()
            .sqrt();
        let outside = |axis: usize| {
            let ((low, high), value) = (spans[axis], position[axis]);
            (low - value).max(value - high).max(0.0)
        };
        let away = [0, 1, 2]
            .map(outside)
            .iter()
            .map(|gap| gap * gap)
            .sum::<f64>()
            .sqrt();
        if away <= size.max(1e-9) {
            return Ok(());
        }
        let [x, y, z] = position;
        let [a, b, c] = spans.map(|(low, high)| format!("{low:.2}..{high:.2}"));
        Err(Failure::new(
            format!(
                "{flag} {x},{y},{z} lies {away:.1} map units outside the map, whose middle 96 % spans \
                 x {a}, y {b}, z {c}"
            ),
            "give a position within the map, in the map's own frame",
        ))
    }

    /// Which way is up as far as the map tells: away from where the keyframes' images point down.
    pub(crate) fn up(&self, given: Option<Vector>) -> Vector {
        let cameras = self.map.keyframes.iter();
        let down = cameras.map(|keyframe| keyframe.world_from_camera.rotation * Vector3::y());
        let down = down.fold(Vector3::zeros(), |sum, down| sum + down);
        let told = (-down).try_normalize(1e-6).map(Into::into);
        given.or(told).unwrap_or([0.0, 0.0, 1.0])
    }

    /// Which keyframe sees which point, as the outlier removal wants it; for a map without
    /// observations all are seen from the agent's position, when it is known.
    pub(crate) fn views(&self, position: Option<Vector>) -> Result<Option<Views>, Failure> {
        if !self.map.has_observations() {
            let views = position.map(|from| Views::from_position(from, self.points.len()));
            return views
                .transpose()
                .map_err(|error| Failure::new(error, "give another --position"));
        }
        map_views(&self.map)
            .map_err(|error| Failure::new(error, "correct keyframes.csv and observations.csv"))
    }

    /// A ray from every keyframe to every one of these points that it sees.
    pub(crate) fn rays(&self, points: impl IntoIterator<Item = usize>) -> Vec<Ray> {
        let mut rays = Vec::new();
        for point in points
            .into_iter()
            .filter_map(|index| self.map.points.get(index))
        {
            let end = point.position.into();
            let observers = point
                .observers
                .iter()
                .filter_map(|id| self.map.keyframe(*id));
            rays.extend(observers.map(|keyframe| Ray {
                origin: keyframe.center().into(),
                end,
            }));
        }
        rays
    }
}

/// Distance of two points.
pub(crate) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}
