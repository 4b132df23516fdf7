//! Reads the wire text back: what a drone does with the bytes it receives.

use super::{
    Arc, ArcError, Color, Command, Credentials, ExtError, Flip, FrameRate, Glyph, Led, Matrix,
    MatrixColor, Pad, PadDirection, Pixels, Query, Rate, Resolution, Scroll, Waypoint,
    WaypointError,
};
use crate::units::{ArcSpeed, BitRate, Distance, PadNumber, Port, Speed, Stick, Turn, UnitError};

/// Why a text is not a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ParseCommandError {
    /// The first word is no command.
    #[error("unknown command")]
    Unknown,
    /// An argument is missing, superfluous or not of the right kind.
    #[error("argument {index} is missing, superfluous or not of the right kind")]
    Argument {
        /// Which argument, from 1.
        index: usize,
    },
    /// An argument is outside its range.
    #[error(transparent)]
    Range(#[from] UnitError),
    /// A waypoint out of range.
    #[error(transparent)]
    Waypoint(#[from] WaypointError),
    /// An arc out of range.
    #[error(transparent)]
    Arc(#[from] ArcError),
    /// A light or matrix argument out of range.
    #[error(transparent)]
    Ext(#[from] ExtError),
    /// A network name or password that cannot be sent.
    #[error(transparent)]
    Credentials(#[from] super::CredentialsError),
}

type Parsed<T> = Result<T, ParseCommandError>;

impl Command {
    /// Reads a command from its wire text; surrounding white space, CR, LF and NUL are ignored.
    ///
    /// # Errors
    /// [`ParseCommandError`]: unknown word, wrong argument, or out of range (with the numbers).
    pub fn parse(text: &str) -> Parsed<Self> {
        let text = text.trim_matches(|c: char| c.is_ascii_whitespace() || c == '\0');
        if let Some(plain) = plain(text) {
            return Ok(plain);
        }
        let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
        let mut arguments = Arguments { rest, taken: 0 };
        let command = if word == "EXT" {
            ext(&mut arguments)?
        } else {
            with_arguments(word, &mut arguments)?
        };
        arguments.end()?;
        Ok(command)
    }
}

fn plain(text: &str) -> Option<Command> {
    if let Some(query) = Query::ALL.into_iter().find(|query| query.text() == text) {
        return Some(Command::Query(query));
    }
    Some(match text {
        "command" => Command::EnterSdk,
        "takeoff" => Command::TakeOff,
        "land" => Command::Land,
        "emergency" => Command::Emergency,
        "stop" => Command::Stop,
        "throwfly" => Command::ThrowFly,
        "motoron" => Command::MotorOn,
        "motoroff" => Command::MotorOff,
        "streamon" => Command::StreamOn,
        "streamoff" => Command::StreamOff,
        "mon" => Command::PadsOn,
        "moff" => Command::PadsOff,
        "reboot" => Command::Reboot,
        _ => return None,
    })
}

fn with_arguments(word: &str, a: &mut Arguments<'_>) -> Parsed<Command> {
    Ok(match word {
        "up" => Command::Up(a.distance()?),
        "down" => Command::Down(a.distance()?),
        "left" => Command::Left(a.distance()?),
        "right" => Command::Right(a.distance()?),
        "forward" => Command::Forward(a.distance()?),
        "back" => Command::Back(a.distance()?),
        "cw" => Command::Clockwise(Turn::from_degrees(a.number()?)?),
        "ccw" => Command::CounterClockwise(Turn::from_degrees(a.number()?)?),
        "go" => go(a)?,
        "curve" => curve(a)?,
        "jump" => jump(a)?,
        "flip" => Command::Flip(a.one_of(&Flip::ALL, Flip::letter)?),
        "speed" => Command::SetSpeed(a.speed()?),
        "rc" => Command::Rc {
            roll: a.stick()?,
            pitch: a.stick()?,
            throttle: a.stick()?,
            yaw: a.stick()?,
        },
        "downvision" => {
            Command::DownVision(a.one_of(&[false, true], |on| if on { "1" } else { "0" })?)
        }
        "mdirection" => Command::PadDirection(a.one_of(&PadDirection::ALL, PadDirection::digit)?),
        "port" => Command::Ports {
            state: Port::from_number(a.number()?)?,
            video: Port::from_number(a.number()?)?,
        },
        "setfps" => Command::SetFrameRate(a.one_of(&FrameRate::ALL, FrameRate::word)?),
        "setbitrate" => Command::SetBitRate(match a.number()? {
            0 => None,
            rate => Some(BitRate::from_mbit_per_s(rate)?),
        }),
        "setresolution" => Command::SetResolution(a.one_of(&Resolution::ALL, Resolution::word)?),
        "wifi" => Command::SetWifi(Credentials::new(a.word()?, a.word()?)?),
        "ap" => Command::JoinAccessPoint(Credentials::new(a.word()?, a.word()?)?),
        _ => return Err(ParseCommandError::Unknown),
    })
}

fn go(a: &mut Arguments<'_>) -> Parsed<Command> {
    let point = [a.number()?, a.number()?, a.number()?];
    let speed = a.speed()?;
    let [x, y, z] = point;
    if a.is_empty() {
        return Ok(Command::Go {
            to: Waypoint::from_cm(x, y, z)?,
            speed,
        });
    }
    Ok(Command::GoPad {
        to: Waypoint::from_cm(x, y, z)?,
        speed,
        pad: a.pad()?,
    })
}

fn curve(a: &mut Arguments<'_>) -> Parsed<Command> {
    let via = [a.number()?, a.number()?, a.number()?];
    let to = [a.number()?, a.number()?, a.number()?];
    let speed = ArcSpeed::from_cm_per_s(a.number()?)?;
    let arc = Arc::from_cm(via, to)?;
    if a.is_empty() {
        return Ok(Command::Curve { arc, speed });
    }
    Ok(Command::CurvePad {
        arc,
        speed,
        pad: a.pad()?,
    })
}

fn jump(a: &mut Arguments<'_>) -> Parsed<Command> {
    let to = Waypoint::from_cm(a.number()?, a.number()?, a.number()?)?;
    let speed = a.speed()?;
    let yaw = i16::try_from(a.number()?).map_err(|_| a.wrong())?;
    Ok(Command::jump(to, speed, yaw, a.pad()?, a.pad()?)?)
}

fn ext(a: &mut Arguments<'_>) -> Parsed<Command> {
    match a.word()? {
        "led" => Ok(Command::ExtLed(led(a)?)),
        "mled" => Ok(Command::ExtMatrix(matrix(a)?)),
        _ => Err(ParseCommandError::Unknown),
    }
}

fn led(a: &mut Arguments<'_>) -> Parsed<Led> {
    if a.skip("br") {
        return Ok(Led::Breathe(a.rate()?, a.color()?));
    }
    if a.skip("bl") {
        return Ok(Led::Blink(a.rate()?, a.color()?, a.color()?));
    }
    Ok(Led::Solid(a.color()?))
}

fn matrix(a: &mut Arguments<'_>) -> Parsed<Matrix> {
    let kind = a.word()?;
    Ok(match kind {
        "g" => Matrix::Show(Pixels::new(a.word()?)?),
        "sg" => Matrix::SetStart(Pixels::new(a.word()?)?),
        "sc" => Matrix::ClearStart,
        "sl" => Matrix::Brightness(a.byte()?),
        "s" => Matrix::Glyph(a.matrix_color()?, a.glyph()?),
        "l" | "r" | "u" | "d" => {
            let direction = kind.chars().next().unwrap_or('l');
            let (color, rate) = (a.matrix_color()?, a.rate()?);
            Matrix::Scroll(Scroll::with_direction(
                direction,
                color,
                rate,
                a.remainder(),
            )?)
        }
        _ => return Err(a.wrong()),
    })
}

/// The words after the command, taken one by one.
struct Arguments<'a> {
    rest: &'a str,
    taken: usize,
}

impl<'a> Arguments<'a> {
    fn word(&mut self) -> Parsed<&'a str> {
        self.taken += 1;
        let rest = self.rest.trim_start_matches(' ');
        let (word, rest) = rest.split_once(' ').unwrap_or((rest, ""));
        self.rest = rest;
        if word.is_empty() {
            Err(self.wrong())
        } else {
            Ok(word)
        }
    }

    fn is_empty(&self) -> bool {
        self.rest.trim_start_matches(' ').is_empty()
    }

    fn skip(&mut self, word: &str) -> bool {
        let mut ahead = Arguments {
            rest: self.rest,
            taken: self.taken,
        };
        let matches = ahead.word() == Ok(word);
        if matches {
            *self = ahead;
        }
        matches
    }

    fn remainder(&mut self) -> &'a str {
        self.taken += 1;
        core::mem::take(&mut self.rest)
    }

    fn wrong(&self) -> ParseCommandError {
        ParseCommandError::Argument { index: self.taken }
    }

    fn end(&mut self) -> Parsed<()> {
        if self.is_empty() {
            return Ok(());
        }
        Err(ParseCommandError::Argument {
            index: self.taken + 1,
        })
    }

    fn number(&mut self) -> Parsed<i64> {
        let word = self.word()?;
        word.parse().map_err(|_| self.wrong())
    }

    fn byte(&mut self) -> Parsed<u8> {
        let number = self.number()?;
        u8::try_from(number).map_err(|_| self.wrong())
    }

    fn distance(&mut self) -> Parsed<Distance> {
        Ok(Distance::from_cm(self.number()?)?)
    }

    fn speed(&mut self) -> Parsed<Speed> {
        Ok(Speed::from_cm_per_s(self.number()?)?)
    }

    fn stick(&mut self) -> Parsed<Stick> {
        Ok(Stick::from_percent(self.number()?)?)
    }

    fn one_of<T: Copy>(&mut self, all: &[T], text: impl Fn(T) -> &'static str) -> Parsed<T> {
        let word = self.word()?;
        all.iter()
            .copied()
            .find(|&item| text(item) == word)
            .ok_or(self.wrong())
    }

    fn pad(&mut self) -> Parsed<Pad> {
        match self.word()? {
            "m-1" => Ok(Pad::FirstSeen),
            "m-2" => Ok(Pad::Nearest),
            word => {
                let digits = word.strip_prefix('m').ok_or(self.wrong())?;
                let number = digits.parse().map_err(|_| self.wrong())?;
                Ok(Pad::Number(PadNumber::from_number(number)?))
            }
        }
    }

    fn color(&mut self) -> Parsed<Color> {
        Ok(Color {
            red: self.byte()?,
            green: self.byte()?,
            blue: self.byte()?,
        })
    }

    fn matrix_color(&mut self) -> Parsed<MatrixColor> {
        match self.word()? {
            "r" => Ok(MatrixColor::Red),
            "b" => Ok(MatrixColor::Blue),
            "p" => Ok(MatrixColor::Purple),
            _ => Err(self.wrong()),
        }
    }

    fn glyph(&mut self) -> Parsed<Glyph> {
        let word = self.word()?;
        let mut letters = word.chars();
        match (letters.next(), letters.next()) {
            (Some(letter), None) if letter.is_ascii_graphic() => Ok(Glyph::Character(letter)),
            _ if word == "heart" => Ok(Glyph::Heart),
            _ => Err(self.wrong()),
        }
    }

    fn rate<const MAX: u8>(&mut self) -> Parsed<Rate<MAX>> {
        let word = self.word()?;
        let (whole, tenth) = word.split_once('.').unwrap_or((word, "0"));
        let whole: u8 = whole.parse().map_err(|_| self.wrong())?;
        let tenth: u8 = tenth.parse().map_err(|_| self.wrong())?;
        if tenth > 9 {
            return Err(self.wrong());
        }
        Ok(Rate::from_tenths_hz(
            whole.saturating_mul(10).saturating_add(tenth),
        )?)
    }
}
