//! `explorer demo`: the default mission with live progress, and a folder with everything about it.

use std::fs;
use std::path::Path;

use serde::Serialize;
use slam_bridge::nalgebra::Isometry3;
use slam_bridge::{Map, Scale, SlamSource as _, TimedPose, write_ply, write_tum};

use crate::args::{Demo, Output};
use crate::failure::Failure;
use crate::flight::{self, RunReport};
use crate::output::{deliver, write_file};
use crate::progress::Progress;
use crate::report::{self, figures};

/// The command's JSON object and summary.json: a run, also as the list that `simulate` gives.
#[derive(Debug, Serialize)]
struct DemoReport {
    #[serde(flatten)]
    run: RunReport,
    runs: [RunReport; 1],
    report: String,
}

pub(crate) fn run(arguments: &Demo, output: &Output) -> Result<(), Failure> {
    let folder = arguments.output.as_path();
    fs::create_dir_all(folder).map_err(|error| Failure::write(folder, &error))?;
    let progress = Progress::begin("building the world");
    let (flight, run) = flight::fly(&arguments.world, output.seed, &progress)?;
    progress.step("writing the report");
    let page = folder.join("report.html");
    let input = report::of_flight(&flight, &run)?;
    write_file(&page, |file| {
        std::io::Write::write_all(file, report::html(&input).as_bytes())
    })?;
    let summary = DemoReport {
        run: run.clone(),
        runs: [run.clone()],
        report: page.display().to_string(),
    };
    write_file(&folder.join("summary.json"), |file| {
        serde_json::to_writer_pretty(file, &summary).map_err(Into::into)
    })?;
    write_map(&flight, folder)?;
    drop(progress);
    let text = format!("{}\nreport: {}", flight::text(&run), page.display());
    deliver(output, &summary, &text, || {
        Ok(figures::flown(&flight, &flight::text(&run)))
    })
}

/// The final map, the tracked poses and the planned path, all in the map's frame and unit.
fn write_map(flight: &explorer::SimulatedFlight, folder: &Path) -> Result<(), Failure> {
    let record = flight.mission().record();
    let scale = record
        .meters_per_unit
        .map_or(Scale::Unknown, Scale::MetersPerUnit);
    let map = Map {
        scale,
        ..flight.simulator().slam_ref().map()
    };
    write_file(&folder.join("map.ply"), |file| write_ply(&map, file))?;
    let trajectory: Vec<TimedPose> = figures::newest_trail(&record)
        .map(|pose| TimedPose {
            time: pose.time.as_secs_f64(),
            pose: pose.world_from_camera,
        })
        .collect();
    write_file(&folder.join("trajectory.tum"), |file| {
        write_tum(&trajectory, file)
    })?;
    let path: Vec<TimedPose> = record
        .cycles
        .iter()
        .flat_map(|cycle| {
            cycle
                .path
                .iter()
                .map(|point| (cycle.time.as_secs_f64(), *point))
        })
        .map(|(time, [x, y, z])| {
            let pose = Isometry3::translation(x, y, z);
            TimedPose { time, pose }
        })
        .collect();
    write_file(&folder.join("path.tum"), |file| write_tum(&path, file))
}
