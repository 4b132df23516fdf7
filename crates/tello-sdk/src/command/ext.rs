//! Light and matrix of the RoboMaster TT's expansion module (`EXT led`, `EXT mled`).

use alloc::string::String;
use core::fmt;

/// Why a light or matrix command is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExtError {
    /// A frequency out of range.
    #[error("frequency of {tenths_hz} tenths of a hertz is out of range: give 1 to {max}")]
    Rate {
        /// Tenths of a hertz given.
        tenths_hz: u8,
        /// Largest accepted.
        max: u8,
    },
    /// A pattern that is empty, longer than 64 pixels or of other characters.
    #[error(
        "a pattern is 1 to 64 characters of r, b, p and 0; {length} were given, the first wrong one at {wrong:?}"
    )]
    Pixels {
        /// Characters given.
        length: usize,
        /// Index of the first wrong character.
        wrong: Option<usize>,
    },
    /// A text that is empty, longer than 70 characters or not printable ASCII.
    #[error("a text is 1 to 70 printable ASCII characters; {length} bytes were given")]
    Text {
        /// Bytes given.
        length: usize,
    },
}

/// Red, green and blue, 0 to 255 each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Color {
    /// Red.
    pub red: u8,
    /// Green.
    pub green: u8,
    /// Blue.
    pub blue: u8,
}

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} {}", self.red, self.green, self.blue)
    }
}

/// A frequency in tenths of a hertz, at least 0.1 Hz and at most 0.1 Hz times `MAX`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Rate<const MAX: u8>(u8);

impl<const MAX: u8> Rate<MAX> {
    /// Checks tenths of a hertz.
    ///
    /// # Errors
    /// [`ExtError::Rate`] for zero or above `MAX`.
    pub fn from_tenths_hz(tenths_hz: u8) -> Result<Self, ExtError> {
        if (1..=MAX).contains(&tenths_hz) {
            Ok(Self(tenths_hz))
        } else {
            Err(ExtError::Rate {
                tenths_hz,
                max: MAX,
            })
        }
    }
}

impl<const MAX: u8> fmt::Display for Rate<MAX> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.0 / 10, self.0 % 10)
    }
}

/// What the light does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Led {
    /// One colour.
    Solid(Color),
    /// One colour, breathing at 0.1 to 2.5 Hz.
    Breathe(Rate<25>, Color),
    /// Two colours in turn at 0.1 to 10 Hz.
    Blink(Rate<100>, Color, Color),
}

/// A colour of the matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MatrixColor {
    /// `r`
    Red,
    /// `b`
    Blue,
    /// `p`
    Purple,
}

impl MatrixColor {
    pub(super) fn letter(self) -> char {
        match self {
            Self::Red => 'r',
            Self::Blue => 'b',
            Self::Purple => 'p',
        }
    }
}

/// Up to 64 pixels, row by row: `r`, `b`, `p`, or `0` for dark.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels(String);

impl Pixels {
    /// Checks a pattern.
    ///
    /// # Errors
    /// [`ExtError::Pixels`].
    pub fn new(pattern: &str) -> Result<Self, ExtError> {
        let wrong = pattern
            .bytes()
            .position(|b| !matches!(b, b'r' | b'b' | b'p' | b'0'));
        if wrong.is_some() || pattern.is_empty() || pattern.len() > 64 {
            return Err(ExtError::Pixels {
                length: pattern.len(),
                wrong,
            });
        }
        Ok(Self(pattern.into()))
    }

    /// The pattern.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

/// A text to scroll, 1 to 70 printable ASCII characters, and how.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scroll {
    direction: char,
    color: MatrixColor,
    rate: Rate<25>,
    text: String,
}

impl Scroll {
    /// Scrolls to the left (right with [`Scroll::to_the_right`]) at 0.1 to 2.5 Hz.
    ///
    /// # Errors
    /// [`ExtError::Text`] for an empty, too long or unprintable text.
    pub fn new(color: MatrixColor, rate: Rate<25>, text: &str) -> Result<Self, ExtError> {
        Self::with_direction('l', color, rate, text)
    }

    pub(super) fn with_direction(
        direction: char,
        color: MatrixColor,
        rate: Rate<25>,
        text: &str,
    ) -> Result<Self, ExtError> {
        let printable = text.bytes().all(|b| b.is_ascii_graphic() || b == b' ');
        if !printable || text.trim().is_empty() || text != text.trim() || text.len() > 70 {
            return Err(ExtError::Text { length: text.len() });
        }
        Ok(Self {
            direction,
            color,
            rate,
            text: text.into(),
        })
    }

    /// The same text, to the right.
    #[must_use]
    pub fn to_the_right(self) -> Self {
        Self {
            direction: 'r',
            ..self
        }
    }

    /// The same text, upwards.
    #[must_use]
    pub fn upwards(self) -> Self {
        Self {
            direction: 'u',
            ..self
        }
    }

    /// The same text, downwards.
    #[must_use]
    pub fn downwards(self) -> Self {
        Self {
            direction: 'd',
            ..self
        }
    }
}

/// One printable ASCII character, or the heart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Glyph {
    /// A letter, digit or sign.
    Character(char),
    /// `heart`
    Heart,
}

/// What the 8 x 8 matrix shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Matrix {
    /// `g pattern`
    Show(Pixels),
    /// `l|r|u|d colour rate text`
    Scroll(Scroll),
    /// `s colour character`; a character that is not printable ASCII is sent as `?`.
    Glyph(MatrixColor, Glyph),
    /// `sg pattern`: shown at power-on.
    SetStart(Pixels),
    /// `sc`: nothing at power-on.
    ClearStart,
    /// `sl n`: brightness.
    Brightness(u8),
}

impl fmt::Display for Led {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Solid(color) => write!(f, "EXT led {color}"),
            Self::Breathe(rate, color) => write!(f, "EXT led br {rate} {color}"),
            Self::Blink(rate, first, second) => write!(f, "EXT led bl {rate} {first} {second}"),
        }
    }
}

impl fmt::Display for Matrix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("EXT mled ")?;
        match self {
            Self::Show(pixels) => write!(f, "g {}", pixels.as_str()),
            Self::Scroll(s) => {
                write!(
                    f,
                    "{} {} {} {}",
                    s.direction,
                    s.color.letter(),
                    s.rate,
                    s.text
                )
            }
            Self::Glyph(color, Glyph::Heart) => write!(f, "s {} heart", color.letter()),
            Self::Glyph(color, Glyph::Character(c)) => {
                let shown = if c.is_ascii_graphic() { *c } else { '?' };
                write!(f, "s {} {shown}", color.letter())
            }
            Self::SetStart(pixels) => write!(f, "sg {}", pixels.as_str()),
            Self::ClearStart => f.write_str("sc"),
            Self::Brightness(level) => write!(f, "sl {level}"),
        }
    }
}
