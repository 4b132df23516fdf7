//! World, drone and SLAM stand-in, driven by commands and by time.

use core::time::Duration;
use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::{Isometry3, Similarity3};
use tello_sdk::{Command, Refusal, Reply, Telemetry};

use crate::answer::answer;
use crate::camera::Camera;
use crate::drone::{Drone, DroneConfig, Order, Phase, StepEvent};
use crate::slam::{SlamConfig, SyntheticSlam};
use crate::truth::{Collision, TrackPoint, Truth};
use crate::world::World;
use crate::{ConfigError, telemetry};

/// All numbers of a simulation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SimConfig {
    /// The drone.
    pub drone: DroneConfig,
    /// Its camera.
    pub camera: Camera,
    /// The SLAM stand-in.
    pub slam: SlamConfig,
}

impl SimConfig {
    /// No noise anywhere, one map unit a metre: for tests that need to know the answer.
    #[must_use]
    pub fn exact() -> Self {
        Self {
            drone: DroneConfig::exact(),
            camera: Camera::default(),
            slam: SlamConfig::exact(),
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] names the first number that is out of its range.
    pub fn validate(&self) -> Result<(), ConfigError> {
        self.drone.validate()?;
        self.camera.validate()?;
        self.slam.validate()
    }
}

/// The drone refuses a command; its state is unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{refusal}")]
pub struct Refused {
    /// Why.
    pub refusal: Refusal,
}

/// A drone in a world, in virtual time: send commands, advance, poll.
///
/// ```
/// use core::time::Duration;
/// use indoor_sim::{SimConfig, Simulator, World};
/// use tello_sdk::{Command, ReplyKind};
///
/// let world = World::named("one-door-room", 1)?;
/// let mut sim = Simulator::new(world, SimConfig::default(), 1)?;
/// sim.send(&Command::TakeOff)?;
/// sim.advance(Duration::from_secs(5));
/// assert_eq!(sim.poll_reply().map(|reply| reply.kind), Some(ReplyKind::Ok));
/// assert!(sim.is_flying());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Simulator {
    world: Arc<World>,
    camera: Camera,
    drone: Drone,
    slam: SyntheticSlam,
    truth: Truth,
    replies: VecDeque<Reply>,
    /// Whether a reply is owed for the manoeuvre under way.
    owed: bool,
    now: Duration,
    remainder: Duration,
    next_picture: Duration,
    next_telemetry: Duration,
    last_heard: Duration,
    motor_time: Duration,
    telemetry: Telemetry,
}

/// Inner time step. Motion within it is taken as straight.
const STEP: Duration = Duration::from_millis(20);

/// Time between telemetry samples.
const TELEMETRY_PERIOD: Duration = Duration::from_millis(100);

impl Simulator {
    /// A drone that stands at the world's start. `seed` draws motion errors and everything in the SLAM stand-in.
    ///
    /// # Errors
    /// [`ConfigError::OutOfRange`] names the first number that is out of its range.
    pub fn new(world: World, config: SimConfig, seed: u64) -> Result<Self, ConfigError> {
        config.validate()?;
        let world = Arc::new(world);
        let drone = Drone::new(config.drone, &world, seed);
        let slam = SyntheticSlam::new(Arc::clone(&world), config.camera.clone(), config.slam, seed);
        let telemetry = telemetry::sample(&drone, &world, Duration::ZERO, Duration::ZERO);
        Ok(Self {
            world,
            camera: config.camera,
            drone,
            slam,
            truth: Truth::default(),
            replies: VecDeque::new(),
            owed: false,
            now: Duration::ZERO,
            remainder: Duration::ZERO,
            next_picture: Duration::ZERO,
            next_telemetry: Duration::ZERO,
            last_heard: Duration::ZERO,
            motor_time: Duration::ZERO,
            telemetry,
        })
    }

    /// Gives the drone a command. Moves are answered when they are over (see [`Simulator::poll_reply`]), queries and
    /// settings at once, `rc`, `emergency` and `reboot` never. `stop`, `land`, `emergency` and queries work at any time.
    ///
    /// # Errors
    /// [`Refused`], as the real drone refuses: busy with another move (`error Not joystick`), motors off or battery low
    /// (`error Motor stop`), a command that the simulated drone does not know (curves, flips, mission pads).
    pub fn send(&mut self, command: &Command) -> Result<(), Refused> {
        self.last_heard = self.now;
        if let Command::Query(query) = command {
            let text = answer(*query, &self.drone, &self.telemetry);
            self.replies.push_back(Reply::parse(text.as_bytes()));
            return Ok(());
        }
        let interrupts = matches!(command, Command::Stop | Command::Land | Command::Emergency);
        let harmless = matches!(
            command,
            Command::EnterSdk | Command::StreamOn | Command::StreamOff
        );
        if self.drone.is_busy() && !interrupts && !harmless {
            return Err(Refused {
                refusal: Refusal::NotJoystick,
            });
        }
        if self.drone.is_busy() && self.drone.is_landing() && interrupts {
            return Err(Refused {
                refusal: Refusal::AutoLand,
            });
        }
        match self
            .drone
            .order(command)
            .map_err(|refusal| Refused { refusal })?
        {
            Order::Begun => self.owed = true,
            Order::Done => self.reply("ok"),
            Order::Silent => {}
        }
        if matches!(command, Command::TakeOff) {
            self.truth.takeoffs += 1;
        }
        Ok(())
    }

    /// Lets time pass, in steps of 20 ms; what is left over is added next time.
    pub fn advance(&mut self, dt: Duration) {
        let mut left = self.remainder + dt;
        while left >= STEP {
            left -= STEP;
            self.step();
        }
        self.remainder = left;
    }

    /// The next reply of the drone, oldest first.
    pub fn poll_reply(&mut self) -> Option<Reply> {
        self.replies.pop_front()
    }

    /// Time since the simulation began; a multiple of the inner step.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.now
    }

    /// The newest telemetry, at most 0.1 s old.
    #[must_use]
    pub fn telemetry(&self) -> Telemetry {
        self.telemetry
    }

    /// The SLAM stand-in; poll it for updates and for its map.
    pub fn slam(&mut self) -> &mut SyntheticSlam {
        &mut self.slam
    }

    /// The same, for reading.
    #[must_use]
    pub fn slam_ref(&self) -> &SyntheticSlam {
        &self.slam
    }

    /// The world.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// What really happened, for evaluation only.
    #[must_use]
    pub fn truth(&self) -> &Truth {
        &self.truth
    }

    /// Where the drone really is: body to world, for evaluation only.
    #[must_use]
    pub fn pose(&self) -> Isometry3<f64> {
        self.drone.world_from_body()
    }

    /// Where the camera really is: camera (x right, y down, z forward) to world, for evaluation only.
    #[must_use]
    pub fn camera_pose(&self) -> Isometry3<f64> {
        self.drone.world_from_body() * self.camera.body_from_camera()
    }

    /// Map coordinates to the world's, for evaluation only; `None` before there is a map.
    #[must_use]
    pub fn world_from_map(&self) -> Option<Similarity3<f64>> {
        self.slam.world_from_map()
    }

    /// Whether the drone stands, flies or has crashed.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.drone.phase
    }

    /// Whether it is in the air.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.drone.phase == Phase::Flying
    }

    /// Whether a move is under way, so that another would be refused.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.drone.is_busy()
    }

    /// How long nothing was sent to the drone.
    pub(crate) fn silence(&self) -> Duration {
        self.now.saturating_sub(self.last_heard)
    }

    /// All the time given so far, also what is not yet a whole step.
    pub(crate) fn time(&self) -> Duration {
        self.now + self.remainder
    }

    /// Where the drone stood at power-on: body to world.
    pub(crate) fn start_pose(&self) -> Isometry3<f64> {
        let start = self.world.start();
        let [x, y] = [start.position[0], start.position[1]];
        let heading = nalgebra::Vector3::z() * start.yaw_degrees.to_radians();
        Isometry3::new(
            nalgebra::Vector3::new(x, y, self.drone.config.radius),
            heading,
        )
    }

    fn reply(&mut self, text: &str) {
        self.replies.push_back(Reply::parse(text.as_bytes()));
    }

    fn step(&mut self) {
        if self.now >= self.next_picture {
            self.take_picture();
        }
        let before = self.drone.position();
        let event = self.drone.step(STEP.as_secs_f64(), &self.world);
        self.now += STEP;
        if self.drone.phase == Phase::Flying {
            self.motor_time += STEP;
            self.truth.path_length += (self.drone.position() - before).norm();
            let clearance = self.world.wall_clearance(self.drone.position().into());
            self.truth.min_clearance = self.truth.min_clearance.min(clearance);
        }
        self.handle(event);
        self.watch_over();
        if self.now >= self.next_telemetry {
            self.next_telemetry = self.now + TELEMETRY_PERIOD;
            self.telemetry = telemetry::sample(&self.drone, &self.world, self.now, self.motor_time);
        }
    }

    fn take_picture(&mut self) {
        self.next_picture = self.now + Duration::from_secs_f64(1.0 / self.camera.rate);
        let world_from_body = self.drone.world_from_body();
        self.truth.trajectory.push(TrackPoint {
            time: self.now,
            world_from_body,
        });
        let pose = self.camera_pose();
        self.slam.observe(self.now, &pose, self.drone.yaw_rate());
    }

    fn handle(&mut self, event: StepEvent) {
        match event {
            StepEvent::Nothing => {}
            StepEvent::Finished => {
                self.last_heard = self.now;
                if core::mem::take(&mut self.owed) {
                    self.reply(if self.drone.phase == Phase::Crashed {
                        "error Motor stop"
                    } else {
                        "ok"
                    });
                }
            }
            StepEvent::TimedOut => {
                if core::mem::take(&mut self.owed) {
                    self.reply("error Run timeout");
                }
            }
            StepEvent::Collided { solid } => {
                let position = self.drone.position().into();
                self.truth.collisions.push(Collision {
                    time: self.now,
                    position,
                    solid,
                });
                self.truth.min_clearance = self.truth.min_clearance.min(self.drone.config.radius);
                if core::mem::take(&mut self.owed) {
                    self.reply("error Motor stop");
                }
            }
        }
    }

    /// Lands by itself on a low battery or when nobody has spoken for long.
    fn watch_over(&mut self) {
        if self.drone.phase != Phase::Flying || self.drone.is_landing() {
            return;
        }
        let low = self.drone.charge.percent() <= self.drone.config.landing_percent;
        let silence = self.now.saturating_sub(self.last_heard);
        let silent = !self.drone.is_busy()
            && self
                .drone
                .config
                .silence_limit
                .is_some_and(|limit| silence > limit);
        if low || silent {
            self.drone.begin_landing();
            if core::mem::take(&mut self.owed) {
                self.reply("error Auto land");
            }
        }
    }
}
