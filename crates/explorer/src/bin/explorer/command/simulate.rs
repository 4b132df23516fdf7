//! `explorer simulate`: missions in the simulator, faster than real time.

use serde::Serialize;

use crate::args::{Output, Simulate};
use crate::failure::Failure;
use crate::flight::{self, RunReport};
use crate::output::deliver;
use crate::progress::Progress;
use crate::report::figures;

/// The command's JSON object.
#[derive(Debug, Serialize)]
struct SimulateReport {
    world: String,
    perception: String,
    slam: String,
    link: String,
    runs: Vec<RunReport>,
}

pub(crate) fn run(arguments: &Simulate, output: &Output) -> Result<(), Failure> {
    let progress = Progress::begin("building the world");
    let mut runs = Vec::new();
    let mut last = None;
    for run in 0..u64::from(arguments.runs) {
        let seed = output.seed.wrapping_add(run);
        let (flight, report) = flight::fly(&arguments.world, seed, &progress)?;
        runs.push(report);
        last = Some(flight);
    }
    drop(progress);
    let text: Vec<String> = runs.iter().map(flight::text).collect();
    let report = SimulateReport {
        world: arguments.world.clone(),
        perception: arguments.perception.clone(),
        slam: arguments.slam.clone(),
        link: arguments.link.clone(),
        runs,
    };
    deliver(output, &report, &text.join("\n"), || {
        // The picture shows the last mission.
        let flight = last.ok_or_else(|| Failure::internal("nothing was flown"))?;
        Ok(figures::flown(
            &flight,
            &text.last().cloned().unwrap_or_default(),
        ))
    })
}
