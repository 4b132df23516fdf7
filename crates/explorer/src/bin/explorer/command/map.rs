//! `explorer map`: the whole pipeline once: clean, exits, obstacles, path to the best exit.

use serde::Serialize;

use super::clean::{self, CleanReport};
use super::exits::{self, ExitsReport};
use super::obstacles::{self, ObstaclesReport};
use super::plan::{self, PlanReport};
use crate::args::{CleanMethod, ExitRule, Output, Pipeline, Planner, Refiner};
use crate::failure::Failure;
use crate::input::{self, LoadedMap};
use crate::output::deliver;
use crate::planning::{Question, RADIUS_M, Surroundings, at, surroundings};
use crate::plot::{Figure, TopView, color, scene};
use crate::progress::Progress;
use crate::stopwatch::timed;

/// Shares of the way to the exit that are tried as goals, farthest first: behind a door little is
/// seen, so the exit itself is often not proven free.
const SHARES: [f64; 8] = [1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3];

/// The command's JSON object: those of clean, exits, obstacles and plan together.
#[derive(Debug, Serialize)]
struct MapReport {
    points: usize,
    kept: usize,
    removed_indices: Vec<usize>,
    iterations: Option<usize>,
    certificate: Option<clean::CertificateReport>,
    exits: Vec<exits::ExitEntry>,
    unseen_sectors: usize,
    obstacles: usize,
    degenerate: usize,
    inertia: f64,
    proven_free_voxels: usize,
    resolution: Option<f64>,
    status: String,
    path: Vec<[f64; 3]>,
    length: Option<f64>,
    raw_length: Option<f64>,
    checks: usize,
    min_clearance: Option<f64>,
    radius: f64,
    space: String,
    /// Rank of the exit that the path leads to, from 0.
    exit: Option<usize>,
    /// Share of the way to that exit at which the path ends.
    reached: Option<f64>,
    /// All steps together, without reading.
    seconds: f64,
    stage_seconds: StageSeconds,
}

#[derive(Debug, Serialize)]
struct StageSeconds {
    clean: f64,
    exits: f64,
    obstacles: f64,
    plan: f64,
}

/// Everything that the steps found.
struct Outcome {
    clean: CleanReport,
    exits: ExitsReport,
    exits_seconds: f64,
    built: Surroundings,
    obstacles: ObstaclesReport,
    plan: PlanReport,
    /// Rank of the exit and share of the way to it.
    reached: Option<(usize, f64)>,
}

pub(crate) fn run(arguments: &Pipeline, output: &Output) -> Result<(), Failure> {
    let progress = Progress::begin("reading the map");
    let loaded = input::load(&arguments.input)?;
    loaded.check_position("--position", arguments.position)?;
    let outcome = pipeline(&loaded, arguments, output.seed, &progress)?;
    drop(progress);
    let text = [
        clean::text(&outcome.clean),
        exits::text(&outcome.exits, loaded.unit()),
        obstacles::text(&outcome.obstacles),
        path_text(&outcome),
    ];
    let figure = || figure(&loaded, &outcome, arguments);
    deliver(output, &report(&outcome), &text.join("\n"), figure)
}

fn pipeline(
    loaded: &LoadedMap,
    arguments: &Pipeline,
    seed: u64,
    progress: &Progress,
) -> Result<Outcome, Failure> {
    let (position, up) = (arguments.position, arguments.up);
    let units = loaded.units_per_meter(Some(position));
    let radius = arguments.radius.unwrap_or(RADIUS_M * units);
    // What a map unit is worth is a guess where nobody said it, and no exit is refused by a guess.
    let known = arguments.radius.is_some() || loaded.map.scale.meters_per_unit().is_some();
    let min_width = known.then_some(2.0 * radius);
    progress.step("removing outliers");
    let clean = clean::clean(loaded, CleanMethod::Submodular, Some(position), 1)?;
    let points = at(&loaded.points, &clean.kept_indices);
    progress.step("looking for exits");
    let (exits, exits_seconds) = timed(|| {
        exits::exits(
            loaded,
            (&clean.kept_indices, &clean.removed_indices),
            position,
            up,
            ExitRule::RangeAware,
            min_width,
        )
    });
    let exits = exits?;
    progress.step("building obstacles");
    let kept = &clean.kept_indices;
    let mut built = surroundings(loaded, Some(kept), arguments.clusters, units, seed)?;
    if let Some(free) = &mut built.free {
        // The agent is where it is, so that place is free.
        free.add_ball(position, 1.5 * radius)
            .map_err(Failure::internal)?;
    }
    let obstacles = obstacles::report(&built, built.places(radius).len());
    progress.step("planning");
    let proven = built.free.is_some();
    let radius = radius_at(&built, position, radius);
    let mut plan = PlanReport::empty("no-exit", radius, proven);
    let approach = Approach {
        built: &built,
        points: &points,
        position,
        units,
        seed,
    };
    let (reached, seconds) = timed(|| approach.to_best_exit(&exits, &mut plan));
    plan.seconds = seconds;
    Ok(Outcome {
        clean,
        exits,
        exits_seconds,
        obstacles,
        plan,
        reached: reached?,
        built,
    })
}

/// The radius, or less where the agent already is nearer to a hull.
fn radius_at(built: &Surroundings, position: [f64; 3], radius: f64) -> f64 {
    let room = 0.98 * built.obstacles.point_clearance(position);
    if room > 0.0 { radius.min(room) } else { radius }
}

/// What flying towards an exit needs to know.
struct Approach<'a> {
    built: &'a Surroundings,
    points: &'a [[f64; 3]],
    position: [f64; 3],
    units: f64,
    seed: u64,
}

impl Approach<'_> {
    /// A path to the first exit that can be approached, as far as possible.
    fn to_best_exit(
        &self,
        exits: &ExitsReport,
        plan: &mut PlanReport,
    ) -> Result<Option<(usize, f64)>, Failure> {
        let space = self.built.space(self.built.free.is_some())?;
        if !space.ball_is_free(self.position, plan.radius) {
            plan.status = "start-blocked".to_owned();
            return Ok(None);
        }
        for (rank, exit) in exits.exits.iter().enumerate() {
            plan.status = "not-found".to_owned();
            for share in SHARES {
                let [x, y, z] = self.position;
                let [dx, dy, dz] = exit.direction.map(|part| part * exit.range * share);
                let to = [x + dx, y + dy, z + dz];
                if !space.ball_is_free(to, plan.radius) {
                    continue;
                }
                let question = Question {
                    from: self.position,
                    to,
                    radius: plan.radius,
                    space,
                    planner: Planner::RrtConnect,
                    refiner: Refiner::Dag,
                    units_per_meter: self.units,
                    seed: self.seed,
                };
                let bounds = question.bounds(self.points)?;
                plan.take(crate::planning::plan(&question, &bounds)?, self.built);
                if !plan.path.is_empty() {
                    return Ok(Some((rank, share)));
                }
            }
        }
        Ok(None)
    }
}

fn path_text(outcome: &Outcome) -> String {
    let text = plan::text(&outcome.plan);
    match outcome.reached {
        Some((rank, share)) => {
            format!(
                "exit {}: {text}, to {:.0} % of the way",
                rank + 1,
                100.0 * share
            )
        }
        None => text,
    }
}

fn report(outcome: &Outcome) -> MapReport {
    let Outcome {
        clean,
        exits,
        obstacles,
        plan,
        ..
    } = outcome;
    let stage_seconds = StageSeconds {
        clean: clean.seconds,
        exits: outcome.exits_seconds,
        obstacles: obstacles.seconds,
        plan: plan.seconds,
    };
    MapReport {
        points: clean.points,
        kept: clean.kept,
        removed_indices: clean.removed_indices.clone(),
        iterations: clean.iterations,
        certificate: clean.certificate,
        exits: exits.exits.clone(),
        unseen_sectors: exits.unseen_sectors,
        obstacles: obstacles.obstacles,
        degenerate: obstacles.degenerate,
        inertia: obstacles.inertia,
        proven_free_voxels: obstacles.proven_free_voxels,
        resolution: obstacles.resolution,
        status: plan.status.clone(),
        path: plan.path.clone(),
        length: plan.length,
        raw_length: plan.raw_length,
        checks: plan.checks,
        min_clearance: plan.min_clearance,
        radius: plan.radius,
        space: plan.space.clone(),
        exit: outcome.reached.map(|(rank, _)| rank),
        reached: outcome.reached.map(|(_, share)| share),
        seconds: clean.seconds + outcome.exits_seconds + obstacles.seconds + plan.seconds,
        stage_seconds,
    }
}

fn figure(loaded: &LoadedMap, outcome: &Outcome, arguments: &Pipeline) -> Result<Figure, Failure> {
    let view = TopView::new(arguments.up, loaded.unit()).map_err(Failure::internal)?;
    let kept = at(&loaded.points, &outcome.clean.kept_indices);
    let removed = at(&loaded.points, &outcome.clean.removed_indices);
    let removed = scene::cloud("removed", color::REMOVED, &view, &removed);
    let mut layers = vec![removed.opacity(0.45).may_be_cut()];
    if let Some(found) = &outcome.exits.found {
        layers.insert(0, scene::unseen(&view, found));
    }
    layers.extend(obstacles::layers(&view, &kept, &outcome.built));
    if let Some(found) = &outcome.exits.found {
        layers.extend(scene::exits(&view, found));
    }
    layers.extend(scene::paths(
        &view,
        &outcome.plan.raw_path,
        &outcome.plan.path,
    ));
    layers.push(scene::agent(&view, arguments.position));
    Ok(Figure {
        title: "Cleaned map, obstacles, exits and path, seen from above".to_owned(),
        subtitle: format!(
            "{} of {} points kept; {}; {}",
            outcome.clean.kept,
            outcome.clean.points,
            exits::headline(&outcome.exits),
            match outcome.plan.length {
                Some(length) => format!("path {length:.2} {} long", loaded.unit()),
                None => format!("no path ({})", outcome.plan.status),
            }
        ),
        axes: view.names(),
        layers,
    })
}
