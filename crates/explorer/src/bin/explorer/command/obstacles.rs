//! `explorer obstacles`: convex obstacles from points, and the space that was seen through.

use serde::Serialize;
use slam_bridge::{Map, write_ply};
use sparse_to_obstacles::FreeSpace;

use crate::args::{Obstacles, Output, Vector};
use crate::failure::Failure;
use crate::input::{self, LoadedMap};
use crate::output::{deliver, write_file};
use crate::planning::{RADIUS_M, Seconds, Surroundings, surroundings};
use crate::plot::{Figure, Layer, TopView, color, scene};
use crate::progress::Progress;

/// The command's JSON object.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ObstaclesReport {
    /// Number of obstacles.
    pub(crate) obstacles: usize,
    /// How many of them are points, segments or flat.
    pub(crate) degenerate: usize,
    /// Sum of squared distances to the clusters' centres, squared map units.
    pub(crate) inertia: f64,
    /// Proven-free voxels in which the body fits; 0 without observations.
    pub(crate) proven_free_voxels: usize,
    /// All voxels seen through.
    pub(crate) seen_through_voxels: usize,
    /// Edge of a voxel, map units; none without observations.
    pub(crate) resolution: Option<f64>,
    /// All of the work, without reading the file: K-means, hulls and free space, which follow one by one.
    pub(crate) seconds: f64,
    pub(crate) kmeans_seconds: f64,
    pub(crate) hulls_seconds: f64,
    pub(crate) free_space_seconds: f64,
}

pub(crate) fn run(arguments: &Obstacles, output: &Output) -> Result<(), Failure> {
    let progress = Progress::begin("reading the map");
    let loaded = input::load(&arguments.input)?;
    progress.step("building obstacles");
    let units = loaded.units_per_meter(None);
    let clusters = Some(arguments.clusters);
    let built = surroundings(&loaded, None, clusters, units, output.seed)?;
    let radius = arguments.radius.unwrap_or(RADIUS_M * units);
    let places = built.places(radius);
    drop(progress);
    if let Some(path) = &arguments.output {
        write_file(path, |file| built.obstacles.write_obj(file))?;
    }
    if let Some(path) = &arguments.proven_free {
        built.space(true)?;
        let map = Map {
            scale: loaded.map.scale,
            ..Map::from_positions(places.iter().copied())
        };
        write_file(path, |file| write_ply(&map, file))?;
    }
    let report = report(&built, places.len());
    deliver(output, &report, &text(&report), || {
        figure(&loaded, &built, &report, arguments.up)
    })
}

pub(crate) fn report(built: &Surroundings, proven_free_voxels: usize) -> ObstaclesReport {
    let Seconds {
        kmeans,
        hulls,
        free_space,
    } = built.seconds;
    ObstaclesReport {
        obstacles: built.obstacles.len(),
        degenerate: built.obstacles.degenerate_count(),
        inertia: built.obstacles.inertia(),
        proven_free_voxels,
        seen_through_voxels: built.free.as_ref().map_or(0, FreeSpace::voxel_count),
        resolution: built.free.as_ref().map(FreeSpace::resolution),
        seconds: kmeans + hulls + free_space,
        kmeans_seconds: kmeans,
        hulls_seconds: hulls,
        free_space_seconds: free_space,
    }
}

pub(crate) fn text(report: &ObstaclesReport) -> String {
    let free = match report.resolution {
        Some(edge) => format!(
            "{} voxels of {} map units proven free for the body",
            report.proven_free_voxels,
            length(edge)
        ),
        None => "no observations, so nothing is proven free".to_owned(),
    };
    format!(
        "{} obstacles ({} degenerate), {free}, in {:.3} s",
        report.obstacles, report.degenerate, report.seconds
    )
}

/// A length in map units, which may be worth anything: three digits after the point where that says something.
fn length(units: f64) -> String {
    if (1e-2..1e6).contains(&units) {
        format!("{units:.3}")
    } else {
        format!("{units:.2e}")
    }
}

/// Free space, hulls and points from above.
pub(crate) fn layers(view: &TopView, points: &[[f64; 3]], built: &Surroundings) -> Vec<Layer> {
    let mut layers = Vec::new();
    if let Some(free) = &built.free {
        layers.push(scene::free_space(
            view,
            &free.voxel_centers(),
            free.resolution(),
        ));
    }
    let hulls: Vec<Vec<[f64; 3]>> = built
        .obstacles
        .obstacles()
        .iter()
        .map(|hull| hull.vertices.clone())
        .collect();
    layers.push(scene::cloud("points", color::POINT, view, points));
    layers.push(scene::hulls(view, &hulls));
    layers
}

fn figure(
    loaded: &LoadedMap,
    built: &Surroundings,
    report: &ObstaclesReport,
    up: Option<Vector>,
) -> Result<Figure, Failure> {
    let view = TopView::new(loaded.up(up), loaded.unit()).map_err(Failure::internal)?;
    Ok(Figure {
        title: "Obstacles, seen from above".to_owned(),
        subtitle: text(report),
        axes: view.names(),
        layers: layers(&view, &loaded.points, built),
    })
}

#[cfg(test)]
mod tests {
    use super::length;

    #[test]
    fn lengths_of_any_size_are_short() {
        for (units, text) in [
            (0.08, "0.080"),
            (12.5, "12.500"),
            (8e298, "8.00e298"),
            (8e-302, "8.00e-302"),
        ] {
            assert_eq!(length(units), text);
        }
    }
}
