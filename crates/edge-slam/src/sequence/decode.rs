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

/// An 8K frame (7680 x 4320) fits. What a header alone can ask for follows: 128 MiB as 8-bit RGBA, 64 MiB as depth.
const MOST_PIXELS: usize = 1 << 25;

/// Decodes a PNG or JPEG, told apart by their first bytes, to grey (ITU-R 601 luma of colours).
///
/// # Errors
/// [`DecodeError`] for other formats and broken files; for more than 2^25 pixels before any of them is decoded.
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
/// [`DecodeError`] for broken files, other kinds of PNG and more than 2^25 pixels; the latter two before any is decoded.
pub fn decode_depth(bytes: &[u8], units_per_metre: f32) -> Result<DepthImage, DecodeError> {
    let reader = open_png(bytes, png::Transformations::IDENTITY)?;
    let (color, depth) = (reader.info().color_type, reader.info().bit_depth);
    if (color, depth) != (png::ColorType::Grayscale, png::BitDepth::Sixteen) {
        return Err(DecodeError::NotDepth {
            bits: depth as u8,
            channels: color.samples(),
        });
    }
    let picture = Picture::read(reader)?;
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

fn check_size(width: usize, height: usize) -> Result<(), DecodeError> {
    if width.saturating_mul(height) <= MOST_PIXELS {
        return Ok(());
    }
    Err(DecodeError::TooLarge {
        width,
        height,
        limit: MOST_PIXELS,
    })
}

type PngReader<'a> = png::Reader<Cursor<&'a [u8]>>;

/// Reads what precedes the pixels, and refuses too many of them.
fn open_png(
    bytes: &[u8],
    transformations: png::Transformations,
) -> Result<PngReader<'_>, DecodeError> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(transformations);
    let reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    check_size(width as usize, height as usize)?;
    Ok(reader)
}

struct Picture {
    data: Vec<u8>,
    width: usize,
    height: usize,
    channels: usize,
}

impl Picture {
    fn read(mut reader: PngReader<'_>) -> Result<Self, DecodeError> {
        let (width, height) = reader.info().size();
        let (width, height) = (width as usize, height as usize);
        let size = reader.output_buffer_size().ok_or(DecodeError::TooLarge {
            width,
            height,
            limit: MOST_PIXELS,
        })?;
        let mut data = vec![0; size];
        let frame = reader.next_frame(&mut data)?;
        data.truncate(frame.buffer_size());
        Ok(Self {
            data,
            width,
            height,
            channels: frame.color_type.samples(),
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
    } = Picture::read(open_png(bytes, wanted)?)?;
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
    decoder.decode_headers().map_err(DecodeError::Jpeg)?;
    let (width, height) = decoder.dimensions().unwrap_or((0, 0));
    check_size(width, height)?;
    let data = decoder.decode().map_err(DecodeError::Jpeg)?;
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

    /// The checksum of PNG chunks (ISO 3309).
    fn crc(bytes: &[u8]) -> u32 {
        let bit = |crc: u32, _| (crc >> 1) ^ (0xEDB8_8320 * (crc & 1));
        let byte = |crc, byte: &u8| (0..8).fold(crc ^ u32::from(*byte), bit);
        !bytes.iter().fold(!0, byte)
    }

    /// A PNG whose header tells this and whose pixels are missing; colours: 0 grey, 6 RGBA.
    fn png_header(width: u32, height: u32, bits: u8, color: u8) -> Vec<u8> {
        let mut header = b"IHDR".to_vec();
        header.extend(width.to_be_bytes());
        header.extend(height.to_be_bytes());
        header.extend([bits, color, 0, 0, 0]);
        let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
        for chunk in [&header[..], b"IDAT", b"IEND"] {
            bytes.extend((chunk.len() as u32 - 4).to_be_bytes());
            bytes.extend(chunk);
            bytes.extend(crc(chunk).to_be_bytes());
        }
        bytes
    }

    /// A grey JPEG with the data of one block that is 128 everywhere.
    fn jpeg(width: u16, height: u16) -> Vec<u8> {
        let mut bytes = vec![0xFF, 0xD8, 0xFF, 0xDB, 0, 67, 0];
        bytes.extend([1; 64]);
        bytes.extend([0xFF, 0xC0, 0, 11, 8]);
        bytes.extend(height.to_be_bytes());
        bytes.extend(width.to_be_bytes());
        bytes.extend([1, 1, 0x11, 0]);
        // Of each kind of Huffman table the code 0: no difference, and end of block.
        for kind in [0x00, 0x10] {
            bytes.extend([0xFF, 0xC4, 0, 20, kind, 1]);
            bytes.extend([0; 16]);
        }
        bytes.extend([0xFF, 0xDA, 0, 8, 1, 1, 0, 0, 63, 0, 0x3F, 0xFF, 0xD9]);
        bytes
    }

    #[test]
    fn the_smallest_pictures_are_decoded() {
        let grey = decode_gray(&jpeg(1, 1)).unwrap();
        assert_eq!((grey.width(), grey.pixels()), (1, &[128][..]));
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_depth(png::BitDepth::Sixteen);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[7, 208]).unwrap();
        drop(writer);
        assert_eq!(decode_gray(&bytes).unwrap().pixels(), [7]);
        assert_eq!(decode_depth(&bytes, 1000.0).unwrap().values(), [2.0]);
    }

    #[test]
    fn a_header_alone_reserves_no_more_than_a_picture_needs() {
        let refused = |error: DecodeError, pixels: usize| match error {
            DecodeError::TooLarge {
                width,
                height,
                limit,
            } => {
                assert_eq!((width * height, limit), (pixels, MOST_PIXELS));
            }
            other => panic!("{pixels}: {other:?}"),
        };
        for (width, height) in [(1 << 13, (1 << 12) + 1), (1 << 20, 1 << 20), (1 << 31, 1)] {
            for (bits, color) in [(8, 0), (16, 0), (16, 6)] {
                let bytes = png_header(width, height, bits, color);
                match decode_gray(&bytes).unwrap_err() {
                    // The decoder's own limit comes first.
                    DecodeError::Png(_) if width == 1 << 31 => {}
                    error => refused(error, width as usize * height as usize),
                }
            }
        }
        let error = decode_gray(&jpeg(1 << 14, 1 << 14)).unwrap_err();
        refused(error, 1 << 28);
        // As many as are accepted, but none there; and four channels are no depth, however many.
        let error = decode_depth(&png_header(1 << 13, 1 << 12, 16, 0), 1000.0).unwrap_err();
        assert!(matches!(error, DecodeError::Png(_)), "{error:?}");
        let error = decode_depth(&png_header(1 << 13, 1 << 12, 16, 6), 1000.0).unwrap_err();
        assert!(
            matches!(error, DecodeError::NotDepth { channels: 4, .. }),
            "{error:?}"
        );
    }

    #[test]
    fn pictures_without_pixels_are_refused() {
        for (width, height) in [(0, 0), (0, 5), (5, 0)] {
            let png = png_header(width, height, 16, 0);
            assert!(decode_gray(&png).is_err());
            assert!(decode_depth(&png, 1000.0).is_err());
            assert!(decode_gray(&jpeg(width as u16, height as u16)).is_err());
        }
    }

    #[test]
    fn a_picture_that_breaks_off_is_an_error_or_a_picture_of_its_size() {
        let png = encode(
            &[1, 2, 3, 4, 5, 6, 7, 8],
            png::ColorType::Grayscale,
            png::BitDepth::Sixteen,
        );
        // What follows the pixels may be missing: the last chunk, 12 bytes, and the checksums before it.
        for length in 0..png.len() - 20 {
            assert!(decode_gray(&png[..length]).is_err(), "{length}");
            assert!(decode_depth(&png[..length], 1000.0).is_err(), "{length}");
        }
        // The decoder fills what is missing of a JPEG, as viewers do, once the header is whole.
        let jpeg = jpeg(9, 3);
        for length in 0..jpeg.len() {
            if let Ok(image) = decode_gray(&jpeg[..length]) {
                assert_eq!((image.width(), image.height()), (9, 3), "{length}");
            }
        }
        assert!(decode_gray(&jpeg[..100]).is_err());
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
