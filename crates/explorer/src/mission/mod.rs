//! The exploration mission as a state machine without IO (Tukan et al. 2023, section IV-C).
//!
//! Feed it frames ([`Input::Frame`]) at about 10 Hz, answers of the drone and maps as they come; after every input call
//! [`Mission::poll`] until it says [`Output::Wait`] or [`Output::Finished`]. It reads no clock, socket or file: time
//! and randomness come in from outside, so the same inputs give the same mission.
//!
//! Order: take off, translate until SLAM initialises, turn 360 degrees while going up and down, fly the triangle that fits the plane
//! (A, v), clean, find the exit, build obstacles, plan, refine, fly, repeat; land when no exit is left, when the
//! battery is low, when time is up, or when the pose is lost for good.

mod choice;
mod context;
#[cfg(test)]
mod drawn;
mod edge;
mod event;
mod explored;
mod facing;
mod fly;
mod initialize;
mod knowledge;
mod landing;
mod maneuver;
mod outcome;
mod phase;
mod pilot;
mod record;
mod recover;
mod retreat;
mod scan;
mod spin;
mod survey;
mod take_off;
mod think;
mod trail;

use core::time::Duration;

use rand::SeedableRng;
use rand_pcg::Pcg64;
use slam_bridge::{Map, SlamUpdate};
use tello_sdk::{Command, Telemetry};

use crate::config::{ConfigError, MissionConfig};
use crate::stage::StageObserver;
use context::{Context, Shared};
pub use event::{Event, Goal, Logged};
use explored::Explored;
use knowledge::Knowledge;
use landing::Landing;
pub use outcome::Outcome;
use phase::{Phase, Step};
pub use pilot::CommandOutcome;
use pilot::{Pilot, Undo};
pub use record::{Cycle, MissionRecord, Scan};
use recover::Recover;
use retreat::Retreat;
use take_off::TakeOff;
use think::Think;
pub use trail::TrailPose;

/// Commands that fail in a row before the mission gives up and lands.
const MOST_FAILURES: usize = 6;

/// What a mission is told.
#[derive(Debug, Clone)]
pub enum Input {
    /// A frame's worth of news: the time, the latest telemetry and, if there is one, the SLAM system's update.
    Frame {
        /// On the caller's clock, never going back.
        now: Duration,
        /// The drone's state.
        telemetry: Box<Telemetry>,
        /// The pose and whether to trust it.
        slam: Option<SlamUpdate>,
    },
    /// How a command ended. Answers to a command that is no longer in flight are ignored, so that the late "ok" of a move that a
    /// landing overtook is not taken for the landing's.
    Answer {
        /// The command that was sent.
        to: Command,
        /// How it ended.
        outcome: CommandOutcome,
    },
    /// The map that [`Output::NeedMap`] asked for.
    Map(Box<Map>),
    /// Land now.
    Stop,
}

/// What a mission wants.
#[derive(Debug, Clone, PartialEq)]
pub enum Output {
    /// Send this to the drone. At most one command is in flight, but `stop` and `land` may overtake it.
    Send(Command),
    /// Hand in the whole map.
    NeedMap,
    /// Nothing until the next input.
    Wait,
    /// The mission is over.
    Finished(Outcome),
}

/// A mission under way.
pub struct Mission {
    shared: Shared,
    pilot: Pilot,
    phase: Phase,
}

impl Mission {
    /// A mission that has not taken off yet; `seed` drives planning and clustering.
    ///
    /// # Errors
    /// A field of `config` outside its range.
    pub fn new(config: MissionConfig, seed: u64) -> Result<Self, ConfigError> {
        config.validate()?;
        let shared = Shared {
            config,
            knowledge: Knowledge::default(),
            rng: Pcg64::seed_from_u64(seed),
            explored: Explored::default(),
            epoch: None,
            scene: None,
            map: None,
            last: None,
            retreat: Retreat::default(),
            failures: 0,
            sticks_held: false,
            scans: Vec::new(),
            homing: None,
            home_flights: 0,
            triangle_flown: None,
            cycles: Vec::new(),
            log: Vec::new(),
            outcome: None,
        };
        Ok(Self {
            shared,
            pilot: Pilot::new(),
            phase: Phase::TakeOff(TakeOff::default()),
        })
    }

    /// Takes one piece of news.
    pub fn handle(&mut self, input: Input) {
        match input {
            Input::Frame {
                now,
                telemetry,
                slam,
            } => {
                self.shared
                    .knowledge
                    .observe(now, &telemetry, slam.as_ref());
                if let Some(finished) = self.pilot.tick(&mut self.shared.knowledge) {
                    let failed = finished.outcome != CommandOutcome::Done;
                    self.shared.failures = if failed { self.shared.failures + 1 } else { 0 };
                    if !matches!(self.phase, Phase::Recover(_)) {
                        self.shared.retreat.note(&finished);
                    }
                    self.shared.last = Some(finished);
                }
            }
            Input::Answer { to, outcome } => {
                self.pilot.answer(&to, outcome, self.shared.knowledge.now());
            }
            Input::Map(map) => self.shared.map = Some(*map),
            Input::Stop => self.begin_landing(Outcome::Stopped),
        }
    }

    /// What to do now. `stages` hears of each stage of heavy work.
    pub fn poll(&mut self, stages: &mut dyn StageObserver) -> Output {
        if let Some(outcome) = &self.shared.outcome {
            return Output::Finished(outcome.clone());
        }
        self.watch();
        if let Some(stop) = self.interrupt_lost_flight() {
            return Output::Send(stop);
        }
        if !self.pilot.is_idle() {
            return Output::Wait;
        }
        if self.shared.sticks_held && !matches!(self.phase, Phase::Scan(_)) {
            // Something ended the turn early; the drone refuses moves while the sticks are held.
            self.shared.sticks_held = false;
            return Output::Send(Command::RC_ZERO);
        }
        loop {
            let mut context = Context {
                shared: &mut self.shared,
                stages,
            };
            match self.phase.next(&mut context) {
                // The drone never answers to sticks.
                Step::Send(command @ Command::Rc { .. }) => {
                    self.shared.sticks_held = command != Command::RC_ZERO;
                    return Output::Send(command);
                }
                Step::Send(command) => {
                    self.pilot.start(command.clone(), &self.shared.knowledge);
                    return Output::Send(command);
                }
                Step::Wait => return Output::Wait,
                Step::NeedMap => return Output::NeedMap,
                Step::Become(phase) => self.phase = phase,
                Step::Finish => {
                    let outcome = self.shared.outcome.clone().unwrap_or(Outcome::Stopped);
                    self.shared.outcome = Some(outcome.clone());
                    return Output::Finished(outcome);
                }
            }
        }
    }

    /// What has happened so far.
    #[must_use]
    pub fn record(&self) -> MissionRecord<'_> {
        MissionRecord {
            outcome: self.shared.outcome.as_ref(),
            scans: &self.shared.scans,
            cycles: &self.shared.cycles,
            sites: self.shared.explored.graph(),
            scene: self.shared.scene.as_deref(),
            trail: self.shared.knowledge.trail().poses(),
            meters_per_unit: self.shared.knowledge.meters_per_unit(),
            up: self.shared.knowledge.up().into(),
            log: &self.shared.log,
        }
    }

    /// Battery, time and a drone that keeps failing. The first two send it home while there is charge for that; the rest lands.
    fn watch(&mut self) {
        if !self.phase.is_airborne() {
            return;
        }
        let shared = &self.shared;
        let battery = shared.knowledge.battery_percent();
        if shared.failures >= MOST_FAILURES {
            let answer = last_answer(shared);
            return self.begin_landing(Outcome::DroneFailed { answer });
        }
        if let Some(percent) = battery.filter(|&p| p <= shared.config.battery_floor_percent) {
            return self.begin_landing(Outcome::BatteryLow { percent });
        }
        if shared.homing.is_some() {
            return;
        }
        let reserve = f64::from(shared.config.battery_floor_percent) + shared.charge_home();
        let outcome = match battery {
            Some(percent) if f64::from(percent) <= reserve => Outcome::BatteryLow { percent },
            _ if shared.knowledge.now() > shared.config.time_budget => Outcome::OutOfTime,
            _ => return,
        };
        // The move in flight ends first; then the way home is planned.
        self.shared.homing = Some(outcome);
        self.phase = Phase::Think(Think::again());
    }

    fn begin_landing(&mut self, outcome: Outcome) {
        if matches!(self.phase, Phase::Land(_)) || self.shared.outcome.is_some() {
            return;
        }
        // Landing does not wait for a move to end: the drone obeys `land` at any time.
        self.pilot.abandon();
        self.shared.last = None;
        self.phase = Phase::Land(Landing::new(outcome));
    }

    /// Stops a leg on which the pose was lost; the recovery begins when the drone has answered.
    fn interrupt_lost_flight(&mut self) -> Option<Command> {
        let lost_for = self.shared.knowledge.untracked_for();
        if !self.phase.needs_pose() || lost_for < self.shared.config.lost_patience {
            return None;
        }
        let moving = self.pilot.is_moving();
        let recover = self.recover();
        self.shared.log(Event::Lost);
        self.phase = Phase::Recover(recover);
        if !moving {
            return None;
        }
        self.pilot.interrupt();
        Some(Command::Stop)
    }

    /// Back to the last scan, but only along the move in flight where that is broken off: how far it came is a guess, and the moves before
    /// it would be undone from beside where they ended.
    fn recover(&mut self) -> Recover {
        let now = self.shared.knowledge.now();
        let flown = self.shared.retreat.take().into_iter();
        match self.pilot.undo_last(now) {
            Undo::Nothing => Recover::new(flown.collect()),
            Undo::Done(command) => Recover::new([command].into_iter().chain(flown).collect()),
            Undo::Turning(command) => {
                Recover::after_turn([command].into_iter().chain(flown).collect())
            }
            Undo::Part(command) => Recover::broken_off(command),
        }
    }
}

fn last_answer(shared: &Shared) -> String {
    match shared.last_outcome() {
        Some(CommandOutcome::Refused(answer)) => answer.clone(),
        Some(CommandOutcome::Done) | Some(CommandOutcome::Unknown) | None => "no answer".to_owned(),
    }
}
