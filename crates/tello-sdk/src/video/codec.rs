//! Decoding and encoding with OpenH264 (feature `video`; built from its bundled sources with a C++ compiler).
//!
//! A decoding error is not the end: the decoder then waits for the next key frame. Note on patents: the grant that comes
//! with the maker's own binary does not cover a build from source.

use super::assembler::AccessUnit;
use crate::emulator::VideoSource;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::time::Duration;
use openh264::OpenH264API;
use openh264::encoder::{BitRate, EncoderConfig, FrameRate, IntraFramePeriod};
use openh264::formats::{RgbSliceU8, YUVBuffer, YUVSource};

/// Why there is no codec or no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CodecError {
    /// The library refuses.
    #[error("OpenH264: {0}")]
    Library(String),
    /// Width and height must be even, positive and at most 4096, and the picture must have three bytes a pixel.
    #[error("a picture of {width} x {height} with {bytes} bytes cannot be encoded")]
    Size {
        /// Pixels.
        width: usize,
        /// Pixels.
        height: usize,
        /// Bytes given.
        bytes: usize,
    },
}

/// A decoded picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
    /// Red, green, blue, 8 bits each, row by row from the top.
    pub rgb: Vec<u8>,
    /// When the first datagram came.
    pub at: Duration,
}

/// Decodes access units.
pub struct Decoder {
    decoder: openh264::decoder::Decoder,
    waits_for_key: bool,
    errors: u64,
}

impl Decoder {
    /// A decoder that waits for a key frame.
    ///
    /// # Errors
    /// The library cannot be initialised.
    pub fn new() -> Result<Self, CodecError> {
        let decoder = openh264::decoder::Decoder::new().map_err(library)?;
        Ok(Self {
            decoder,
            waits_for_key: true,
            errors: 0,
        })
    }

    /// Decodes one unit. `None` for one that cannot be decoded: before the first key frame, known to be damaged, or
    /// refused by the library; the next key frame is waited for then. Give every unit in order.
    pub fn decode(&mut self, unit: &AccessUnit) -> Option<Picture> {
        if self.waits_for_key && !(unit.is_key && unit.is_decodable) {
            return None;
        }
        self.waits_for_key = !unit.is_decodable;
        if self.waits_for_key {
            return None;
        }
        match self.decoder.decode(&unit.data) {
            Ok(decoded) => {
                let decoded = decoded?;
                let (width, height) = decoded.dimensions();
                let mut rgb = alloc::vec![0; width * height * 3];
                decoded.write_rgb8(&mut rgb);
                Some(Picture {
                    width,
                    height,
                    rgb,
                    at: unit.at,
                })
            }
            Err(_) => {
                self.errors += 1;
                self.waits_for_key = true;
                None
            }
        }
    }

    /// Units that the library refused.
    #[must_use]
    pub fn errors(&self) -> u64 {
        self.errors
    }
}

/// Encodes pictures the way the drone does: one slice, no B frames, a key frame with parameter sets every second.
pub struct Encoder {
    encoder: openh264::encoder::Encoder,
    width: usize,
    height: usize,
}

impl Encoder {
    /// An encoder for 30 pictures a second.
    ///
    /// # Errors
    /// An odd, empty or too large size, or the library cannot be initialised.
    pub fn new(width: usize, height: usize, bits_per_second: u32) -> Result<Self, CodecError> {
        let even = |n: usize| n > 0 && n <= 4096 && n.is_multiple_of(2);
        if !(even(width) && even(height)) {
            return Err(CodecError::Size {
                width,
                height,
                bytes: 0,
            });
        }
        // By default the library drops pictures to hold the bit rate.
        let config = EncoderConfig::new()
            .bitrate(BitRate::from_bps(bits_per_second))
            .max_frame_rate(FrameRate::from_hz(30.0))
            .skip_frames(false)
            .num_threads(1)
            .intra_frame_period(IntraFramePeriod::from_num_frames(30));
        let api = OpenH264API::from_source();
        let encoder = openh264::encoder::Encoder::with_api_config(api, config).map_err(library)?;
        Ok(Self {
            encoder,
            width,
            height,
        })
    }

    /// Encodes red, green, blue, row by row, into one access unit.
    ///
    /// # Errors
    /// The picture does not have `width * height * 3` bytes, or the library refuses.
    pub fn encode(&mut self, rgb: &[u8]) -> Result<Vec<u8>, CodecError> {
        let (width, height) = (self.width, self.height);
        if rgb.len() != width * height * 3 {
            return Err(CodecError::Size {
                width,
                height,
                bytes: rgb.len(),
            });
        }
        let yuv = YUVBuffer::from_rgb8_source(RgbSliceU8::new(rgb, (width, height)));
        Ok(self.encoder.encode(&yuv).map_err(library)?.to_vec())
    }
}

/// A camera for emulated drones: a grey ramp with a bright bar that moves one sixtieth of the width per picture.
pub struct TestPattern {
    encoder: Encoder,
    rgb: Vec<u8>,
    frame: usize,
    /// The bar is back after sixty pictures, and two key frames: from then on nothing is encoded any more.
    cycle: Vec<Vec<u8>>,
}

/// Pictures until the bar is back.
const CYCLE: usize = 60;

impl TestPattern {
    /// A camera of 960 x 720 pixels at 2 Mbit/s.
    ///
    /// # Errors
    /// The library cannot be initialised.
    pub fn new() -> Result<Self, CodecError> {
        Self::with_size(960, 720)
    }

    /// A camera of another size.
    ///
    /// # Errors
    /// An odd, empty or too large size, or the library cannot be initialised.
    pub fn with_size(width: usize, height: usize) -> Result<Self, CodecError> {
        let encoder = Encoder::new(width, height, 2_000_000)?;
        Ok(Self {
            encoder,
            rgb: alloc::vec![0; width * height * 3],
            frame: 0,
            cycle: Vec::new(),
        })
    }

    fn paint(&mut self) {
        let width = self.encoder.width;
        let bar = self.frame % CYCLE * width / CYCLE;
        for (index, pixel) in self.rgb.chunks_exact_mut(3).enumerate() {
            let (column, row) = (index % width, index / width);
            let lit = (bar..bar + width / CYCLE).contains(&column);
            let grey = if lit {
                250
            } else {
                (column * 100 / width + row % 64) as u8
            };
            pixel.fill(grey);
        }
    }
}

impl VideoSource for TestPattern {
    fn next_unit(&mut self, _now: Duration) -> Option<Vec<u8>> {
        let index = self.frame % CYCLE;
        if self.cycle.len() <= index {
            self.paint();
            self.cycle.push(self.encoder.encode(&self.rgb).ok()?);
        }
        self.frame += 1;
        self.cycle.get(index).cloned()
    }
}

fn library(error: openh264::Error) -> CodecError {
    CodecError::Library(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::video::{Assembler, AssemblerConfig, datagrams};

    fn units(lose: impl Fn(usize) -> bool) -> Vec<AccessUnit> {
        let mut camera = TestPattern::with_size(320, 240).unwrap();
        let mut assembler = Assembler::new(AssemblerConfig::default());
        let (mut units, mut count) = (Vec::new(), 0);
        for frame in 0..65_u32 {
            let at = Duration::from_millis(33) * frame;
            for datagram in datagrams(&camera.next_unit(at).unwrap()) {
                count += 1;
                if !lose(count) {
                    units.extend(assembler.push(at, datagram).into_iter().flatten());
                }
            }
            units.extend(assembler.handle_timeout(at + Duration::from_millis(25)));
        }
        units
    }

    #[test]
    fn every_picture_is_decoded_and_the_bar_is_where_it_was_painted() {
        let mut decoder = Decoder::new().unwrap();
        let units = units(|_| false);
        let pictures: Vec<_> = units
            .iter()
            .filter_map(|unit| decoder.decode(unit))
            .collect();
        assert_eq!((units.len(), pictures.len(), decoder.errors()), (65, 65, 0));
        let last = &pictures[40];
        assert_eq!((last.width, last.height), (320, 240));
        let row = &last.rgb[120 * 320 * 3..121 * 320 * 3];
        let brightest = (0..320).max_by_key(|&column| row[column * 3]).unwrap();
        assert!(brightest.abs_diff(40 * 320 / 60) <= 6, "{brightest}");
    }

    #[test]
    fn losses_are_survived_until_the_next_key_frame() {
        let mut decoder = Decoder::new().unwrap();
        let units = units(|count| count % 41 == 7);
        let decoded = units
            .iter()
            .filter(|unit| decoder.decode(unit).is_some())
            .count();
        assert!(decoded > 0 && decoded < 65, "{decoded}");
    }

    #[test]
    fn impossible_sizes_are_refused() {
        assert!(Encoder::new(3, 2, 1000).is_err() && Encoder::new(0, 2, 1000).is_err());
        assert!(
            Encoder::new(64, 64, 100_000)
                .unwrap()
                .encode(&[0; 5])
                .is_err()
        );
    }
}
