//! A mission flown in the simulator, in virtual time, and the figures of it that only the simulator's truth can give.

use core::time::Duration;

use indoor_sim::{SimConfig, Simulator, World, coverage};
use nalgebra::Point3;
use serde::Serialize;
use slam_bridge::SlamSource;
use tello_sdk::Command;

use crate::config::{ConfigError, MissionConfig};
use crate::mission::{CommandOutcome, Input, Mission, Outcome, Output};
use crate::stage::StageObserver;

/// Time between two looks of the mission at the world: the camera's and the telemetry's period.
const FRAME: Duration = Duration::from_millis(100);

/// Places seen from a scan count as covered up to this distance, metres (reference protocol).
const COVERAGE_RANGE_M: f64 = 5.0;

/// Virtual time after which a mission that has not ended is taken to hang. The battery ends every flight long before.
const LONGEST_FLIGHT: Duration = Duration::from_secs(30 * 60);

/// Why a simulated flight could not begin.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The mission's configuration.
    #[error(transparent)]
    Mission(#[from] ConfigError),
    /// The simulator's configuration.
    #[error(transparent)]
    Simulator(#[from] indoor_sim::ConfigError),
}

/// What a flight achieved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlightSummary {
    /// How the mission ended, one word; "hung" if it did not.
    pub outcome: String,
    /// Share of the reachable free area within 5 m and in sight of a full scan.
    pub coverage: f64,
    /// Length flown, metres.
    pub path_length: f64,
    /// Virtual time from start to landing, seconds.
    pub sim_seconds: f64,
    /// Full turns.
    pub scans: usize,
    /// Contacts with something solid.
    pub collisions: usize,
    /// Least distance from the drone's centre to anything solid but the floor, metres; absent if it never flew.
    pub min_clearance: Option<f64>,
    /// Charge at the end, percent.
    pub battery_percent: Option<u8>,
}

/// A simulated drone and the mission that flies it.
pub struct SimulatedFlight {
    simulator: Simulator,
    mission: Mission,
    /// What the drone was asked last and may still answer.
    asked: Option<Command>,
    outcome: Option<Outcome>,
}

impl SimulatedFlight {
    /// A drone on the ground of `world`. `seed` drives the simulator's noise and the mission's planning.
    ///
    /// # Errors
    /// A number of either configuration outside its range.
    pub fn new(
        world: World,
        sim: SimConfig,
        mission: MissionConfig,
        seed: u64,
    ) -> Result<Self, SimulationError> {
        Ok(Self {
            simulator: Simulator::new(world, sim, seed)?,
            mission: Mission::new(mission, seed)?,
            asked: None,
            outcome: None,
        })
    }

    /// Flies on by a tenth of a second of virtual time. Returns the outcome once the mission is over.
    pub fn step(&mut self, stages: &mut dyn StageObserver) -> Option<&Outcome> {
        if self.outcome.is_none() && self.simulator.now() < LONGEST_FLIGHT {
            self.simulator.advance(FRAME);
            self.report_frame();
            self.obey(stages);
        }
        self.outcome.as_ref()
    }

    /// Whether there is nothing more to fly: the mission is over, or has hung.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.outcome.is_some() || self.simulator.now() >= LONGEST_FLIGHT
    }

    /// The mission.
    #[must_use]
    pub fn mission(&self) -> &Mission {
        &self.mission
    }

    /// The simulator.
    #[must_use]
    pub fn simulator(&self) -> &Simulator {
        &self.simulator
    }

    /// The figures so far.
    #[must_use]
    pub fn summary(&self) -> FlightSummary {
        let truth = self.simulator.truth();
        let battery = self.simulator.telemetry().battery;
        FlightSummary {
            outcome: self
                .outcome
                .as_ref()
                .map_or("hung", Outcome::word)
                .to_owned(),
            coverage: coverage(
                self.simulator.world(),
                &self.scan_positions(),
                COVERAGE_RANGE_M,
            ),
            path_length: truth.path_length,
            sim_seconds: self.simulator.now().as_secs_f64(),
            scans: self.mission.record().scans.len(),
            collisions: truth.collisions.len(),
            min_clearance: truth
                .min_clearance
                .is_finite()
                .then_some(truth.min_clearance),
            battery_percent: battery.map(|reading| reading.value.percent()),
        }
    }

    /// Where the drone really was when each full turn began, metres.
    #[must_use]
    pub fn scan_positions(&self) -> Vec<[f64; 3]> {
        let trajectory = &self.simulator.truth().trajectory;
        let position = |time: Duration| {
            let next = trajectory.partition_point(|track| track.time < time);
            let track = trajectory.get(next).or_else(|| trajectory.last())?;
            Some(Point3::from(track.world_from_body.translation.vector).into())
        };
        self.mission
            .record()
            .scans
            .iter()
            .filter_map(|scan| position(scan.time))
            .collect()
    }

    fn report_frame(&mut self) {
        while let Some(reply) = self.simulator.poll_reply() {
            let outcome = if reply.refusal().is_some() {
                CommandOutcome::Refused(reply.raw)
            } else {
                CommandOutcome::Done
            };
            // Of what was interrupted the simulated drone says nothing more: it answers what was sent last.
            if let Some(to) = self.asked.clone() {
                self.mission.handle(Input::Answer { to, outcome });
            }
        }
        let mut updates = Vec::new();
        while let Some(update) = self.simulator.slam().poll() {
            updates.push(update);
        }
        let telemetry = Box::new(self.simulator.telemetry());
        let now = self.simulator.now();
        let newest = updates.pop();
        for update in updates {
            self.mission.handle(Input::Frame {
                now,
                telemetry: telemetry.clone(),
                slam: Some(update),
            });
        }
        self.mission.handle(Input::Frame {
            now,
            telemetry,
            slam: newest,
        });
    }

    fn obey(&mut self, stages: &mut dyn StageObserver) {
        loop {
            match self.mission.poll(stages) {
                Output::Send(command) => {
                    if let Err(refused) = self.simulator.send(&command) {
                        let outcome = CommandOutcome::Refused(refused.to_string());
                        self.mission.handle(Input::Answer {
                            to: command,
                            outcome,
                        });
                    } else if !matches!(command, Command::Rc { .. }) {
                        self.asked = Some(command);
                    }
                }
                Output::NeedMap => {
                    let map = self.simulator.slam_ref().map();
                    self.mission.handle(Input::Map(Box::new(map)));
                }
                Output::Wait => return,
                Output::Finished(outcome) => {
                    self.outcome = Some(outcome);
                    return;
                }
            }
        }
    }
}
