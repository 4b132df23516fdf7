//! PNG and JPEG bytes to grey and depth images.

use std::io::Cursor;

use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::depth::{DepthError, DepthImage};
use crate::image::{GrayImage, ImageError};

/// Why bytes cannot be decoded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeError {
    /// Neither a PNG nor a JPEG signature.
    #[error("the file begins with {start:02x?}, which is neither PNG nor JPEG")]
    UnknownFormat {
        /// Its first bytes.
        start: Vec<u8>,
    },
    /// The PNG decoder's complaint.
    #[error("the PNG cannot be read")]
    Png(#[from] png::DecodingError),
    /// The JPEG decoder's complaint.
    #[error("the JPEG cannot be read: {0:?}")]
    Jpeg(zune_jpeg::errors::DecodeErrors),
    /// A depth image must be one 16-bit channel.
    #[error(
        "a depth image must be 16-bit grey PNG, this one has {bits} bits and {channels} channels"
    )]
    NotDepth {
        /// Bits of a sample.
        bits: u8,
        /// Samples of a pixel.
        channels: usize,
    },
    /// More pixels than anyone's camera has.
    #[error("{width} x {height} pixels are more than the {limit} that are accepted")]
    TooLarge {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Greatest accepted number of pixels.
        limit: usize,
    },
    /// Decoded pixels that are no image.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// Decoded values that are no depth image.
    #[error(transparent)]
    Depth(#[from] DepthError),
}

const MOST_PIXELS: usize = 1 << 26;

/// Decodes a PNG or JPEG, told apart by their first bytes, to grey (ITU-R 601 luma of colours).
///
/// # Errors
/// [`DecodeError`] for other formats and broken files.
pub fn decode_gray(bytes: &[u8]) -> Result<GrayImage, DecodeError> {
    if bytes.starts_with(&[0x89, b'P', b'N', b'G']) {
        png_gray(bytes)
    } else if bytes.starts_with(&[0xFF, 0xD8]) {
        jpeg_gray(bytes)
    } else {
        Err(DecodeError::UnknownFormat {
            start: bytes.iter().take(4).copied().collect(),
        })
    }
}

/// Decodes a 16-bit grey PNG of depth readings; 0 and 65535 mean none.
///
/// # Errors
/// [`DecodeError`] for broken files and other kinds of PNG.
pub fn decode_depth(bytes: &[u8], units_per_metre: f32) -> Result<DepthImage, DecodeError> {
    let picture = Picture::decode(bytes, png::Transformations::IDENTITY)?;
    if picture.bits != 16 || picture.channels != 1 {
        return Err(DecodeError::NotDepth {
            bits: picture.bits,
            channels: picture.channels,
        });
    }
    let pairs = picture.data.chunks_exact(2);
    let readings: Vec<u16> = pairs
        .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
        .collect();
    Ok(DepthImage::from_u16(
        &readings,
        picture.width,
        picture.height,
        units_per_metre,
    )?)
}

struct Picture {
    data: Vec<u8>,
    width: usize,
    height: usize,
    bits: u8,
    channels: usize,
}

impl Picture {
    fn decode(bytes: &[u8], transformations: png::Transformations) -> Result<Self, DecodeError> {
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(transformations);
        let mut reader = decoder.read_info()?;
        let (width, height) = (reader.info().width as usize, reader.info().height as usize);
        let size = reader
            .output_buffer_size()
            .filter(|_| width.saturating_mul(height) <= MOST_PIXELS);
        let too_large = DecodeError::TooLarge {
            width,
            height,
            limit: MOST_PIXELS,
        };
        let mut data = vec![0; size.ok_or(too_large)?];
        let frame = reader.next_frame(&mut data)?;
        data.truncate(frame.buffer_size());
        let (bits, channels) = (frame.bit_depth as u8, frame.color_type.samples());
        Ok(Self {
            data,
            width,
            height,
            bits,
            channels,
        })
    }
}

fn png_gray(bytes: &[u8]) -> Result<GrayImage, DecodeError> {
    let wanted = png::Transformations::normalize_to_color8();
    let Picture {
        data,
        width,
        height,
        channels,
        ..
    } = Picture::decode(bytes, wanted)?;
    Ok(match channels {
        1 => GrayImage::new(data, width, height)?,
        2 => GrayImage::new(data.chunks_exact(2).map(|p| p[0]).collect(), width, height)?,
        3 => GrayImage::from_rgb(&data, width, height)?,
        _ => {
            let rgb: Vec<u8> = data
                .chunks_exact(4)
                .flat_map(|p| [p[0], p[1], p[2]])
                .collect();
            GrayImage::from_rgb(&rgb, width, height)?
        }
    })
}

fn jpeg_gray(bytes: &[u8]) -> Result<GrayImage, DecodeError> {
    let options = DecoderOptions::default()
        .set_max_width(1 << 14)
        .set_max_height(1 << 14)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    let data = decoder.decode().map_err(DecodeError::Jpeg)?;
    let (width, height) = decoder.dimensions().unwrap_or((0, 0));
    if data.len() == width * height {
        return Ok(GrayImage::new(data, width, height)?);
    }
    Ok(GrayImage::from_rgb(&data, width, height)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn encode(data: &[u8], color: png::ColorType, depth: png::BitDepth) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
        encoder.set_color(color);
        encoder.set_depth(depth);
        encoder
            .write_header()
            .unwrap()
            .write_image_data(data)
            .unwrap();
        bytes
    }

    #[test]
    fn grey_colour_and_depth_are_told_apart() {
        use png::{BitDepth, ColorType};
        let grey = encode(&[1, 2, 3, 4], ColorType::Grayscale, BitDepth::Eight);
        assert_eq!(decode_gray(&grey).unwrap().pixels(), [1, 2, 3, 4]);
        let rgba = encode(&[9; 16], ColorType::Rgba, BitDepth::Eight);
        assert_eq!(decode_gray(&rgba).unwrap().pixels(), [9; 4]);
        let depth = encode(
            &[3, 232, 0, 0, 255, 255, 7, 208],
            ColorType::Grayscale,
            BitDepth::Sixteen,
        );
        assert_eq!(
            decode_depth(&depth, 1000.0).unwrap().values(),
            [1.0, 0.0, 0.0, 2.0]
        );
        assert!(matches!(
            decode_depth(&grey, 1000.0),
            Err(DecodeError::NotDepth { bits: 8, .. })
        ));
        assert!(matches!(
            decode_gray(b"GIF8"),
            Err(DecodeError::UnknownFormat { .. })
        ));
        assert!(decode_gray(&[]).is_err());
    }

    proptest! {
        #[test]
        fn damaged_files_are_errors_not_panics(
            at in 0usize..80, value in any::<u8>(), cut in 0usize..90,
        ) {
            let mut bytes = encode(&[1, 2, 3, 4], png::ColorType::Grayscale, png::BitDepth::Eight);
            let at = at % bytes.len();
            bytes[at] = value;
            bytes.truncate(cut);
            let _ = decode_gray(&bytes);
            let _ = decode_depth(&bytes, 1000.0);
            let mut jpeg = vec![0xFF, 0xD8, 0xFF];
            jpeg.extend(&bytes);
            prop_assert!(decode_gray(&jpeg).is_err());
        }
    }
}
