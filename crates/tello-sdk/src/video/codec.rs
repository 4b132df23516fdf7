//! Decoding and encoding with OpenH264 (feature `video`; built from its bundled sources with a C++ compiler).
//!
//! A decoding error is not the end: the decoder then waits for the next key frame. Note on patents: the grant that comes
//! with the maker's own binary does not cover a build from source.

use super::assembler::AccessUnit;
use super::test_card::{CardReading, TestCard};
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

impl Picture {
    /// The test card in it, if it shows one.
    #[must_use]
    pub fn card(&self) -> Option<CardReading> {
        TestCard::read(self.width, |x, y| {
            self.rgb.get((y * self.width + x) * 3 + 1).copied()
        })
    }
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

fn library(error: openh264::Error) -> CodecError {
    CodecError::Library(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emulator::VideoSource;
    use crate::video::{
        Assembler, AssemblerConfig, Mosaic, MosaicEncoder, SQUARE, TestCard, datagrams,
    };

    fn units(lose: impl Fn(usize) -> bool) -> Vec<AccessUnit> {
        let mut camera = TestCard::new();
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
    fn every_card_is_decoded_and_read() {
        let mut decoder = Decoder::new().unwrap();
        let units = units(|_| false);
        let cards: Vec<_> = units
            .iter()
            .filter_map(|unit| decoder.decode(unit))
            .filter_map(|picture| picture.card())
            .collect();
        assert_eq!((units.len(), cards.len(), decoder.errors()), (65, 65, 0));
        for (frame, card) in (0..).zip(cards) {
            assert_eq!((card.frame, card.clock_ms), (frame, frame * 33));
        }
    }

    #[test]
    fn exact_multiples_are_decoded_too() {
        let mut camera = TestCard::new();
        let mut assembler = Assembler::new(AssemblerConfig::default());
        let mut decoder = Decoder::new().unwrap();
        let mut frames = Vec::new();
        for frame in 0..65_u32 {
            let at = Duration::from_millis(33) * frame;
            let mut unit = camera.next_unit(at).unwrap();
            if frame % 2 == 0 {
                crate::emulator::pad_to_multiple(&mut unit);
            }
            for datagram in datagrams(&unit) {
                let units = assembler.push(at, datagram).into_iter().flatten();
                let cards = units.filter_map(|unit| decoder.decode(&unit)?.card());
                frames.extend(cards.map(|card| card.frame));
            }
        }
        let end = assembler.handle_timeout(Duration::from_secs(5));
        frames.extend(
            end.and_then(|unit| decoder.decode(&unit)?.card())
                .map(|card| card.frame),
        );
        assert_eq!(frames, (0..65).collect::<Vec<u32>>());
    }

    /// The oracle for our own encoder: another's decoder gives back every plane to the byte.
    #[test]
    fn random_mosaics_are_decoded_exactly() {
        let mut random = crate::emulator::random::Random::new(5);
        let mut encoder = MosaicEncoder::new();
        let mut decoder = openh264::decoder::Decoder::new().unwrap();
        let mut picture = Mosaic::new(20, 15);
        for frame in 0..40 {
            let changes = [300, 0, 1, 40, 299][frame % 5];
            for _ in 0..changes {
                let (word, place) = (random.next(), random.next());
                let (column, row) = (place as usize % 20, (place >> 32) as usize % 15);
                // Mostly small steps, some as large as they get.
                let [a, b, c, big, ..] = word.to_le_bytes();
                let color = if big < 64 {
                    [a, b, c]
                } else {
                    [a % 4, b % 3, c % 40].map(|v| 100 + v)
                };
                picture.set(column, row, color);
            }
            let stream = encoder.encode(&picture, frame % 13 == 0);
            let decoded = decoder
                .decode(&stream)
                .unwrap()
                .expect("a picture comes at once");
            assert_eq!(decoded.dimensions(), (320, 240));
            let strides = decoded.strides();
            let planes = [
                (decoded.y(), strides.0, 1),
                (decoded.u(), strides.1, 2),
                (decoded.v(), strides.2, 2),
            ];
            for (plane, (bytes, stride, scale)) in planes.into_iter().enumerate() {
                for y in 0..240 / scale {
                    for x in 0..320 / scale {
                        let wanted =
                            picture.get(x * scale / SQUARE, y * scale / SQUARE).unwrap()[plane];
                        assert_eq!(
                            bytes[y * stride + x],
                            wanted,
                            "frame {frame} plane {plane} ({x}, {y})"
                        );
                    }
                }
            }
        }
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
    fn natural_pictures_come_back_nearly() {
        let (width, height) = (64, 48);
        let rgb: Vec<u8> = (0..width * height)
            .flat_map(|i| [(i % width * 4) as u8, (i / width * 5) as u8, 90])
            .collect();
        let data = Encoder::new(width, height, 1_000_000)
            .unwrap()
            .encode(&rgb)
            .unwrap();
        let unit = AccessUnit {
            data,
            at: Duration::ZERO,
            completed: Duration::ZERO,
            is_key: true,
            integrity: crate::video::Integrity::Intact,
            is_decodable: true,
        };
        let picture = Decoder::new().unwrap().decode(&unit).unwrap();
        assert_eq!((picture.width, picture.height), (width, height));
        let error: u32 = picture
            .rgb
            .iter()
            .zip(&rgb)
            .map(|(a, b)| u32::from(a.abs_diff(*b)))
            .sum();
        assert!((error as usize) < rgb.len() * 6, "{error}");
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
