//! How far a map is from the surface that depth images show: accuracy, completeness, and a picture.

use std::collections::BTreeMap;

use edge_slam::evaluation::{AbsolutePoseError, AlignBy, ErrorStatistics, TimedPose, map_accuracy};
use rstar::RTree;
use serde::Serialize;

use super::Summary;
use super::surface::Surface;
use crate::args::{Evaluate, Input};
use crate::failure::Failure;
use crate::input::load;
use crate::plot::{AxisPair, Color, Figure, Layer, Shape, Track, color, trajectory};

/// The map's part of the JSON object.
#[derive(Debug, Clone, Serialize)]
pub(super) struct MapReport {
    /// Share of map points with a point of the surface within the threshold.
    accuracy: f64,
    /// Share of the surface's points with a map point within the threshold.
    completeness: f64,
    /// Metres.
    threshold: f64,
    /// What fixed the rotation that the map was moved by (positions, poses or nothing), and what the map's lengths were multiplied by.
    align_by: &'static str,
    scale: f64,
    /// Error of the orientations after that, degrees (rmse): far points swing with it.
    rotation_deg: f64,
    /// From each map point to the nearest one of the surface, metres.
    distance: Summary,
    /// Points of the map, and of the surface (one for each cube of a quarter of the threshold).
    points: usize,
    surface_points: usize,
    /// Depth images that the surface is made of.
    depth_images: usize,
}

/// The map beside the surface, in the frame of the true trajectory.
pub(super) struct MapError {
    pub(super) report: MapReport,
    points: Vec<[f64; 3]>,
    /// Of each point, metres.
    distances: Vec<f64>,
    surface: Vec<[f64; 3]>,
}

/// Cubes of the surface along a threshold: fewer would make good points look bad, more cost time.
const CUBES: f64 = 4.0;

impl MapError {
    /// Measures the map that was named, if one was.
    pub(super) fn measure(
        arguments: &Evaluate,
        aligned: &AbsolutePoseError,
        align_by: AlignBy,
        truth: &[TimedPose],
    ) -> Result<Option<Self>, Failure> {
        let (Some(map), Some(sequence)) = (&arguments.map, &arguments.sequence) else {
            return Ok(None);
        };
        let input = Input {
            path: map.clone(),
            scale: None,
        };
        let threshold = arguments.threshold;
        let moved = |&point: &[f64; 3]| aligned.alignment.apply(&point.into()).into();
        let points: Vec<[f64; 3]> = load(&input)?.points.iter().map(moved).collect();
        let (camera, apart) = (arguments.camera, arguments.max_difference);
        let surface = Surface::read(sequence, camera, truth, apart, threshold / CUBES)?;
        let found = map_accuracy(&points, &surface.points, threshold).map_err(super::failure)?;
        let tree = RTree::bulk_load(surface.points.clone());
        let distance = |&point: &[f64; 3]| {
            let nearest = tree.nearest_neighbor(point);
            nearest.map_or(f64::INFINITY, |near| crate::input::distance(point, *near))
        };
        let distances: Vec<f64> = points.iter().map(distance).collect();
        let statistics = ErrorStatistics::of(&distances)
            .ok_or_else(|| Failure::new("the map has no point", "export the map again"))?;
        if found.accuracy == 0.0 {
            let nearest = statistics.min;
            return Err(Failure::new(
                format!(
                    "no point of {} lies within {threshold} m of what the depth images show, the nearest {nearest:.3} m away",
                    map.display()
                ),
                "give the map that belongs to the trajectory, or a larger --threshold",
            ));
        }
        let report = MapReport {
            accuracy: found.accuracy,
            completeness: found.completeness,
            threshold,
            align_by: super::name(arguments, align_by),
            scale: aligned.alignment.scale,
            rotation_deg: aligned.rotation.rmse.to_degrees(),
            distance: Summary::of(&statistics, 1.0),
            points: points.len(),
            surface_points: surface.points.len(),
            depth_images: surface.images,
        };
        Ok(Some(Self {
            report,
            points,
            distances,
            surface: surface.points,
        }))
    }

    /// Map points by their distance over the surface, with the trajectories.
    pub(super) fn figure(&self, tracks: &[Track]) -> Figure {
        let axes = AxisPair::widest(self.points.iter().chain(&self.surface));
        let threshold = self.report.threshold;
        let subtitle = self.report.headline();
        let title = format!(
            "Map by distance from the measured surface, moved by {}",
            self.report.align_by
        );
        let mut figure = trajectory::figure(&title, &subtitle, "m", axes, tracks);
        let mut layers = vec![self.ground(axes)];
        // The worst on top, or they would drown.
        for (k, (tint, radius)) in STEPS.into_iter().enumerate() {
            let from = [0.0, 0.5, 1.0, 2.0][k] * threshold;
            let to = [0.5, 1.0, 2.0, f64::INFINITY][k] * threshold;
            let within = |distance: f64| distance <= to && (k == 0 || distance > from);
            let points = self.points.iter().zip(&self.distances);
            let at: Vec<[f64; 2]> = points
                .filter(|&(_, &distance)| within(distance))
                .map(|(point, _)| axes.project(point))
                .collect();
            let share = 100.0 * at.len() as f64 / self.points.len() as f64;
            let label = match to.is_finite() {
                true => format!("up to {to:.3} m: {share:.1} %"),
                false => format!("farther: {share:.1} %"),
            };
            let dots = Layer::new(label, tint, Shape::Dots { at, radius });
            layers.push(dots.opacity(0.8).may_leave_frame());
        }
        figure.layers.splice(0..0, layers);
        figure
    }

    /// The surface, one dot for each square of half a threshold in the picture's plane.
    fn ground(&self, axes: AxisPair) -> Layer {
        let size = 0.5 * self.report.threshold;
        let mut squares: BTreeMap<[i64; 2], [f64; 2]> = BTreeMap::new();
        for point in &self.surface {
            let at = axes.project(point);
            let square = at.map(|value| (value / size).floor() as i64);
            squares.entry(square).or_insert(at);
        }
        let at = squares.into_values().collect();
        Layer::new(
            "surface by depth",
            color::UNSEEN,
            Shape::Dots { at, radius: 1.4 },
        )
        .opacity(0.7)
        .may_leave_frame()
    }
}

/// Colour and radius in pixels, from near to far.
const STEPS: [(Color, f64); 4] = [
    (color::SPOKE, 0.9),
    (color::EXIT, 1.0),
    (color::RAW_PATH, 1.1),
    (color::AGENT, 1.2),
];

impl MapReport {
    fn headline(&self) -> String {
        format!(
            "{:.1} % of {} map points within {} m of the surface, {:.1} % of the surface within {} m of one",
            100.0 * self.accuracy,
            self.points,
            self.threshold,
            100.0 * self.completeness,
            self.threshold
        )
    }

    pub(super) fn text(&self) -> String {
        let Summary {
            rmse, mean, median, ..
        } = self.distance;
        format!(
            "map: {}\n\
             distance median {median:.4}, mean {mean:.4}, rmse {rmse:.4} m; surface of {} points from {} depth images\n\
             the map was moved by {} (rotation rmse {:.3} degrees, scale {:.6})",
            self.headline(),
            self.surface_points,
            self.depth_images,
            self.align_by,
            self.rotation_deg,
            self.scale,
        )
    }
}
