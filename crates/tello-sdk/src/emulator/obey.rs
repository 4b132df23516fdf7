//! What the drone does with each command.

use super::link::Packet;
use super::physics::{Action, Physics};
use super::{Channel, Emulator, LOG_LIMIT, Received, Running, WhenBusy};
use crate::command::{Class, Command, FrameRate, ParseCommandError, SdkVersion};
use crate::reply::Refusal;
use crate::session::Sticks;
use alloc::format;
use alloc::string::{String, ToString};
use core::net::SocketAddr;
use core::time::Duration;

impl<P: Physics> Emulator<P> {
    pub(super) fn obey(&mut self, packet: Packet) {
        let Ok(text) = core::str::from_utf8(&packet.bytes) else {
            return;
        };
        let text = text.trim_matches(|c: char| c.is_ascii_whitespace() || c == '\0');
        if self.log.len() < LOG_LIMIT {
            let is_copy = packet.is_copy;
            self.log.push(Received {
                at: self.now,
                text: text.to_string(),
                is_copy,
            });
        }
        let from = packet.from;
        self.answering = Some(self.arrived);
        self.answers_doubled = packet.doubled;
        self.arrived += 1;
        self.understand(text, from);
        self.answering = None;
        self.answers_doubled = false;
    }

    fn understand(&mut self, text: &str, from: SocketAddr) {
        if self.client.is_none() && text != "command" {
            return;
        }
        self.last_command = self.now;
        match Command::parse(text) {
            Ok(command) if self.knows(&command) => self.carry_out(command, from),
            Ok(_) | Err(ParseCommandError::Unknown) if text != "keepalive" => {
                self.answer(from, &format!("unknown command: {text}"));
            }
            Ok(_) | Err(ParseCommandError::Unknown) => self.answer(from, "ok"),
            Err(ParseCommandError::Argument { .. } | ParseCommandError::Credentials(_)) => {
                self.answer(from, "error");
            }
            Err(ParseCommandError::Arc(_)) => self.answer(from, "error Radius is too large!"),
            Err(_) => self.answer(from, "out of range"),
        }
    }

    fn knows(&self, command: &Command) -> bool {
        command.since() <= self.config.version
    }

    fn carry_out(&mut self, command: Command, from: SocketAddr) {
        match command.class() {
            Class::Query => self.answer_query(&command, from),
            Class::Sticks => self.stick(&command),
            Class::Safety => self.stop_something(command, from),
            Class::Motion => self.start_motion(command, from),
            Class::Setting => self.set(&command, from),
            Class::Once => {
                self.client = None;
                self.camera.next = None;
                if command != Command::Reboot {
                    self.answer(from, "OK, drone will reboot in 3s");
                }
            }
        }
    }

    fn set(&mut self, command: &Command, from: SocketAddr) {
        match command {
            Command::EnterSdk => self.client = Some(from),
            Command::SetSpeed(speed) => self.speed = speed.meters_per_s(),
            Command::StreamOn => self.camera.start(self.now),
            Command::PadsOn => self.looks_for_pads = true,
            Command::PadsOff => self.looks_for_pads = false,
            Command::PadDirection(direction) => self.pad_direction = *direction,
            Command::StreamOff => self.camera.next = None,
            Command::SetFrameRate(rate) => {
                self.camera.every = match rate {
                    FrameRate::High => 1,
                    FrameRate::Middle => 2,
                    FrameRate::Low => 6,
                }
            }
            Command::Ports { state, video } => {
                self.config.state_port = state.number();
                self.config.video_port = video.number();
            }
            _ => {}
        }
        let text = match command {
            Command::ExtLed(_) => "led ok",
            Command::ExtMatrix(_) => "matrix ok",
            _ => "ok",
        };
        self.answer(from, text);
    }

    fn stick(&mut self, command: &Command) {
        if let (
            Command::Rc {
                roll,
                pitch,
                throttle,
                yaw,
            },
            None,
        ) = (command, &self.running)
        {
            let sticks = Sticks {
                roll: *roll,
                pitch: *pitch,
                throttle: *throttle,
                yaw: *yaw,
            };
            self.body.physics.set_sticks(self.now, sticks);
        }
    }

    fn stop_something(&mut self, command: Command, from: SocketAddr) {
        match command {
            Command::Emergency => {
                self.running = None;
                self.body.lands_itself = false;
                let _ = self.body.physics.begin(self.now, Action::CutMotors);
                if !self.config.faults.silent_emergency {
                    self.answer(from, "ok");
                }
            }
            Command::Land => self.land(from),
            Command::MotorOff => {
                let _ = self.body.physics.begin(self.now, Action::Idle(false));
                self.answer(from, "ok");
            }
            _ => {
                self.running = None;
                self.body.lands_itself = false;
                let _ = self.body.physics.begin(self.now, Action::Hover);
                self.answer(from, "ok");
                self.say(
                    from,
                    "forced stop",
                    Duration::from_millis(150),
                    Channel::Reply,
                );
            }
        }
    }

    fn land(&mut self, from: SocketAddr) {
        let landing = self
            .running
            .as_ref()
            .is_some_and(|r| r.command == Command::Land);
        if landing || self.body.lands_itself {
            return self.refuse_busy(from);
        }
        let since = self.now.saturating_sub(self.took_off);
        let in_take_off = self
            .running
            .as_ref()
            .is_some_and(|r| r.command == Command::TakeOff);
        if !self.config.faults.deaf_to_land.is_zero()
            && (in_take_off
                || self.took_off > Duration::ZERO && since < self.config.faults.deaf_to_land)
        {
            return;
        }
        match self.body.physics.begin(self.now, Action::Land) {
            Ok(()) => {
                self.running = Some(Running {
                    command: Command::Land,
                    reply_to: from,
                    index: self.answering,
                    is_second_part: false,
                });
            }
            Err(refusal) => self.answer(from, text_of(refusal)),
        }
    }

    fn start_motion(&mut self, command: Command, from: SocketAddr) {
        if self.running.is_some() {
            return self.refuse_busy(from);
        }
        if self.body.lands_itself {
            return self.answer(from, "error Auto land");
        }
        if let Some(refusal) = self.refusal(&command) {
            return self.answer(from, text_of(refusal));
        }
        let action = Action::of(&command, self.speed).or_else(|| self.pad_action(&command));
        let Some(action) = action else {
            let _ = self.body.physics.begin(self.now, Action::Hover);
            return self.answer(from, text_of(Refusal::NotValidMarker));
        };
        match self.body.physics.begin(self.now, action) {
            Ok(()) => {
                if action == Action::TakeOff {
                    self.height_offset = 0.35 * self.random.unit();
                }
                self.running = Some(Running {
                    command,
                    reply_to: from,
                    index: self.answering,
                    is_second_part: false,
                });
            }
            Err(refusal) => self.answer(from, text_of(refusal)),
        }
    }

    /// Reasons of the drone itself, and injected ones.
    fn refusal(&mut self, command: &Command) -> Option<Refusal> {
        let faults = &self.config.faults;
        if self.now < faults.imu_invalid_until || faults.is_blind(self.now) {
            return Some(Refusal::NoValidImu);
        }
        let lifts = matches!(command, Command::TakeOff | Command::ThrowFly);
        if lifts && self.body.is_unfit(&self.config) {
            return Some(Refusal::Plain);
        }
        if self.answers_doubled
            && self
                .refused_at
                .is_some_and(|(_, at)| at + COPIES > self.now)
        {
            // What speaks against the first copy speaks against the second.
            return self.refused_at.map(|(refusal, _)| refusal);
        }
        if self.random.chance(faults.refusal) {
            let causes = [
                Refusal::Plain,
                Refusal::MotorStop,
                Refusal::NoValidImu,
                Refusal::OutOfRange,
            ];
            let refusal = self.random.pick(&causes);
            self.refused_at = refusal.map(|refusal| (refusal, self.now));
            return refusal;
        }
        None
    }

    fn refuse_busy(&mut self, from: SocketAddr) {
        if self.config.when_busy == WhenBusy::Refuse {
            self.answer(from, "error Not joystick");
        }
    }

    /// The end of a motion.
    pub(super) fn answer_motion(&mut self, to: SocketAddr, result: Result<(), Refusal>) {
        let text = result.map_or_else(text_of, |()| "ok");
        let faults = &self.config.faults;
        let late = if self.random.chance(faults.late) {
            faults.late_by
        } else {
            Duration::ZERO
        };
        self.reply(to, text, late);
    }

    pub(super) fn version_text(&self) -> String {
        String::from(match self.config.version {
            SdkVersion::V1_3 => "13",
            SdkVersion::V2_0 => "20",
            SdkVersion::V3_0 | SdkVersion::Rmtt => "30",
        })
    }
}

impl Action {
    /// What a motion asks for; `speed`, m/s, is that of moves without one of their own. `None` for what needs a pad and
    /// for commands that do not move the drone.
    pub(crate) fn of(command: &Command, speed: f64) -> Option<Self> {
        let straight = |offset| Some(Self::Move { offset, speed });
        match command {
            Command::TakeOff | Command::ThrowFly => Some(Self::TakeOff),
            Command::MotorOn => Some(Self::Idle(true)),
            Command::Forward(d) => straight([d.meters(), 0.0, 0.0]),
            Command::Back(d) => straight([-d.meters(), 0.0, 0.0]),
            Command::Left(d) => straight([0.0, d.meters(), 0.0]),
            Command::Right(d) => straight([0.0, -d.meters(), 0.0]),
            Command::Up(d) => straight([0.0, 0.0, d.meters()]),
            Command::Down(d) => straight([0.0, 0.0, -d.meters()]),
            Command::Clockwise(t) => Some(Self::Turn {
                degrees: f64::from(t.degrees()),
            }),
            Command::CounterClockwise(t) => Some(Self::Turn {
                degrees: -f64::from(t.degrees()),
            }),
            Command::Go { to, speed } => Some(Self::Move {
                offset: to.meters(),
                speed: speed.meters_per_s(),
            }),
            Command::Curve { arc, speed } => Some(Self::Arc {
                via: arc.via().meters(),
                to: arc.to().meters(),
                speed: f64::from(speed.cm_per_s()) / 100.0,
            }),
            Command::Flip(_) => Some(Self::Flip),
            _ => None,
        }
    }
}

/// Two copies of a command arrive within this time.
const COPIES: Duration = Duration::from_millis(200);

/// The drone's wording.
fn text_of(refusal: Refusal) -> &'static str {
    match refusal {
        Refusal::MotorStop => "error Motor stop",
        Refusal::NoValidImu => "error No valid imu",
        Refusal::NotJoystick => "error Not joystick",
        Refusal::AutoLand => "error Auto land",
        Refusal::RunTimeout => "error Run timeout",
        Refusal::Radius => "error Radius is too large!",
        Refusal::NotValidMarker => "Error. Not valid marker",
        Refusal::OutOfRange => "out of range",
        _ => "error",
    }
}
