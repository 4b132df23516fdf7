//! One turn on the spot by sticks while going up and down: the paper's scan. The turn shows everything, the climbs give the parallax
//! that triangulates it.
//!
//! Slow enough that pictures stay sharp and that every direction is seen from both heights while it is in view: 36 degrees a second
//! on a Tello, a climb or descent of 0.4 m in about 1.3 s.

use core::f64::consts::{PI, TAU};
use core::time::Duration;

use nalgebra::Point3;
use tello_sdk::{Command, Stick};

use super::context::Context;

/// A little more than a full turn, radians, so that the ends overlap.
const FULL_TURN: f64 = TAU + 0.2;
/// Yaw rate at full deflection, radians per second, taken where the drone does not tell its heading.
const FULL_YAW_RATE: f64 = PI / 2.0;
/// Longest turn: a drone that does not get round by then never will.
const LONGEST: Duration = Duration::from_secs(40);
/// Climbs are reversed this much early, seconds of the present speed: the pose is a frame old, and the drone coasts on.
const COAST: f64 = 0.3;
/// Weight of the newest difference in the speed of climbing.
const NEWEST: f64 = 0.5;
/// What must be free beyond the highest and the lowest place of a turn, metres: no stick stops the drone to the centimetre.
const SPARE_M: f64 = 0.10;
/// Coming to rest after the sticks are let go.
const REST: Duration = Duration::from_millis(700);
/// Longest climb or descent in one go, whatever the measured height says: 0.8 m on a Tello.
const LONGEST_CLIMB: Duration = Duration::from_secs(2);
/// Longest return to the height at which the turn began.
const LONGEST_RETURN: Duration = Duration::from_secs(3);
/// The drone is back at its height within this, metres.
const LEVEL_M: f64 = 0.05;

/// What the turn wants next.
#[derive(Debug, PartialEq)]
pub(super) enum Spun {
    Send(Command),
    Wait,
    Done,
}

/// A turn under way.
#[derive(Debug)]
pub(super) struct Spin {
    began: Duration,
    last: Option<Duration>,
    /// Turned so far, radians, clockwise.
    turned: f64,
    heading: Option<f64>,
    /// Where it began, with the map's epoch.
    start: Option<(u64, Point3<f64>)>,
    /// Height above the start, metres.
    raised: f64,
    /// Its change, metres per second.
    climbing: f64,
    rising: bool,
    /// When the present climb or descent began.
    since: Duration,
    /// Height above the ground at the start, metres, as the drone tells it.
    height_m: Option<f64>,
    lowest_m: f64,
    highest_m: f64,
    stage: Stage,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    Turning,
    Returning { until: Duration },
    Resting { until: Duration },
}

impl Spin {
    pub(super) fn new(context: &Context<'_>) -> Self {
        let full = context.config.scan_climb_cm as f64 / 100.0;
        let free = |sign: f64, most: f64| {
            [1.0, 0.75, 0.5]
                .map(|share| share * most)
                .into_iter()
                .find(|&meters| meters > 0.0 && context.vertical_is_free(sign * (meters + SPARE_M)))
                .unwrap_or(0.0)
        };
        let highest_m = free(1.0, full);
        let lowest_m = -free(-1.0, full - highest_m);
        Self {
            began: context.knowledge.now(),
            last: None,
            turned: 0.0,
            heading: None,
            start: context.knowledge.tracked_position(),
            raised: 0.0,
            climbing: 0.0,
            rising: true,
            since: context.knowledge.now(),
            height_m: context.knowledge.height_m(),
            lowest_m,
            highest_m,
            stage: Stage::Turning,
        }
    }

    pub(super) fn next(&mut self, context: &Context<'_>) -> Spun {
        let now = context.knowledge.now();
        if self.last == Some(now) {
            return Spun::Wait;
        }
        self.measure(context, now);
        self.last = Some(now);
        match self.stage {
            Stage::Turning if self.turned < FULL_TURN && now < self.began + LONGEST => {
                let climb = self.climb(context);
                Spun::Send(sticks(climb, context.config.scan_yaw_percent))
            }
            Stage::Turning => {
                let until = now + LONGEST_RETURN;
                self.stage = Stage::Returning { until };
                Spun::Send(Command::RC_ZERO)
            }
            Stage::Returning { until } => {
                let level = self.raised.abs() < LEVEL_M;
                if level || now >= until || !context.knowledge.is_tracking() {
                    self.stage = Stage::Resting { until: now + REST };
                    return Spun::Send(Command::RC_ZERO);
                }
                // Slower and slower towards the right height.
                let climb = (-self.raised * 100.0).clamp(-30.0, 30.0).round() as i64;
                Spun::Send(sticks(climb, 0))
            }
            Stage::Resting { until } if now < until => Spun::Wait,
            Stage::Resting { .. } => Spun::Done,
        }
    }

    /// How far it has turned and climbed.
    fn measure(&mut self, context: &Context<'_>, now: Duration) {
        let seconds = self
            .last
            .map_or(0.0, |last| now.saturating_sub(last).as_secs_f64());
        let heading = context.knowledge.heading();
        self.turned += match (self.heading, heading) {
            (Some(before), Some(after)) => (after - before).sin().atan2((after - before).cos()),
            _ if self.stage == Stage::Turning => {
                seconds * FULL_YAW_RATE * context.config.scan_yaw_percent as f64 / 100.0
            }
            _ => 0.0,
        };
        self.heading = heading;
        let before = self.raised;
        let here = context.knowledge.tracked_position();
        if let (Some((epoch, start)), Some((present, here)), Some(scale)) =
            (self.start, here, context.knowledge.meters_per_unit())
            && epoch == present
        {
            self.raised = context.knowledge.up().dot(&(here - start)) * scale;
        } else if let (Some(start), Some(height)) = (self.height_m, context.knowledge.height_m()) {
            self.raised = height - start;
        }
        if seconds > 0.0 {
            let newest = (self.raised - before) / seconds;
            self.climbing += NEWEST * (newest - self.climbing);
        }
    }

    /// Throttle, percent. Without a pose the drone keeps its height: nothing tells it when to turn back.
    fn climb(&mut self, context: &Context<'_>) -> i64 {
        let tracked = context.knowledge.is_tracking() && self.start.is_some();
        if !tracked || self.highest_m - self.lowest_m <= 0.0 {
            return 0;
        }
        let now = context.knowledge.now();
        let late = now >= self.since + LONGEST_CLIMB;
        let ahead = self.raised + self.climbing * COAST;
        let rising = if self.rising {
            self.raised.max(ahead) < self.highest_m && !late
        } else {
            self.raised.min(ahead) <= self.lowest_m || late
        };
        if rising != self.rising {
            self.rising = rising;
            self.since = now;
        }
        let percent = context.config.scan_throttle_percent;
        if self.rising { percent } else { -percent }
    }
}

/// Throttle and yaw, percent; clockwise is positive.
fn sticks(throttle: i64, yaw: i64) -> Command {
    let stick =
        |percent: i64| Stick::from_percent(percent.clamp(-100, 100)).unwrap_or(Stick::CENTER);
    Command::Rc {
        roll: Stick::CENTER,
        pitch: Stick::CENTER,
        throttle: stick(throttle),
        yaw: stick(yaw),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Mission;
    use super::*;
    use crate::config::MissionConfig;
    use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
    use slam_bridge::{SlamUpdate, TrackingState};
    use tello_sdk::{Attitude, Source, Telemetry};

    const FRAME: Duration = Duration::from_millis(100);
    /// A turn that is not over by then is not over at all: the longest turn, the return and the rest, and more.
    const MOST_FRAMES: u32 = 600;

    /// A drone that obeys sticks; one unit of its map is two metres.
    #[derive(Default)]
    struct Drone {
        /// Share of its speed of climbing that a frame leaves: 0 obeys at once.
        inertia: f64,
        climbing: f64,
        tells_heading: bool,
        tracked: bool,
        is_stuck: bool,
        turned: f64,
        raised_m: f64,
        highest_m: f64,
        lowest_m: f64,
    }

    impl Drone {
        fn obey(&mut self, command: &Command) {
            let Command::Rc { throttle, yaw, .. } = command else {
                panic!("a turn by sticks sends nothing but sticks: {command:?}");
            };
            if self.is_stuck {
                return;
            }
            let seconds = FRAME.as_secs_f64();
            self.turned += f64::from(yaw.percent()) / 100.0 * FULL_YAW_RATE * seconds;
            let wanted = f64::from(throttle.percent()) / 100.0;
            self.climbing = wanted + (self.climbing - wanted) * self.inertia;
            self.raised_m += self.climbing * seconds;
            self.highest_m = self.highest_m.max(self.raised_m);
            self.lowest_m = self.lowest_m.min(self.raised_m);
        }

        fn report(&self, mission: &mut Mission, now: Duration) {
            let mut telemetry = Telemetry::builder(now, Source::Simulated);
            if self.tells_heading {
                // As the drone tells it: whole degrees within half a turn.
                let yaw = self.turned.sin().atan2(self.turned.cos());
                telemetry = telemetry.attitude(Attitude {
                    pitch_deg: 0.0,
                    roll_deg: 0.0,
                    yaw_deg: yaw.to_degrees().round(),
                });
            }
            let up = Vector3::new(0.0, -1.0, 0.0);
            let camera = Isometry3::from_parts(
                Translation3::from(up * (self.raised_m / 2.0)),
                UnitQuaternion::from_axis_angle(&Vector3::y_axis(), self.turned),
            );
            let update = SlamUpdate {
                time: now,
                state: if self.tracked {
                    TrackingState::Tracking
                } else {
                    TrackingState::Lost
                },
                world_from_camera: self.tracked.then_some(camera),
                epoch: 0,
                tracked_points: 100,
            };
            let knowledge = &mut mission.shared.knowledge;
            knowledge.observe(now, &telemetry.build(), Some(&update));
        }

        /// Flies one turn; returns how long it took.
        fn spin(&mut self) -> Duration {
            let mut mission = Mission::new(MissionConfig::default(), 1).unwrap();
            self.report(&mut mission, Duration::ZERO);
            let climb = Vector3::new(0.0, 0.0, 0.4);
            mission
                .shared
                .knowledge
                .calibrate(climb, Vector3::new(0.0, -0.2, 0.0));
            let context = Context {
                shared: &mut mission.shared,
                stages: &mut (),
            };
            let mut spin = Spin::new(&context);
            let mut command = Command::RC_ZERO;
            for frame in 1..=MOST_FRAMES {
                let now = FRAME * frame;
                self.obey(&command);
                self.report(&mut mission, now);
                let context = Context {
                    shared: &mut mission.shared,
                    stages: &mut (),
                };
                match spin.next(&context) {
                    Spun::Send(next) => command = next,
                    Spun::Wait => {}
                    Spun::Done => return now,
                }
            }
            panic!("the turn never ended");
        }
    }

    #[test]
    fn turns_once_around_up_and_down_and_comes_back_level() {
        let mut drone = Drone {
            tells_heading: true,
            tracked: true,
            ..Drone::default()
        };
        let took = drone.spin();
        assert!((FULL_TURN..FULL_TURN + 0.2).contains(&drone.turned));
        assert!(drone.highest_m > 0.3 && drone.highest_m < 0.45);
        assert!(drone.lowest_m > -0.1, "the floor's side is not proven free");
        assert!(drone.raised_m.abs() < LEVEL_M);
        assert!(took < Duration::from_secs(15), "{took:?}");
    }

    #[test]
    fn a_drone_that_coasts_sinks_no_lower_than_what_is_proven_free() {
        // Half of a change of speed after a quarter of a second, as a Tello does.
        let mut drone = Drone {
            inertia: 0.75,
            tells_heading: true,
            tracked: true,
            ..Drone::default()
        };
        drone.spin();
        assert!(drone.lowest_m > -0.5 * SPARE_M, "{}", drone.lowest_m);
        assert!(drone.highest_m > 0.25 && drone.highest_m < 0.4 + 0.5 * SPARE_M);
    }

    #[test]
    fn turns_by_time_where_the_drone_tells_no_heading() {
        let mut drone = Drone {
            tracked: true,
            ..Drone::default()
        };
        drone.spin();
        assert!((FULL_TURN - 0.1..FULL_TURN + 0.2).contains(&drone.turned));
    }

    #[test]
    fn keeps_its_height_without_a_pose() {
        let mut drone = Drone {
            tells_heading: true,
            ..Drone::default()
        };
        drone.spin();
        assert!(drone.turned > FULL_TURN);
        assert_eq!((drone.lowest_m, drone.highest_m), (0.0, 0.0));
    }

    #[test]
    fn gives_up_on_a_drone_that_does_not_turn() {
        let mut drone = Drone {
            tells_heading: true,
            tracked: true,
            is_stuck: true,
            ..Drone::default()
        };
        let took = drone.spin();
        assert!(took >= LONGEST && took < LONGEST + LONGEST_RETURN + 2 * REST);
    }
}
