//! The layers that the figures of all commands are made of.

use core::f64::consts::TAU;
use std::collections::BTreeSet;

use exit_finder::{BinStats, ExitReport, RangeProfile};

use super::axes::TopView;
use super::figure::{Color, Layer, Shape, color};
use super::outline::outline;

/// Points of a cloud, not bound to the frame.
pub(crate) fn cloud(label: &str, tint: Color, view: &TopView, points: &[[f64; 3]]) -> Layer {
    let at = view.project_all(points);
    // Large clouds need finer dots.
    let radius = if at.len() > 20_000 {
        0.6
    } else if at.len() > 4_000 {
        0.9
    } else {
        1.3
    };
    let label = format!("{label} ({})", at.len());
    Layer::new(label, tint, Shape::Dots { at, radius })
        .opacity(0.75)
        .may_leave_frame()
}

/// Removed points, to be drawn under the kept ones; thousands of them with finer crosses.
pub(crate) fn outliers(view: &TopView, points: &[[f64; 3]]) -> Layer {
    let (arm, width) = if points.len() > 1000 {
        (1.4, 0.7)
    } else {
        (2.1, 1.0)
    };
    let at = view.project_all(points);
    let shape = Shape::Crosses { at, arm, width };
    let label = format!("removed ({})", points.len());
    Layer::new(label, color::REMOVED, shape)
        .opacity(0.8)
        .may_be_cut()
}

/// The points that the profile looked at, and the fainter others above and below.
pub(crate) fn banded_cloud(
    view: &TopView,
    points: &[[f64; 3]],
    profile: &RangeProfile,
    tint: Color,
) -> Vec<Layer> {
    if profile.band.is_none() {
        return vec![cloud("points", tint, view, points)];
    }
    let (inside, outside): (Vec<[f64; 3]>, Vec<[f64; 3]>) = points
        .iter()
        .copied()
        .partition(|&point| profile.holds(point));
    vec![
        cloud("points above and below", color::OUTSIDE, view, &outside).opacity(0.8),
        cloud("points that count", tint, view, &inside),
    ]
}

/// Space that was seen through: a square for every column of voxels.
pub(crate) fn free_space(view: &TopView, centers: &[[f64; 3]], edge: f64) -> Layer {
    let key = |point: &[f64; 2]| point.map(|x| (x / edge).floor() as i64);
    let columns: BTreeSet<[i64; 2]> = view.project_all(centers).iter().map(key).collect();
    let square = |[i, j]: &[i64; 2]| {
        let [x, y] = [*i as f64 * edge, *j as f64 * edge];
        vec![[x, y], [x + edge, y], [x + edge, y + edge], [x, y + edge]]
    };
    let rings = columns.iter().map(square).collect();
    let label = format!("proven free ({} voxels)", centers.len());
    Layer::new(label, color::FREE, Shape::Polygons { rings, rim: 0.0 })
        .opacity(0.45)
        .may_leave_frame()
}

/// The agent, a large dot.
pub(crate) fn agent(view: &TopView, position: [f64; 3]) -> Layer {
    let shape = Shape::Dots {
        at: vec![view.project(position)],
        radius: 7.0,
    };
    Layer::new("agent", color::AGENT, shape)
}

/// A spoke from the agent to the mean range of each bin that holds more than one point
/// (figure 3d).
pub(crate) fn spokes(view: &TopView, profile: &RangeProfile) -> Layer {
    let from = view.project(profile.agent);
    let bins = profile.bins.len().max(1) as f64;
    let spoke = |(index, bin): (usize, &BinStats)| {
        let bearing = (index as f64 + 0.5) / bins * TAU;
        let direction = profile.plane.direction([bearing.cos(), bearing.sin()]);
        let [dx, dy] = view.direction(direction).map(|part| part * bin.mean);
        (bin.count > 1 && bin.mean.is_finite()).then_some([from, [from[0] + dx, from[1] + dy]])
    };
    let ends = profile.bins.iter().enumerate().filter_map(spoke).collect();
    Layer::new(
        "mean range per bin",
        color::SPOKE,
        Shape::Segments { ends, width: 1.0 },
    )
    .opacity(0.55)
    .may_leave_frame()
}

/// Sectors that the camera never looked into, as far as the median range.
pub(crate) fn unseen(view: &TopView, report: &ExitReport) -> Layer {
    let profile = &report.profile;
    let from = view.project(profile.agent);
    let fan = |sector: &exit_finder::Sector| {
        let steps = (sector.width_rad / 0.05).ceil().max(1.0);
        let corner = |step: u32| {
            let bearing = sector.start_rad + sector.width_rad * f64::from(step) / steps;
            view.project(profile.at(bearing, profile.median_range))
        };
        let rim = (0..=steps as u32).map(corner);
        core::iter::once(from).chain(rim).collect()
    };
    let rings = report.unseen.iter().map(fan).collect();
    Layer::new(
        "not looked at",
        color::UNSEEN,
        Shape::Polygons { rings, rim: 0.0 },
    )
    .opacity(0.5)
}

/// Exits: translucent sectors up to the jambs, a yellow X behind each; the best one larger.
pub(crate) fn exits(view: &TopView, report: &ExitReport) -> Vec<Layer> {
    let from = view.project(report.profile.agent);
    let sector = |jambs: &[[f64; 3]; 2]| vec![from, view.project(jambs[0]), view.project(jambs[1])];
    let rings = report
        .exits
        .iter()
        .map(|exit| sector(&exit.jambs))
        .collect();
    let mut layers =
        vec![Layer::new("opening", color::EXIT, Shape::Polygons { rings, rim: 0.6 }).opacity(0.22)];
    let places: Vec<[f64; 2]> = report
        .exits
        .iter()
        .map(|exit| view.project(exit.position))
        .collect();
    let (best, others) = places.split_at(places.len().min(1));
    layers.extend(x_marks("exit", others, 7.0));
    layers.extend(x_marks("best exit", best, 11.0));
    layers
}

/// A dark X under a yellow one, so that it stands out on any ground.
pub(crate) fn x_marks(label: &str, at: &[[f64; 2]], arm: f64) -> [Layer; 2] {
    let cross = |width: f64| Shape::Crosses {
        at: at.to_vec(),
        arm,
        width,
    };
    [
        Layer::new("", color::EXIT_RIM, cross(7.0)).unlabelled(),
        Layer::new(label, color::EXIT, cross(4.0)),
    ]
}

/// Hulls seen from above; each is given by its corners.
pub(crate) fn hulls(view: &TopView, hulls: &[Vec<[f64; 3]>]) -> Layer {
    let rings = hulls
        .iter()
        .map(|corners| outline(view.project_all(corners)))
        .collect();
    let label = format!("obstacle hulls ({})", hulls.len());
    Layer::new(label, color::OBSTACLE, Shape::Polygons { rings, rim: 1.0 })
        .opacity(0.16)
        .may_leave_frame()
}

/// The path as planned, dashed, below the path as refined.
pub(crate) fn paths(view: &TopView, raw: &[[f64; 3]], refined: &[[f64; 3]]) -> [Layer; 2] {
    [
        path("path as planned", color::RAW_PATH, view, raw, true),
        path("path as refined", color::PATH, view, refined, false),
    ]
}

/// A planned or flown path.
pub(crate) fn path(
    label: &str,
    tint: Color,
    view: &TopView,
    through: &[[f64; 3]],
    dashed: bool,
) -> Layer {
    let width = if dashed { 2.0 } else { 3.0 };
    Layer::new(
        label,
        tint,
        Shape::Line {
            through: view.project_all(through),
            width,
            dashed,
        },
    )
}
