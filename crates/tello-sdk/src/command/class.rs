//! How each command may be treated when its reply is lost, and what its reply looks like.

use super::{Command, Pad, Query, SdkVersion};

/// What may be done with a command whose reply does not come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Class {
    /// Changes nothing: ask again.
    Query,
    /// Sets a value, twice is the same as once: send again.
    Setting,
    /// Moves the drone or starts its motors: never sent again.
    Motion,
    /// `land`, `stop`, `motoroff`, `emergency`: repeated until a reply or the telemetry confirms it.
    Safety,
    /// `rc`: never answered, the latest value wins.
    Sticks,
    /// Reboots the drone: sent once, not waited for beyond its timeout.
    Once,
}

/// What a positive reply to a command looks like; two commands of different shape cannot be confused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ReplyShape {
    /// `ok`
    Ok,
    /// A number, perhaps with a unit or as a range.
    Number,
    /// A list of `key:value;`.
    Fields,
    /// Free text.
    Text,
    /// `led ok`
    Led,
    /// `matrix ok`
    Matrix,
    /// `tof N`
    ExtTof,
    /// No reply at all.
    Silent,
}

impl Command {
    /// The retry class.
    #[must_use]
    pub fn class(&self) -> Class {
        match self {
            Self::Query(_) => Class::Query,
            Self::TakeOff
            | Self::ThrowFly
            | Self::MotorOn
            | Self::Up(_)
            | Self::Down(_)
            | Self::Left(_)
            | Self::Right(_)
            | Self::Forward(_)
            | Self::Back(_)
            | Self::Clockwise(_)
            | Self::CounterClockwise(_)
            | Self::Go { .. }
            | Self::GoPad { .. }
            | Self::Curve { .. }
            | Self::CurvePad { .. }
            | Self::Jump { .. }
            | Self::Flip(_) => Class::Motion,
            Self::Land | Self::Emergency | Self::Stop | Self::MotorOff => Class::Safety,
            Self::Rc { .. } => Class::Sticks,
            Self::SetWifi(_) | Self::JoinAccessPoint(_) | Self::Reboot => Class::Once,
            Self::EnterSdk
            | Self::SetSpeed(_)
            | Self::StreamOn
            | Self::StreamOff
            | Self::DownVision(_)
            | Self::PadsOn
            | Self::PadsOff
            | Self::PadDirection(_)
            | Self::Ports { .. }
            | Self::SetFrameRate(_)
            | Self::SetBitRate(_)
            | Self::SetResolution(_)
            | Self::ExtLed(_)
            | Self::ExtMatrix(_) => Class::Setting,
        }
    }

    /// The shape of a positive reply.
    #[must_use]
    pub fn reply_shape(&self) -> ReplyShape {
        match self {
            Self::Rc { .. } | Self::Reboot => ReplyShape::Silent,
            Self::ExtLed(_) => ReplyShape::Led,
            Self::ExtMatrix(_) => ReplyShape::Matrix,
            Self::Query(query) => query.reply_shape(),
            _ => ReplyShape::Ok,
        }
    }

    /// The first SDK that has the command.
    #[must_use]
    pub fn since(&self) -> SdkVersion {
        match self {
            Self::Stop
            | Self::Jump { .. }
            | Self::PadsOn
            | Self::PadsOff
            | Self::PadDirection(_)
            | Self::JoinAccessPoint(_) => SdkVersion::V2_0,
            Self::GoPad { pad, .. } | Self::CurvePad { pad, .. } => match pad {
                Pad::Number(_) => SdkVersion::V2_0,
                Pad::FirstSeen | Pad::Nearest => SdkVersion::V3_0,
            },
            Self::ThrowFly
            | Self::MotorOn
            | Self::MotorOff
            | Self::Ports { .. }
            | Self::SetFrameRate(_)
            | Self::SetBitRate(_)
            | Self::SetResolution(_)
            | Self::Reboot => SdkVersion::V3_0,
            Self::ExtLed(_) | Self::ExtMatrix(_) => SdkVersion::Rmtt,
            Self::Query(query) => query.since(),
            _ => SdkVersion::V1_3,
        }
    }
}

impl Query {
    /// Every query.
    pub const ALL: [Self; 18] = [
        Self::Speed,
        Self::Battery,
        Self::MotorTime,
        Self::Wifi,
        Self::Height,
        Self::Temperature,
        Self::Attitude,
        Self::Barometer,
        Self::Acceleration,
        Self::Tof,
        Self::Sdk,
        Self::SerialNumber,
        Self::Hardware,
        Self::WifiVersion,
        Self::AccessPoint,
        Self::Ssid,
        Self::ExtTof,
        Self::ExtVersion,
    ];

    /// The wire text.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Speed => "speed?",
            Self::Battery => "battery?",
            Self::MotorTime => "time?",
            Self::Wifi => "wifi?",
            Self::Height => "height?",
            Self::Temperature => "temp?",
            Self::Attitude => "attitude?",
            Self::Barometer => "baro?",
            Self::Acceleration => "acceleration?",
            Self::Tof => "tof?",
            Self::Sdk => "sdk?",
            Self::SerialNumber => "sn?",
            Self::Hardware => "hardware?",
            Self::WifiVersion => "wifiversion?",
            Self::AccessPoint => "ap?",
            Self::Ssid => "ssid?",
            Self::ExtTof => "EXT tof?",
            Self::ExtVersion => "EXT version?",
        }
    }

    fn reply_shape(self) -> ReplyShape {
        match self {
            Self::Attitude | Self::Acceleration => ReplyShape::Fields,
            Self::SerialNumber
            | Self::Hardware
            | Self::WifiVersion
            | Self::AccessPoint
            | Self::Ssid
            | Self::ExtVersion => ReplyShape::Text,
            Self::ExtTof => ReplyShape::ExtTof,
            _ => ReplyShape::Number,
        }
    }

    fn since(self) -> SdkVersion {
        match self {
            Self::Sdk | Self::SerialNumber => SdkVersion::V2_0,
            Self::Hardware | Self::WifiVersion | Self::AccessPoint | Self::Ssid => SdkVersion::V3_0,
            Self::ExtTof | Self::ExtVersion => SdkVersion::Rmtt,
            _ => SdkVersion::V1_3,
        }
    }
}
