//! `explorer exits`: where the place opens.

use exit_finder::{AffinePlane, ExitConfig, ExitReport};
use explorer::{ExitCloud, ExitSeeker};
use serde::Serialize;

use crate::args::{ExitRule, Exits, Output, Vector};
use crate::failure::Failure;
use crate::input::{self, LoadedMap};
use crate::output::deliver;
use crate::planning::RADIUS_M;
use crate::plot::{Figure, TopView, color, scene};

/// Most exits that the text lists.
const LISTED: usize = 6;

/// The command's JSON object.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ExitsReport {
    /// Best first.
    pub(crate) exits: Vec<ExitEntry>,
    /// Sectors that the camera never looked into.
    pub(crate) unseen: Vec<UnseenEntry>,
    /// How many these are.
    pub(crate) unseen_sectors: usize,
    #[serde(skip)]
    pub(crate) found: Option<ExitReport>,
}

/// One way out, in the map's frame and unit.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct ExitEntry {
    /// From the agent, unit vector.
    pub(crate) direction: [f64; 3],
    /// Where to fly: behind the opening.
    pub(crate) position: [f64; 3],
    pub(crate) width_rad: f64,
    /// Distance between the two sides of the opening.
    pub(crate) width: f64,
    /// From the agent to `position`.
    pub(crate) range: f64,
    pub(crate) score: f64,
    /// "empty" or "range-jump".
    pub(crate) kind: String,
}

/// A sector that the camera never looked into, in the map's frame.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct UnseenEntry {
    /// From the agent through the sector's middle, unit vector.
    pub(crate) direction: [f64; 3],
    pub(crate) width_rad: f64,
}

pub(crate) fn run(arguments: &Exits, output: &Output) -> Result<(), Failure> {
    let loaded = input::load(&arguments.input)?;
    loaded.check_position("--position", arguments.position)?;
    let points = &loaded.points;
    let all: Vec<usize> = (0..points.len()).collect();
    // Without a scale nobody knows what is too narrow: then relative widths decide.
    let meters = loaded.map.scale.meters_per_unit();
    let report = exits(
        &loaded,
        (&all, &[]),
        arguments.position,
        arguments.up,
        arguments.rule,
        meters.map(|meters| 2.0 * RADIUS_M / meters),
    )?;
    deliver(output, &report, &text(&report, loaded.unit()), || {
        let subtitle = headline(&report);
        figure(&loaded, points, &report, arguments.up, &subtitle)
    })
}

/// Looks for exits at least `min_width` map units wide. `kept` and `removed` are the indices of what a cleaning kept and took out: what
/// it took out of a thinly seen wall still says that there is one, so those points are looked at too, with a cue for how many they are.
pub(crate) fn exits(
    loaded: &LoadedMap,
    (kept, removed): (&[usize], &[usize]),
    position: Vector,
    up: Vector,
    rule: ExitRule,
    min_width: Option<f64>,
) -> Result<ExitsReport, Failure> {
    let plane = AffinePlane::from_up(up, position).map_err(Failure::internal)?;
    let config = match rule {
        ExitRule::RangeAware => ExitConfig {
            min_width,
            ..ExitConfig::default()
        },
        ExitRule::Paper => ExitConfig::paper(),
    };
    let seeker = ExitSeeker {
        plane: &plane,
        position,
        heading: None,
        closed: &[],
    };
    let cloud = ExitCloud::of(&loaded.map, kept, removed);
    let found = cloud
        .exits(&loaded.map, &seeker, &config)
        .map_err(|error| {
            Failure::new(
                error,
                "check --position and --up, or give a map with more points",
            )
        })?;
    let entry = |exit: &exit_finder::Exit| ExitEntry {
        direction: exit.direction,
        position: exit.position,
        width_rad: exit.width_rad,
        width: exit.width,
        range: exit.range,
        score: exit.score,
        kind: format!("{:?}", exit.kind)
            .replace("RangeJump", "range-jump")
            .to_lowercase(),
    };
    let exits = found.exits.iter().map(entry).collect();
    let unseen = found.unseen.iter().map(|sector| UnseenEntry {
        direction: found.profile.direction(sector.middle_rad()),
        width_rad: sector.width_rad,
    });
    Ok(ExitsReport {
        exits,
        unseen: unseen.collect(),
        unseen_sectors: found.unseen.len(),
        found: Some(found),
    })
}

pub(crate) fn headline(report: &ExitsReport) -> String {
    let exits = match report.exits.len() {
        0 => "no exit: enclosed as far as it was seen".to_owned(),
        1 => "1 exit".to_owned(),
        more => format!("{more} exits"),
    };
    let unseen: f64 = report.unseen.iter().map(|sector| sector.width_rad).sum();
    if unseen > 0.0 {
        format!("{exits}; {:.0} degrees not looked at", unseen.to_degrees())
    } else {
        exits
    }
}

/// A line for each exit.
pub(crate) fn text(report: &ExitsReport, unit: &str) -> String {
    let mut text = headline(report);
    for (rank, exit) in report.exits.iter().enumerate().take(LISTED) {
        let [x, y, z] = exit.direction;
        text.push_str(&format!(
            "\n{}. direction {x:.3},{y:.3},{z:.3}, {:.0} degrees wide, {:.2} {unit} away, score {:.2} ({})",
            rank + 1,
            exit.width_rad.to_degrees(),
            exit.range,
            exit.score,
            exit.kind,
        ));
    }
    if let Some(more) = report.exits.len().checked_sub(LISTED + 1) {
        text.push_str(&format!("\nand {} more (--json lists all)", more + 1));
    }
    text
}

/// The projected map with spokes and exits (the paper's figures 2, 3d and 3e).
pub(crate) fn figure(
    loaded: &LoadedMap,
    points: &[[f64; 3]],
    report: &ExitsReport,
    up: Vector,
    subtitle: &str,
) -> Result<Figure, Failure> {
    let found = report
        .found
        .as_ref()
        .ok_or_else(|| Failure::internal("no profile"))?;
    let view = TopView::new(up, loaded.unit()).map_err(Failure::internal)?;
    let mut layers = scene::banded_cloud(&view, points, &found.profile, color::POINT);
    layers.insert(0, scene::unseen(&view, found));
    layers.push(scene::spokes(&view, &found.profile));
    layers.extend(scene::exits(&view, found));
    layers.push(scene::agent(&view, found.profile.agent));
    Ok(Figure {
        title: "Exits, seen from above".to_owned(),
        subtitle: subtitle.to_owned(),
        axes: view.names(),
        layers,
    })
}
