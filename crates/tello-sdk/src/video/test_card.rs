//! The camera of an emulated drone: a moving test card, 960 x 720, with frame number and time painted into the picture.
//!
//! Any decoder's picture tells which frame it is and how old: [`TestCard::read`] on the decoded pixels. Bands of three
//! squares of height at the top: 32 bits of the frame's number, then 32 bits of the time in milliseconds, highest bit
//! first, white for one; right of each band eight squares black and white in turn, by which a reader knows the card.

use super::mosaic::{Mosaic, MosaicEncoder, SQUARE};
use crate::emulator::VideoSource;
use alloc::vec::Vec;
use core::time::Duration;

/// Squares across and down: 960 x 720 pixels.
const COLUMNS: usize = 60;
const ROWS: usize = 45;
/// Rows of squares of one band.
const BAND: usize = 3;
const BITS: usize = 32;
const MARKS: usize = 8;
/// Pictures from key frame to key frame: one second.
const KEY_INTERVAL: u32 = 30;

/// Luma of a bit, BT.601 range.
const WHITE: u8 = 235;
const BLACK: u8 = 16;

/// Paints and encodes the card.
#[derive(Debug, Clone)]
pub struct TestCard {
    encoder: MosaicEncoder,
    picture: Mosaic,
    frame: u32,
    since_key: u32,
    clock: Duration,
}

/// What is painted into a card.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CardReading {
    /// The frame's number, from 0.
    pub frame: u32,
    /// When it was painted, milliseconds on the card's clock, modulo 2^32.
    pub clock_ms: u32,
}

impl CardReading {
    /// How long before `now`, on the card's clock, it was painted.
    #[must_use]
    pub fn age(&self, now: Duration) -> Duration {
        Duration::from_millis(u64::from(
            (now.as_millis() as u32).wrapping_sub(self.clock_ms),
        ))
    }
}

impl Default for TestCard {
    fn default() -> Self {
        Self::new()
    }
}

impl TestCard {
    /// A card whose clock is the drone's: time since power-on.
    #[must_use]
    pub fn new() -> Self {
        Self::with_clock(Duration::ZERO)
    }

    /// A card whose clock shows `at_power_on` when the drone is switched on: with the time since 1970, readers in other
    /// programs on the same machine can tell a picture's age.
    #[must_use]
    pub fn with_clock(at_power_on: Duration) -> Self {
        Self {
            encoder: MosaicEncoder::new(),
            picture: Mosaic::new(COLUMNS, ROWS),
            frame: 0,
            since_key: 0,
            clock: at_power_on,
        }
    }

    /// Reads a decoded picture given its luma or brightness, row by row; `None` if it shows no card.
    #[must_use]
    pub fn read(
        width: usize,
        brightness: impl Fn(usize, usize) -> Option<u8>,
    ) -> Option<CardReading> {
        if width != COLUMNS * SQUARE {
            return None;
        }
        let at = |column: usize, band: usize| {
            let middle = SQUARE / 2;
            brightness(
                column * SQUARE + middle,
                (band * BAND + 1) * SQUARE + middle,
            )
        };
        let word = |band: usize| -> Option<u32> {
            for mark in 0..MARKS {
                let white = at(BITS + mark, band)? > 127;
                (white == (mark % 2 == 1)).then_some(())?;
            }
            (0..BITS).try_fold(0_u32, |word, bit| {
                Some(word << 1 | u32::from(at(bit, band)? > 127))
            })
        };
        Some(CardReading {
            frame: word(0)?,
            clock_ms: word(1)?,
        })
    }

    fn paint(&mut self, now: Duration) {
        let frame = self.frame as usize;
        for row in 2 * BAND..ROWS {
            for column in 0..COLUMNS {
                self.picture
                    .set(column, row, background(column, row, frame));
            }
        }
        let bar = frame % COLUMNS;
        for row in 2 * BAND + 2..ROWS {
            self.picture.set(bar, row, [WHITE, 128, 128]);
        }
        self.band(0, self.frame);
        self.band(1, (self.clock + now).as_millis() as u32);
    }

    fn band(&mut self, band: usize, word: u32) {
        let color = |white: bool| [if white { WHITE } else { BLACK }, 128, 128];
        for row in band * BAND..(band + 1) * BAND {
            for bit in 0..BITS {
                let is_one = word >> (BITS - 1 - bit) & 1 == 1;
                self.picture.set(bit, row, color(is_one));
            }
            for mark in 0..MARKS {
                self.picture.set(BITS + mark, row, color(mark % 2 == 1));
            }
        }
    }
}

/// Coloured hills that drift by: nearly every square changes from picture to picture, as in a flying drone's.
fn background(column: usize, row: usize, frame: usize) -> [u8; 3] {
    let wave = |phase: usize, period: usize, height: usize| {
        let place = phase % period;
        place.min(period - place) * 2 * height / period
    };
    let luma = 40 + wave(column + frame, 40, 90) + wave(row * 2 + frame / 2, 50, 60);
    let blue = 90 + wave(column * 2 + row + frame, 90, 70);
    let red = 90 + wave(row * 3 + frame * 2, 120, 70);
    [luma as u8, blue as u8, red as u8]
}

impl VideoSource for TestCard {
    fn next_unit(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.paint(now);
        let key = self.since_key == 0;
        self.since_key = (self.since_key + 1) % KEY_INTERVAL;
        self.frame = self.frame.wrapping_add(1);
        Some(self.encoder.encode(&self.picture, key))
    }

    fn restart(&mut self) {
        self.since_key = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_painted_card_is_read_and_another_picture_is_not() {
        let mut card = TestCard::with_clock(Duration::from_secs(1_700_000_000));
        let sizes: Vec<usize> = (0..31_u32)
            .map(|i| {
                card.next_unit(Duration::from_millis(u64::from(i) * 33))
                    .unwrap()
                    .len()
            })
            .collect();
        // Sizes like the drone's: no datagram burst larger than its key frames of 35 kB.
        assert!(
            sizes.iter().all(|size| (3000..20_000).contains(size)),
            "{sizes:?}"
        );
        let brightness =
            |x: usize, y: usize| card.picture.get(x / SQUARE, y / SQUARE).map(|c| c[0]);
        let reading = TestCard::read(960, brightness).unwrap();
        assert_eq!(reading.frame, 30);
        let now = Duration::from_secs(1_700_000_000) + Duration::from_millis(30 * 33 + 7);
        assert_eq!(reading.age(now), Duration::from_millis(7));
        assert_eq!(TestCard::read(960, |_, _| Some(0)), None);
        assert_eq!(TestCard::read(320, brightness), None);
        assert_eq!(TestCard::read(960, |_, _| None), None);
    }
}
