//! The wire text of each command.

use super::{Command, Flip, FrameRate, Pad, PadDirection, Resolution};
use core::fmt;

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Up(d) => write!(f, "up {d}"),
            Self::Down(d) => write!(f, "down {d}"),
            Self::Left(d) => write!(f, "left {d}"),
            Self::Right(d) => write!(f, "right {d}"),
            Self::Forward(d) => write!(f, "forward {d}"),
            Self::Back(d) => write!(f, "back {d}"),
            Self::Clockwise(turn) => write!(f, "cw {turn}"),
            Self::CounterClockwise(turn) => write!(f, "ccw {turn}"),
            Self::Go { to, speed } => write!(f, "go {to} {speed}"),
            Self::GoPad { to, speed, pad } => write!(f, "go {to} {speed} {pad}"),
            Self::Curve { arc, speed } => write!(f, "curve {arc} {speed}"),
            Self::CurvePad { arc, speed, pad } => write!(f, "curve {arc} {speed} {pad}"),
            Self::Jump {
                to,
                speed,
                yaw_degrees,
                from_pad,
                to_pad,
            } => {
                write!(f, "jump {to} {speed} {yaw_degrees} {from_pad} {to_pad}")
            }
            Self::Flip(direction) => write!(f, "flip {}", direction.letter()),
            Self::SetSpeed(speed) => write!(f, "speed {speed}"),
            Self::Rc {
                roll,
                pitch,
                throttle,
                yaw,
            } => {
                write!(f, "rc {roll} {pitch} {throttle} {yaw}")
            }
            Self::DownVision(on) => write!(f, "downvision {}", u8::from(*on)),
            Self::PadDirection(direction) => write!(f, "mdirection {}", direction.digit()),
            Self::Ports { state, video } => write!(f, "port {state} {video}"),
            Self::SetFrameRate(rate) => write!(f, "setfps {}", rate.word()),
            Self::SetBitRate(None) => f.write_str("setbitrate 0"),
            Self::SetBitRate(Some(rate)) => write!(f, "setbitrate {rate}"),
            Self::SetResolution(resolution) => write!(f, "setresolution {}", resolution.word()),
            Self::SetWifi(network) => write!(f, "wifi {} {}", network.ssid(), network.password()),
            Self::JoinAccessPoint(network) => {
                write!(f, "ap {} {}", network.ssid(), network.password())
            }
            Self::ExtLed(led) => led.fmt(f),
            Self::ExtMatrix(matrix) => matrix.fmt(f),
            word => f.write_str(word.plain_word()),
        }
    }
}

impl Command {
    /// The text of the commands without arguments; empty for the others, which `Display` writes itself.
    fn plain_word(&self) -> &'static str {
        match self {
            Self::EnterSdk => "command",
            Self::TakeOff => "takeoff",
            Self::Land => "land",
            Self::Emergency => "emergency",
            Self::Stop => "stop",
            Self::ThrowFly => "throwfly",
            Self::MotorOn => "motoron",
            Self::MotorOff => "motoroff",
            Self::StreamOn => "streamon",
            Self::StreamOff => "streamoff",
            Self::PadsOn => "mon",
            Self::PadsOff => "moff",
            Self::Reboot => "reboot",
            Self::Query(query) => query.text(),
            _ => "",
        }
    }
}

impl fmt::Display for Pad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "m{number}"),
            Self::FirstSeen => f.write_str("m-1"),
            Self::Nearest => f.write_str("m-2"),
        }
    }
}

impl Flip {
    pub(super) const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Forward, Self::Back];

    pub(super) fn letter(self) -> &'static str {
        match self {
            Self::Left => "l",
            Self::Right => "r",
            Self::Forward => "f",
            Self::Back => "b",
        }
    }
}

impl PadDirection {
    pub(super) const ALL: [Self; 3] = [Self::Down, Self::Forward, Self::Both];

    pub(super) fn digit(self) -> &'static str {
        match self {
            Self::Down => "0",
            Self::Forward => "1",
            Self::Both => "2",
        }
    }
}

impl FrameRate {
    pub(super) const ALL: [Self; 3] = [Self::High, Self::Middle, Self::Low];

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::High => "high",
            Self::Middle => "middle",
            Self::Low => "low",
        }
    }
}

impl Resolution {
    pub(super) const ALL: [Self; 2] = [Self::High, Self::Low];

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::High => "high",
            Self::Low => "low",
        }
    }
}
