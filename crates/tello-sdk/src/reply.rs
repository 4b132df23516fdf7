//! The drone's replies as a closed enum, with the raw text kept.
//!
//! A reply is the text of one datagram from the command port. Values come with and without units, as integers and as
//! decimals, in any case and with CR, LF or NUL around them; all of that is accepted. Classification never fails:
//! what is not recognised is [`ReplyKind::Other`].

use crate::command::ReplyShape;
use alloc::borrow::ToOwned;
use alloc::string::String;

/// One reply.
#[derive(Debug, Clone, PartialEq)]
pub struct Reply {
    /// What it says.
    pub kind: ReplyKind,
    /// The text as it came, without surrounding white space and NUL (invalid UTF-8 replaced).
    pub raw: String,
}

/// What a reply says.
#[derive(Debug, Clone, PartialEq)]
pub enum ReplyKind {
    /// `ok`
    Ok,
    /// A number with the unit as it stood behind it ("" if none).
    Number {
        /// The number.
        value: f64,
        /// The unit's text, for example "dm".
        unit: String,
    },
    /// Two numbers, for example `62~65C`.
    Range {
        /// The lower number.
        low: f64,
        /// The higher number.
        high: f64,
    },
    /// A list of `key:value;`, to be read from the raw text.
    Fields,
    /// The drone refused or failed.
    Error(Refusal),
    /// `forced stop`: comes by itself after a `stop`.
    ForcedStop,
    /// `OK, drone will reboot in 3s`
    Rebooting,
    /// `led ok`
    LedOk,
    /// `matrix ok`
    MatrixOk,
    /// `tof N` of the expansion module, millimetres; 8192 means out of range.
    ExtTof {
        /// Millimetres.
        millimeters: u16,
    },
    /// `conn_ack:`: the drone is in the binary protocol.
    BinaryAck,
    /// A packet of the binary protocol on the text port (first byte 0xCC).
    BinaryPacket,
    /// Nothing but white space.
    Empty,
    /// Any other text.
    Other,
}

/// Why the drone refused or failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// `error` alone.
    #[error(
        "the drone answered `error`: on take-off usually a low battery or heat, otherwise it is not in a state for this command"
    )]
    Plain,
    /// `error Motor stop`
    #[error(
        "motors are stopped: the battery is empty or the drone believes that it stands on the ground; take off first"
    )]
    MotorStop,
    /// `error No valid imu`
    #[error(
        "no valid attitude: too dark, a uniform floor, not calibrated, or less than about 20 s since power-on"
    )]
    NoValidImu,
    /// `error Not joystick`
    #[error(
        "the drone is busy with another command or with sticks: wait for the reply, or centre the sticks"
    )]
    NotJoystick,
    /// `error Auto land`
    #[error("the drone lands by itself")]
    AutoLand,
    /// `error Run timeout`
    #[error(
        "the drone gave up after its own time limit of about 15 s: give a shorter move or a higher speed"
    )]
    RunTimeout,
    /// `error Radius is too large!`
    #[error("the arc's radius is outside 0.5 to 10 m")]
    Radius,
    /// `Error. Not valid marker`
    #[error("the mission pad was not found: the drone hovers")]
    NotValidMarker,
    /// `out of range`
    #[error("the drone calls an argument out of range")]
    OutOfRange,
    /// `unknown command: ...`
    #[error("the drone does not know the command: its SDK is older")]
    UnknownCommand,
    /// `led error`
    #[error("the light refused")]
    Led,
    /// `matrix error`
    #[error("the matrix refused")]
    Matrix,
    /// Another text that begins with `error`.
    #[error("the drone answered with an error that is not known; see the raw text")]
    Unlisted,
}

impl Reply {
    /// Classifies one datagram of the command port. Never fails, never panics; cost is linear in the bytes.
    #[must_use]
    pub fn parse(bytes: &[u8]) -> Self {
        if bytes.first() == Some(&0xCC) {
            return Self {
                kind: ReplyKind::BinaryPacket,
                raw: String::new(),
            };
        }
        let text = String::from_utf8_lossy(bytes);
        let raw = text.trim_matches(|c: char| c.is_ascii_whitespace() || c == '\0');
        Self {
            kind: classify(raw),
            raw: raw.to_owned(),
        }
    }

    /// Whether this can be the answer to a command of the given shape: errors can answer all of them.
    #[must_use]
    pub fn fits(&self, shape: ReplyShape) -> bool {
        use ReplyKind as K;
        match (&self.kind, shape) {
            (K::BinaryPacket | K::BinaryAck | K::Empty | K::ForcedStop, _)
            | (_, ReplyShape::Silent) => false,
            (K::Error(Refusal::Led), shape) => shape == ReplyShape::Led,
            (K::Error(Refusal::Matrix), shape) => shape == ReplyShape::Matrix,
            (K::Error(_), _) => true,
            (K::Ok | K::Rebooting, ReplyShape::Ok)
            | (K::Number { .. } | K::Range { .. }, ReplyShape::Number)
            | (K::Fields, ReplyShape::Fields)
            | (K::LedOk, ReplyShape::Led)
            | (K::MatrixOk, ReplyShape::Matrix)
            | (K::ExtTof { .. }, ReplyShape::ExtTof)
            | (K::Other | K::Number { .. } | K::Range { .. }, ReplyShape::Text) => true,
            _ => false,
        }
    }

    /// The error in it, if it is one.
    #[must_use]
    pub fn refusal(&self) -> Option<Refusal> {
        match self.kind {
            ReplyKind::Error(refusal) => Some(refusal),
            _ => None,
        }
    }

    /// The number in it, if it is one (the lower one of a range).
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self.kind {
            ReplyKind::Number { value, .. } => Some(value),
            ReplyKind::Range { low, .. } => Some(low),
            ReplyKind::ExtTof { millimeters } => Some(f64::from(millimeters)),
            _ => None,
        }
    }
}

fn classify(raw: &str) -> ReplyKind {
    let lower = raw.to_ascii_lowercase();
    match lower.as_str() {
        "" => return ReplyKind::Empty,
        "ok" => return ReplyKind::Ok,
        "forced stop" => return ReplyKind::ForcedStop,
        "led ok" => return ReplyKind::LedOk,
        "matrix ok" => return ReplyKind::MatrixOk,
        _ => {}
    }
    if let Some(refusal) = refusal(&lower) {
        return ReplyKind::Error(refusal);
    }
    if lower.starts_with("ok") && lower.contains("reboot") {
        return ReplyKind::Rebooting;
    }
    if lower.starts_with("conn_ack:") {
        return ReplyKind::BinaryAck;
    }
    if let Some(millimeters) = lower
        .strip_prefix("tof ")
        .and_then(|n| n.trim().parse().ok())
    {
        return ReplyKind::ExtTof { millimeters };
    }
    numeric(raw).unwrap_or(if is_fields(raw) {
        ReplyKind::Fields
    } else {
        ReplyKind::Other
    })
}

fn refusal(lower: &str) -> Option<Refusal> {
    if lower.starts_with("unknown command") {
        return Some(Refusal::UnknownCommand);
    }
    if lower.starts_with("out of range") {
        return Some(Refusal::OutOfRange);
    }
    match lower {
        "led error" => return Some(Refusal::Led),
        "matrix error" => return Some(Refusal::Matrix),
        _ => {}
    }
    let detail = lower
        .strip_prefix("error")?
        .trim_start_matches([' ', '.', ':']);
    let known = [
        ("motor stop", Refusal::MotorStop),
        ("no valid imu", Refusal::NoValidImu),
        ("not joystick", Refusal::NotJoystick),
        ("auto land", Refusal::AutoLand),
        ("run timeout", Refusal::RunTimeout),
        ("radius", Refusal::Radius),
        ("not valid marker", Refusal::NotValidMarker),
        ("out of range", Refusal::OutOfRange),
    ];
    if detail.is_empty() {
        return Some(Refusal::Plain);
    }
    let found = known.iter().find(|(text, _)| detail.starts_with(text));
    Some(found.map_or(Refusal::Unlisted, |&(_, refusal)| refusal))
}

/// A number with an optional unit of letters, or a range of two with `~`.
fn numeric(raw: &str) -> Option<ReplyKind> {
    if let Some((low, high)) = raw.split_once('~') {
        return Some(ReplyKind::Range {
            low: number_and_unit(low)?.0,
            high: number_and_unit(high)?.0,
        });
    }
    let (value, unit) = number_and_unit(raw)?;
    Some(ReplyKind::Number {
        value,
        unit: unit.to_owned(),
    })
}

/// Splits "62C" or "4 dm" into number and unit; `None` if it does not begin with a finite number.
pub(crate) fn number_and_unit(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let end = text
        .find(|c: char| !(c.is_ascii_digit() || matches!(c, '+' | '-' | '.')))
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let unit = unit.trim();
    let is_unit = unit.len() <= 4
        && unit
            .chars()
            .all(|c| c.is_ascii_alphabetic() || c == '%' || c == '/');
    let value: f64 = number.parse().ok()?;
    (value.is_finite() && is_unit).then_some((value, unit))
}

fn is_fields(raw: &str) -> bool {
    let mut pairs = raw
        .split(';')
        .filter(|part| !part.trim().is_empty())
        .peekable();
    pairs.peek().is_some() && pairs.all(|part| part.contains(':'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn kind(text: &str) -> ReplyKind {
        Reply::parse(text.as_bytes()).kind
    }

    #[test]
    fn every_listed_reply_is_recognised() {
        assert_eq!(kind("ok"), ReplyKind::Ok);
        assert_eq!(kind("OK\r\n"), ReplyKind::Ok);
        assert_eq!(kind("ok\0\0\0"), ReplyKind::Ok);
        assert_eq!(kind("error"), ReplyKind::Error(Refusal::Plain));
        assert_eq!(
            kind("error Motor stop"),
            ReplyKind::Error(Refusal::MotorStop)
        );
        assert_eq!(
            kind("error No valid imu"),
            ReplyKind::Error(Refusal::NoValidImu)
        );
        assert_eq!(
            kind("error Not joystick"),
            ReplyKind::Error(Refusal::NotJoystick)
        );
        assert_eq!(kind("error Auto land"), ReplyKind::Error(Refusal::AutoLand));
        assert_eq!(
            kind("error Run timeout"),
            ReplyKind::Error(Refusal::RunTimeout)
        );
        assert_eq!(
            kind("error Radius is too large!"),
            ReplyKind::Error(Refusal::Radius)
        );
        assert_eq!(
            kind("Error. Not valid marker"),
            ReplyKind::Error(Refusal::NotValidMarker)
        );
        assert_eq!(kind("out of range"), ReplyKind::Error(Refusal::OutOfRange));
        assert_eq!(
            kind("error Out of range"),
            ReplyKind::Error(Refusal::OutOfRange)
        );
        assert_eq!(
            kind("unknown command: sdk?"),
            ReplyKind::Error(Refusal::UnknownCommand)
        );
        assert_eq!(
            kind("error something new"),
            ReplyKind::Error(Refusal::Unlisted)
        );
        assert_eq!(kind("forced stop"), ReplyKind::ForcedStop);
        assert_eq!(kind("OK, drone will reboot in 3s"), ReplyKind::Rebooting);
        assert_eq!(kind("led ok"), ReplyKind::LedOk);
        assert_eq!(kind("led error"), ReplyKind::Error(Refusal::Led));
        assert_eq!(kind("matrix ok"), ReplyKind::MatrixOk);
        assert_eq!(kind("tof 8192"), ReplyKind::ExtTof { millimeters: 8192 });
        assert_eq!(kind("conn_ack:\x1e\x02"), ReplyKind::BinaryAck);
        assert_eq!(Reply::parse(&[0xCC, 0x18]).kind, ReplyKind::BinaryPacket);
        assert_eq!(kind("pitch:0;roll:-1;yaw:12;"), ReplyKind::Fields);
        assert_eq!(kind("esp32v1.0.0.33"), ReplyKind::Other);
        assert_eq!(kind(" \r\n"), ReplyKind::Empty);
    }

    #[test]
    fn numbers_come_with_and_without_units() {
        for (text, value, unit) in [
            ("87", 87.0, ""),
            ("100.0\r\n", 100.0, ""),
            ("0s", 0.0, "s"),
            ("4dm", 4.0, "dm"),
            ("801mm", 801.0, "mm"),
            ("-57.14", -57.14, ""),
        ] {
            assert_eq!(
                kind(text),
                ReplyKind::Number {
                    value,
                    unit: unit.into()
                },
                "{text}"
            );
        }
        assert_eq!(
            kind("62~65C"),
            ReplyKind::Range {
                low: 62.0,
                high: 65.0
            }
        );
        assert_eq!(kind("0TQZK7JED02VMT"), ReplyKind::Other);
        assert_eq!(kind("1e999"), ReplyKind::Other);
    }

    #[test]
    fn shapes_keep_an_ok_away_from_a_query() {
        assert!(!Reply::parse(b"ok").fits(ReplyShape::Number));
        assert!(!Reply::parse(b"87").fits(ReplyShape::Ok));
        assert!(Reply::parse(b"error").fits(ReplyShape::Number));
        assert!(!Reply::parse(&[0xCC]).fits(ReplyShape::Ok));
        assert!(!Reply::parse(b"forced stop").fits(ReplyShape::Ok));
        assert!(!Reply::parse(b"ok").fits(ReplyShape::Silent));
    }

    proptest! {
        #[test]
        fn any_bytes_are_classified(bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
            let _ = Reply::parse(&bytes);
        }

        #[test]
        fn any_text_is_classified(text in "[a-z0-9 :;~.\\-\\PC]{0,40}") {
            let reply = Reply::parse(text.as_bytes());
            prop_assert!(reply.number().is_none_or(f64::is_finite));
        }
    }
}
