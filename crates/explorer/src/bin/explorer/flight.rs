//! Flying simulated missions with live progress, and their figures.

use std::collections::BTreeMap;

use explorer::{FlightSummary, MissionConfig, SimulatedFlight, Stage};
use indoor_sim::{SimConfig, World};
use serde::Serialize;

use crate::failure::Failure;
use crate::progress::Progress;
use crate::stopwatch::{StageTimes, percentile};

/// One mission's part of the JSON object.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct RunReport {
    pub(crate) world: String,
    pub(crate) seed: u64,
    #[serde(flatten)]
    pub(crate) summary: FlightSummary,
    pub(crate) stage_ms: StageMs,
}

/// Milliseconds of computing per stage of a cycle.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct StageMs {
    pub(crate) median: BTreeMap<&'static str, f64>,
    pub(crate) p95: BTreeMap<&'static str, f64>,
}

impl StageMs {
    fn of(times: &StageTimes) -> Self {
        let shares = |share: f64| {
            let stage = |stage: &Stage| Some((stage.word(), percentile(times.of(*stage), share)?));
            Stage::ALL.iter().filter_map(stage).collect()
        };
        Self {
            median: shares(0.5),
            p95: shares(0.95),
        }
    }
}

/// Flies one mission to its end, in virtual time.
pub(crate) fn fly(
    world: &str,
    seed: u64,
    progress: &Progress,
) -> Result<(SimulatedFlight, RunReport), Failure> {
    let advice = "`explorer simulate --help` says more";
    let place = World::named(world, seed).map_err(|error| Failure::new(error, advice))?;
    let (sim, mission) = (SimConfig::default(), MissionConfig::default());
    let mut flight = SimulatedFlight::new(place, sim, mission, seed).map_err(Failure::internal)?;
    let mut times = StageTimes::default();
    let mut told = 0;
    while !flight.is_over() {
        flight.step(&mut times);
        let log = flight.mission().record().log;
        if let Some(logged) = log.get(told..).and_then(<[_]>::last) {
            let seconds = logged.time.as_secs_f64();
            progress.step(format!(
                "{world}, seed {seed}: {seconds:5.0} s  {}",
                logged.event
            ));
            told = log.len();
        }
    }
    let report = RunReport {
        world: world.to_owned(),
        seed,
        summary: flight.summary(),
        stage_ms: StageMs::of(&times),
    };
    Ok((flight, report))
}

/// One line about a mission.
pub(crate) fn text(report: &RunReport) -> String {
    let summary = &report.summary;
    let clearance = summary
        .min_clearance
        .map_or("-".to_owned(), |c| format!("{c:.2} m"));
    format!(
        "{} seed {}: {}, {:.0} % covered, {:.1} m flown in {:.0} s, {} scans, {} collisions, least clearance \
         {clearance}",
        report.world,
        report.seed,
        summary.outcome,
        100.0 * summary.coverage,
        summary.path_length,
        summary.sim_seconds,
        summary.scans,
        summary.collisions,
    )
}
