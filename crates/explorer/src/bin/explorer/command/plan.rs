//! `explorer plan`: one path on a map.

use serde::Serialize;

use super::clean::clean;
use super::obstacles;
use crate::args::{CleanMethod, Output, Plan, SpaceChoice};
use crate::failure::Failure;
use crate::input;
use crate::output::deliver;
use crate::planning::{
    Answer, Question, RADIUS_M, Surroundings, at, min_clearance, plan, surroundings,
};
use crate::plot::{Figure, TopView, scene};
use crate::progress::Progress;
use crate::stopwatch::timed_median;

/// The command's JSON object; lengths in map units, without a path empty and none.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct PlanReport {
    /// "found" or "not-found"; of `map` also "no-exit" and "start-blocked".
    pub(crate) status: String,
    pub(crate) path: Vec<[f64; 3]>,
    pub(crate) length: Option<f64>,
    /// Length before refinement.
    pub(crate) raw_length: Option<f64>,
    /// Motions checked.
    pub(crate) checks: usize,
    pub(crate) seconds: f64,
    /// Least distance from the path to a hull.
    pub(crate) min_clearance: Option<f64>,
    /// Radius of the body that was planned for.
    pub(crate) radius: f64,
    /// Radius of the ball that the path keeps free away from its ends; at least `radius`.
    pub(crate) berth: Option<f64>,
    /// "hulls" or "proven-free".
    pub(crate) space: String,
    #[serde(skip)]
    pub(crate) raw_path: Vec<[f64; 3]>,
}

impl PlanReport {
    /// A report without a path.
    pub(crate) fn empty(status: &str, radius: f64, proven: bool) -> Self {
        Self {
            status: status.to_owned(),
            path: Vec::new(),
            length: None,
            raw_length: None,
            checks: 0,
            seconds: 0.0,
            min_clearance: None,
            radius,
            berth: None,
            space: if proven { "proven-free" } else { "hulls" }.to_owned(),
            raw_path: Vec::new(),
        }
    }

    /// Takes up what the planner found.
    pub(crate) fn take(&mut self, answer: Answer, built: &Surroundings) {
        self.checks += answer.checks;
        let Some((raw, path, berth)) = answer.paths else {
            return;
        };
        self.status = "found".to_owned();
        self.berth = Some(berth);
        self.length = Some(path.length());
        self.raw_length = Some(raw.length());
        self.raw_path = raw.into_points();
        self.path = path.into_points();
        self.min_clearance = min_clearance(&built.obstacles, &self.path);
    }
}

pub(crate) fn run(arguments: &Plan, output: &Output) -> Result<(), Failure> {
    let progress = Progress::begin("reading the map");
    let loaded = input::load(&arguments.input)?;
    loaded.check_position("--from", arguments.from)?;
    loaded.check_position("--to", arguments.to)?;
    progress.step("removing outliers");
    let cleaned = clean(&loaded, CleanMethod::Submodular, None, 1)?;
    progress.step("building obstacles");
    let units = loaded.units_per_meter(Some(arguments.from));
    let kept = &cleaned.kept_indices;
    let mut built = surroundings(&loaded, Some(kept), arguments.clusters, units, output.seed)?;
    progress.step("planning");
    let proven = match arguments.space {
        Some(choice) => choice == SpaceChoice::ProvenFree,
        None => built.free.is_some(),
    };
    let radius = arguments.radius.unwrap_or(RADIUS_M * units);
    if proven {
        built.open(arguments.from, radius)?;
    }
    let question = Question {
        from: arguments.from,
        to: arguments.to,
        radius,
        space: built.space(proven)?,
        planner: arguments.planner,
        refiner: arguments.refine,
        units_per_meter: units,
        seed: output.seed,
    };
    let points = at(&loaded.points, kept);
    let bounds = question.bounds(&points)?;
    let (answer, seconds) = timed_median(arguments.repeat, || plan(&question, &bounds));
    let mut report = PlanReport::empty("not-found", radius, proven);
    report.seconds = seconds;
    report.take(answer?, &built);
    drop(progress);
    deliver(output, &report, &text(&report), || {
        let view =
            TopView::new(loaded.up(arguments.up), loaded.unit()).map_err(Failure::internal)?;
        Ok(figure(
            &view,
            &points,
            &built,
            &report,
            [arguments.from, arguments.to],
        ))
    })?;
    if report.path.is_empty() {
        let reason = format!("no path found with {} checked motions", report.checks);
        let advice = "make --radius smaller, try --planner rrt-connect or --space hulls";
        return Err(Failure::new(reason, advice));
    }
    Ok(())
}

pub(crate) fn text(report: &PlanReport) -> String {
    match (report.length, report.raw_length) {
        (Some(length), Some(raw)) => {
            let clearance = report
                .min_clearance
                .map_or("no obstacle".to_owned(), |c| format!("{c:.3}"));
            format!(
                "path of {} legs, {length:.3} map units long ({raw:.3} before refinement), least clearance \
                 {clearance}, {}, in {:.3} s",
                report.path.len().saturating_sub(1),
                if report.space == "hulls" {
                    "among hulls"
                } else {
                    "through proven-free space"
                },
                report.seconds
            )
        }
        _ => format!("no path ({})", report.status),
    }
}

/// Obstacles with the raw and the refined path (the paper's figure 4).
pub(crate) fn figure(
    view: &TopView,
    points: &[[f64; 3]],
    built: &Surroundings,
    report: &PlanReport,
    ends: [[f64; 3]; 2],
) -> Figure {
    let mut layers = obstacles::layers(view, points, built);
    layers.extend(scene::paths(view, &report.raw_path, &report.path));
    layers.push(scene::agent(view, ends[0]));
    layers.extend(scene::x_marks("goal", &[view.project(ends[1])], 9.0));
    Figure {
        title: "Path, seen from above".to_owned(),
        subtitle: text(report),
        axes: view.names(),
        layers,
    }
}
