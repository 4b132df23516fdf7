//! The commands of the text protocol as one closed enum: what can be said to the drone, with units and ranges.
//!
//! `Display` writes the wire text, [`Command::parse`] reads it back (a drone, an emulator or a log reader needs that),
//! [`Command::class`] says how a lost reply may be treated and [`Command::since`] which SDK first has the command.

mod arc;
mod class;
mod encode;
mod ext;
mod parse;
mod station;
mod waypoint;

pub use arc::{Arc, ArcError};
pub use class::{Class, ReplyShape};
pub use ext::{Color, ExtError, Glyph, Led, Matrix, MatrixColor, Pixels, Rate, Scroll};
pub use parse::ParseCommandError;
pub use station::{Credentials, CredentialsError};
pub use waypoint::{Waypoint, WaypointError};

use crate::units::{ArcSpeed, BitRate, Distance, PadNumber, Port, Speed, Stick, Turn};

/// The SDK that a drone speaks; later ones contain the earlier ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum SdkVersion {
    /// Tello, firmware 1.3.
    #[default]
    V1_3,
    /// Tello EDU: mission pads, station mode, `stop`.
    V2_0,
    /// Tello and Tello EDU with newer firmware: ports and video settings.
    V3_0,
    /// RoboMaster TT: SDK 3.0 with the expansion module (`EXT` commands).
    Rmtt,
}

/// Direction of a flip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Flip {
    /// `l`
    Left,
    /// `r`
    Right,
    /// `f`
    Forward,
    /// `b`
    Back,
}

/// Which mission pad a command refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Pad {
    /// The pad with this number, `m1` to `m8`.
    Number(PadNumber),
    /// The first pad that is seen, `m-1` (SDK 3.0).
    FirstSeen,
    /// The nearest pad, `m-2` (SDK 3.0).
    Nearest,
}

/// Which cameras look for mission pads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PadDirection {
    /// `0`: the downward camera, 20 Hz.
    Down,
    /// `1`: the forward camera, 20 Hz.
    Forward,
    /// `2`: both, 10 Hz each.
    Both,
}

/// Frame rate of the video (SDK 3.0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrameRate {
    /// 30 frames per second.
    High,
    /// 15 frames per second.
    Middle,
    /// 5 frames per second.
    Low,
}

/// Resolution of the video (SDK 3.0).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Resolution {
    /// 720 lines.
    High,
    /// 480 lines.
    Low,
}

/// A question that the drone answers with a value and that changes nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Query {
    /// `speed?`, cm/s.
    Speed,
    /// `battery?`, percent.
    Battery,
    /// `time?`, seconds of motor time.
    MotorTime,
    /// `wifi?`, signal to noise ratio.
    Wifi,
    /// `height?`, decimetres.
    Height,
    /// `temp?`, degrees Celsius, a range.
    Temperature,
    /// `attitude?`, degrees.
    Attitude,
    /// `baro?`, metres.
    Barometer,
    /// `acceleration?`, 0.001 g.
    Acceleration,
    /// `tof?`, millimetres.
    Tof,
    /// `sdk?`, SDK 2.0.
    Sdk,
    /// `sn?`, SDK 2.0.
    SerialNumber,
    /// `hardware?`, SDK 3.0.
    Hardware,
    /// `wifiversion?`, SDK 3.0.
    WifiVersion,
    /// `ap?`, SDK 3.0.
    AccessPoint,
    /// `ssid?`, SDK 3.0.
    Ssid,
    /// `EXT tof?`, millimetres, RMTT.
    ExtTof,
    /// `EXT version?`, RMTT.
    ExtVersion,
}

/// One command of the text protocol.
///
/// ```
/// use tello_sdk::{Command, Distance};
/// let command = Command::Forward(Distance::from_cm(50)?);
/// assert_eq!(command.to_string(), "forward 50");
/// assert_eq!(Command::parse("forward 50")?, command);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Command {
    /// `command`: enter the text protocol; also the keep-alive.
    EnterSdk,
    /// `takeoff`
    TakeOff,
    /// `land`
    Land,
    /// `emergency`: stop the motors at once, the drone falls.
    Emergency,
    /// `stop`: hover (SDK 2.0).
    Stop,
    /// `up x`
    Up(Distance),
    /// `down x`
    Down(Distance),
    /// `left x`
    Left(Distance),
    /// `right x`
    Right(Distance),
    /// `forward x`
    Forward(Distance),
    /// `back x`
    Back(Distance),
    /// `cw x`
    Clockwise(Turn),
    /// `ccw x`
    CounterClockwise(Turn),
    /// `go x y z speed`: straight to a point relative to the drone.
    Go {
        /// Where to, relative to the drone.
        to: Waypoint,
        /// How fast.
        speed: Speed,
    },
    /// `go x y z speed mid`: straight to a point relative to a mission pad (SDK 2.0).
    GoPad {
        /// Where to, in the pad's frame.
        to: Waypoint,
        /// How fast.
        speed: Speed,
        /// Which pad.
        pad: Pad,
    },
    /// `curve x1 y1 z1 x2 y2 z2 speed`: an arc through two points.
    Curve {
        /// The arc, relative to the drone.
        arc: Arc,
        /// How fast.
        speed: ArcSpeed,
    },
    /// `curve ... mid`: an arc in a mission pad's frame (SDK 2.0).
    CurvePad {
        /// The arc, in the pad's frame.
        arc: Arc,
        /// How fast.
        speed: ArcSpeed,
        /// Which pad.
        pad: Pad,
    },
    /// `jump x y z speed yaw mid1 mid2`: from one pad to the next (SDK 2.0).
    Jump {
        /// Where to, in the first pad's frame.
        to: Waypoint,
        /// How fast.
        speed: Speed,
        /// Yaw to face in the second pad's frame, degrees, -360..=360 (checked by [`Command::jump`]).
        yaw_degrees: i16,
        /// The pad to start from.
        from_pad: Pad,
        /// The pad to find.
        to_pad: Pad,
    },
    /// `flip d`
    Flip(Flip),
    /// `throwfly`: take off by being thrown within five seconds (SDK 3.0).
    ThrowFly,
    /// `motoron`: turn the propellers on the ground for cooling (SDK 3.0).
    MotorOn,
    /// `motoroff` (SDK 3.0).
    MotorOff,
    /// `speed x`
    SetSpeed(Speed),
    /// `rc a b c d`: a velocity set-point, held by the drone until the next one; never answered.
    Rc {
        /// Right positive.
        roll: Stick,
        /// Forward positive.
        pitch: Stick,
        /// Up positive.
        throttle: Stick,
        /// Clockwise positive.
        yaw: Stick,
    },
    /// `streamon`
    StreamOn,
    /// `streamoff`
    StreamOff,
    /// `downvision 0|1`: send the downward camera's picture (found by users, not in the manuals).
    DownVision(bool),
    /// `mon`: look for mission pads (SDK 2.0).
    PadsOn,
    /// `moff` (SDK 2.0).
    PadsOff,
    /// `mdirection x` (SDK 2.0).
    PadDirection(PadDirection),
    /// `port state video` (SDK 3.0).
    Ports {
        /// Where the state lines go.
        state: Port,
        /// Where the video goes.
        video: Port,
    },
    /// `setfps x` (SDK 3.0).
    SetFrameRate(FrameRate),
    /// `setbitrate x`; `None` is automatic (SDK 3.0).
    SetBitRate(Option<BitRate>),
    /// `setresolution x` (SDK 3.0).
    SetResolution(Resolution),
    /// `wifi ssid pass`: rename the drone's own network; it reboots.
    SetWifi(Credentials),
    /// `ap ssid pass`: join a network; the drone reboots (SDK 2.0).
    JoinAccessPoint(Credentials),
    /// `reboot` (SDK 3.0); never answered.
    Reboot,
    /// `EXT led ...` (RMTT).
    ExtLed(Led),
    /// `EXT mled ...` (RMTT).
    ExtMatrix(Matrix),
    /// Any question.
    Query(Query),
}

impl Command {
    /// `rc` with all sticks at rest.
    pub const RC_ZERO: Self = Self::Rc {
        roll: Stick::CENTER,
        pitch: Stick::CENTER,
        throttle: Stick::CENTER,
        yaw: Stick::CENTER,
    };

    /// A checked [`Command::Jump`].
    ///
    /// # Errors
    /// [`UnitError::OutOfRange`](crate::UnitError::OutOfRange) when the yaw is outside -360..=360 degrees.
    pub fn jump(
        to: Waypoint,
        speed: Speed,
        yaw_degrees: i16,
        from_pad: Pad,
        to_pad: Pad,
    ) -> Result<Self, crate::UnitError> {
        if !(-360..=360).contains(&yaw_degrees) {
            return Err(crate::UnitError::OutOfRange {
                quantity: "yaw",
                unit: "deg",
                value: i64::from(yaw_degrees),
                min: -360,
                max: 360,
            });
        }
        Ok(Self::Jump {
            to,
            speed,
            yaw_degrees,
            from_pad,
            to_pad,
        })
    }
}
