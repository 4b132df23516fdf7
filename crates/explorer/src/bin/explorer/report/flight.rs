//! A report's data from a simulated mission.

use explorer::{MissionRecord, SimulatedFlight};

use super::figures;
use super::input::{Mesh, ReportInput, ViewerScene};
use crate::failure::Failure;
use crate::flight::RunReport;

/// Everything that the page shows about a mission.
pub(crate) fn of_flight(flight: &SimulatedFlight, run: &RunReport) -> Result<ReportInput, Failure> {
    let record = flight.mission().record();
    let world = &run.world;
    let outcome = record
        .outcome
        .map_or("it did not end".to_owned(), ToString::to_string);
    Ok(ReportInput {
        title: format!("Exploring {world}"),
        lead: format!(
            "A simulated Tello explored {world} on its own, with nothing but its camera's sparse map. {}. \
             The map's unit is arbitrary, as with every monocular camera.",
            capitalized(&outcome)
        ),
        facts: facts(run, &record),
        scene: viewer_scene(&record),
        figures: figures::of_flight(flight)?,
        story: record
            .log
            .iter()
            .map(|logged| {
                (
                    format!("{:.1} s", logged.time.as_secs_f64()),
                    logged.event.to_string(),
                )
            })
            .collect(),
        command: format!("explorer demo --world {world} --seed {}", run.seed),
    })
}

fn facts(run: &RunReport, record: &MissionRecord<'_>) -> Vec<(String, String)> {
    let summary = &run.summary;
    let number = |value: Option<f64>, unit: &str| {
        value.map_or("-".to_owned(), |value| format!("{value:.2} {unit}"))
    };
    let mut facts = vec![
        ("Outcome".to_owned(), summary.outcome.clone()),
        (
            "Coverage".to_owned(),
            format!("{:.1} %", 100.0 * summary.coverage),
        ),
        ("Collisions".to_owned(), summary.collisions.to_string()),
        (
            "Least clearance".to_owned(),
            number(summary.min_clearance, "m"),
        ),
        (
            "Path flown".to_owned(),
            format!("{:.1} m", summary.path_length),
        ),
        (
            "Time in flight".to_owned(),
            format!("{:.0} s", summary.sim_seconds),
        ),
        ("Full turns".to_owned(), summary.scans.to_string()),
        ("Cycles".to_owned(), record.cycles.len().to_string()),
        (
            "Metres per map unit".to_owned(),
            number(record.meters_per_unit, "m"),
        ),
        ("Seed".to_owned(), run.seed.to_string()),
    ];
    if let Some(percent) = summary.battery_percent {
        facts.push(("Battery at the end".to_owned(), format!("{percent} %")));
    }
    for (stage, median) in &run.stage_ms.median {
        let p95 = run.stage_ms.p95.get(stage).copied().unwrap_or_default();
        let name = format!("{}, median (p95)", capitalized(&stage.replace('_', " ")));
        facts.push((name, format!("{median:.0} ms ({p95:.0} ms)")));
    }
    facts
}

fn viewer_scene(record: &MissionRecord<'_>) -> ViewerScene {
    let cycles = figures::newest_cycles(record);
    let mut scene = ViewerScene {
        up: record.up,
        unit: "map units".to_owned(),
        raw_paths: cycles.iter().map(|cycle| cycle.raw_path.clone()).collect(),
        paths: cycles.iter().map(|cycle| cycle.path.clone()).collect(),
        flown: figures::newest_trail(record)
            .map(|pose| pose.world_from_camera.translation.vector.into())
            .collect(),
        ..ViewerScene::default()
    };
    let exits = cycles.iter().filter_map(|cycle| cycle.exits.as_ref());
    scene.exits = exits
        .flat_map(|report| &report.exits)
        .map(|exit| exit.position)
        .collect();
    if let Some(last) = record.scene {
        let point = |index: &usize| last.points.get(*index).copied();
        scene.kept = last.kept_points();
        scene.removed = last.removed.iter().filter_map(point).collect();
        scene.free = last.free.voxel_centers();
        scene.voxel = last.free.resolution();
        let hulls = last.obstacles.obstacles().iter();
        let mesh = hulls.map(|hull| Mesh {
            vertices: hull.vertices.clone(),
            triangles: hull.triangles.clone(),
        });
        scene.obstacles = mesh.collect();
    }
    scene
}

fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
