//! The figures of a simulated mission: the paper's 3b to 3e and 4, and what really happened.

use exit_finder::AffinePlane;
use explorer::{Cycle, MissionRecord, Scene, SimulatedFlight, TrailPose};
use indoor_sim::{SolidKind, World};

use super::input::ReportFigure;
use crate::failure::Failure;
use crate::plot::{Figure, Layer, Shape, TopView, color, scene};

/// Most scans that get a picture.
const MAX_SCANS: usize = 6;

/// Tracked poses since the last reset of the map: only they share its coordinates.
pub(crate) fn newest_trail<'a>(
    record: &MissionRecord<'a>,
) -> impl Iterator<Item = &'a TrailPose> + use<'a> {
    let newest = record.trail.iter().map(|pose| pose.epoch).max();
    record
        .trail
        .iter()
        .filter(move |pose| Some(pose.epoch) == newest)
}

/// Cycles since the last reset of the map.
pub(crate) fn newest_cycles<'a>(record: &MissionRecord<'a>) -> Vec<&'a Cycle> {
    let since = newest_trail(record)
        .next()
        .map(|pose| pose.time)
        .unwrap_or_default();
    record
        .cycles
        .iter()
        .filter(|cycle| cycle.time >= since)
        .collect()
}

/// All figures of a mission, in the order of the paper.
pub(crate) fn of_flight(flight: &SimulatedFlight) -> Result<Vec<ReportFigure>, Failure> {
    let record = flight.mission().record();
    let mut figures = vec![figure(
        "What really happened.",
        "The true floor plan, seen from above, with the path that the drone really flew. The drone \
         knows nothing of this picture.",
        &flown(flight, ""),
    )?];
    let Some(last) = record.scene else {
        return Ok(figures);
    };
    let plane = AffinePlane::from_up(record.up, [0.0; 3]).map_err(Failure::internal)?;
    let view = TopView::of_plane(plane, "map units");
    let cycles = newest_cycles(&record);
    figures.push(raw_map(&view, last)?);
    figures.push(cleaned_map(&view, last)?);
    let scans: Vec<&&Cycle> = cycles
        .iter()
        .filter(|cycle| cycle.exits.is_some())
        .collect();
    let step = scans.len().div_ceil(MAX_SCANS).max(1);
    for cycle in scans.into_iter().step_by(step) {
        figures.extend(profile(&view, cycle)?);
    }
    figures.extend(path(&view, last, &cycles)?);
    Ok(figures)
}

fn figure(name: &str, caption: &str, picture: &Figure) -> Result<ReportFigure, Failure> {
    Ok(ReportFigure {
        name: name.to_owned(),
        caption: caption.to_owned(),
        svg: picture.to_svg().map_err(Failure::internal)?,
    })
}

fn picture(title: &str, subtitle: String, view: &TopView, layers: Vec<Layer>) -> Figure {
    Figure {
        title: title.to_owned(),
        subtitle,
        axes: view.names(),
        layers,
    }
}

fn raw_map(view: &TopView, last: &Scene) -> Result<ReportFigure, Failure> {
    let layers = vec![scene::cloud("map points", color::POINT, view, &last.points)];
    let subtitle = format!("{} points", last.points.len());
    let drawn = picture("Map as it comes from SLAM", subtitle, view, layers);
    figure(
        "Figure 3b.",
        "The final map from above, outliers and all.",
        &drawn,
    )
}

fn cleaned_map(view: &TopView, last: &Scene) -> Result<ReportFigure, Failure> {
    let removed: Vec<[f64; 3]> = last
        .removed
        .iter()
        .filter_map(|index| last.points.get(*index).copied())
        .collect();
    let layers = vec![
        scene::outliers(view, &removed),
        scene::cloud("kept", color::POINT, view, &last.kept_points()),
    ];
    let subtitle = format!("{} of {} points kept", last.kept.len(), last.points.len());
    let drawn = picture("Map without outliers", subtitle, view, layers);
    figure(
        "Figure 3c.",
        "The same map after outlier removal; crosses were removed.",
        &drawn,
    )
}

fn profile(view: &TopView, cycle: &Cycle) -> Result<Option<ReportFigure>, Failure> {
    let Some(report) = &cycle.exits else {
        return Ok(None);
    };
    let mut layers = scene::banded_cloud(view, &cycle.cloud, &report.profile, color::POINT);
    layers.push(scene::spokes(view, &report.profile));
    layers.extend(scene::exits(view, report));
    layers.push(scene::agent(view, report.profile.agent));
    let found = match report.exits.len() {
        0 => "no exit".to_owned(),
        1 => "1 exit".to_owned(),
        more => format!("{more} exits"),
    };
    let seconds = cycle.time.as_secs_f64();
    let drawn = picture(
        "Range profile and exits",
        format!("{found} at {seconds:.0} s"),
        view,
        layers,
    );
    let caption = format!(
        "The scan that ended at {seconds:.0} s: mean range per degree about the drone, and the exits \
         found among the points that were seen from about there."
    );
    figure("Figures 3d and 3e.", &caption, &drawn).map(Some)
}

fn path(view: &TopView, last: &Scene, cycles: &[&Cycle]) -> Result<Option<ReportFigure>, Failure> {
    // The paths of each flight on their own are short; the longest one shows most.
    let longest = cycles
        .iter()
        .max_by(|a, b| length(&a.raw_path).total_cmp(&length(&b.raw_path)));
    let Some(cycle) = longest.filter(|cycle| !cycle.raw_path.is_empty()) else {
        return Ok(None);
    };
    let hulls: Vec<Vec<[f64; 3]>> = last
        .obstacles
        .obstacles()
        .iter()
        .map(|hull| hull.vertices.clone())
        .collect();
    let mut layers = vec![
        scene::free_space(view, &last.free.voxel_centers(), last.free.resolution()),
        scene::hulls(view, &hulls),
    ];
    layers.extend(scene::paths(view, &cycle.raw_path, &cycle.path));
    layers.push(scene::agent(view, cycle.position.into()));
    let subtitle = format!(
        "{:.2} map units as planned, {:.2} refined",
        length(&cycle.raw_path),
        length(&cycle.path)
    );
    let drawn = picture("Obstacles and path", subtitle, view, layers);
    let caption = format!(
        "The longest flight, planned at {:.0} s, among the hulls of the final map; tinted is what the \
         camera has seen through.",
        cycle.time.as_secs_f64()
    );
    figure("Figure 4.", &caption, &drawn).map(Some)
}

fn length(path: &[[f64; 3]]) -> f64 {
    path.windows(2)
        .map(|leg| crate::input::distance(leg[0], leg[1]))
        .sum()
}

/// The true floor plan with the true path.
pub(crate) fn flown(flight: &SimulatedFlight, subtitle: &str) -> Figure {
    let world = flight.simulator().world();
    let truth = flight.simulator().truth();
    let through = truth.trajectory.iter().map(|track| {
        let at = track.world_from_body.translation.vector;
        [at.x, at.y]
    });
    let line = Shape::Line {
        through: through.collect(),
        width: 2.0,
        dashed: false,
    };
    let scans = flight
        .scan_positions()
        .iter()
        .map(|[x, y, _]| [*x, *y])
        .collect();
    let start = truth
        .trajectory
        .first()
        .map(|track| track.world_from_body.translation.vector);
    let start = start.map(|at| vec![[at.x, at.y]]).unwrap_or_default();
    let hits = truth
        .collisions
        .iter()
        .map(|hit| [hit.position[0], hit.position[1]])
        .collect();
    let mut layers = vec![
        Layer::new("wall", color::WALL, boxes(world, SolidKind::Wall)).opacity(0.8),
        Layer::new(
            "furniture",
            color::OBSTACLE,
            boxes(world, SolidKind::Furniture),
        )
        .opacity(0.35),
        Layer::new("path flown", color::PATH, line),
        Layer::new(
            "full turn",
            color::SPOKE,
            Shape::Dots {
                at: scans,
                radius: 5.0,
            },
        ),
        Layer::new(
            "start",
            color::AGENT,
            Shape::Dots {
                at: start,
                radius: 7.0,
            },
        ),
    ];
    let hits = Shape::Crosses {
        at: hits,
        arm: 7.0,
        width: 3.0,
    };
    layers.push(Layer::new("collision", color::REMOVED, hits));
    Figure {
        title: format!("{} and the path flown, seen from above", world.name()),
        subtitle: subtitle.to_owned(),
        axes: ["x [m]".to_owned(), "y [m]".to_owned()],
        layers,
    }
}

/// Outlines of the world's solids of one kind.
fn boxes(world: &World, kind: SolidKind) -> Shape {
    let solids = world.solids().iter().filter(|solid| solid.kind == kind);
    let rings = solids.map(|solid| {
        let ([x0, y0, _], [x1, y1, _]) = (solid.min, solid.max);
        vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    });
    Shape::Polygons {
        rings: rings.collect(),
        rim: 0.5,
    }
}
