//! Encodes mosaics, pictures of single-coloured squares of 16 x 16 pixels, as real H.264 without any library.
//!
//! Method: ITU-T H.264 Constrained Baseline. Each macroblock is predicted from its left or upper neighbour and carries
//! one DC coefficient per colour plane (Intra_16x16, CAVLC, 9.2). At QP 28 for luma, and 22 for chroma, one step of a
//! DC coefficient is one step of the pixel value, so the decoded picture is exact; the deblocking filter is off.
//! Macroblocks that have not changed are skipped (P_Skip). Cost: a few dozen bits a changed macroblock; a picture of
//! 960 x 720 has about 8 kB when everything changes, close to the drone's.
//!
//! It is what emulated drones send where no encoder for natural pictures is built in.

use super::bits::BitWriter;
use alloc::vec::Vec;

/// Pixels along the side of a square.
pub const SQUARE: usize = 16;

/// Squares along a side at most: 4096 pixels.
const LONGEST: usize = 256;

/// A picture of single-coloured squares.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mosaic {
    columns: usize,
    rows: usize,
    squares: Vec<[u8; 3]>,
}

impl Mosaic {
    /// A black picture of 1 to 256 squares by 1 to 256 squares; other numbers are brought into that range.
    #[must_use]
    pub fn new(columns: usize, rows: usize) -> Self {
        let (columns, rows) = (columns.clamp(1, LONGEST), rows.clamp(1, LONGEST));
        let squares = alloc::vec![[16, 128, 128]; columns * rows];
        Self {
            columns,
            rows,
            squares,
        }
    }

    /// Squares in a row.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Rows of squares.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Paints a square: luma, blue and red difference (BT.601, 16 to 235 and 16 to 240). Outside nothing happens.
    pub fn set(&mut self, column: usize, row: usize, color: [u8; 3]) {
        if column < self.columns
            && let Some(square) = self.squares.get_mut(row * self.columns + column)
        {
            *square = color;
        }
    }

    /// The colour of a square, if it is inside.
    #[must_use]
    pub fn get(&self, column: usize, row: usize) -> Option<[u8; 3]> {
        (column < self.columns).then(|| self.squares.get(row * self.columns + column).copied())?
    }
}

/// Encodes mosaics of one size.
#[derive(Debug, Clone)]
pub struct MosaicEncoder {
    last: Option<Mosaic>,
    frame_number: u32,
    idr: u32,
}

impl Default for MosaicEncoder {
    fn default() -> Self {
        Self::new()
    }
}

impl MosaicEncoder {
    /// An encoder whose first picture is a key frame.
    #[must_use]
    pub fn new() -> Self {
        Self {
            last: None,
            frame_number: 0,
            idr: 0,
        }
    }

    /// One access unit in Annex B byte-stream format. A key frame, with its parameter sets, if asked for, at the
    /// beginning, and when the size changes.
    pub fn encode(&mut self, picture: &Mosaic, key: bool) -> Vec<u8> {
        let same = |last: &Mosaic| (last.columns, last.rows) == (picture.columns, picture.rows);
        let last = self.last.take().filter(|last| !key && same(last));
        let mut stream = Vec::new();
        let mut writer = BitWriter::default();
        if last.is_none() {
            self.frame_number = 0;
            self.idr ^= 1;
            sequence_parameters(&mut writer, picture);
            writer.finish(0x67, &mut stream);
            picture_parameters(&mut writer);
            writer.finish(0x68, &mut stream);
        }
        self.slice_header(&mut writer, last.is_none());
        slice_data(&mut writer, picture, last.as_ref());
        writer.finish(if last.is_none() { 0x65 } else { 0x61 }, &mut stream);
        self.frame_number = (self.frame_number + 1) % 16;
        self.last = Some(picture.clone());
        stream
    }

    /// 7.3.3.
    fn slice_header(&self, writer: &mut BitWriter, key: bool) {
        writer.unsigned(0); // first_mb_in_slice
        writer.unsigned(if key { 7 } else { 5 }); // slice_type: all I, all P
        writer.unsigned(0); // pic_parameter_set_id
        writer.bits(self.frame_number, 4);
        if key {
            writer.unsigned(self.idr); // idr_pic_id: differs from that of the key frame before
            writer.bits(0, 2); // no_output_of_prior_pics_flag, long_term_reference_flag
        } else {
            writer.bits(0, 2); // num_ref_idx_active_override_flag, ref_pic_list_modification_flag_l0
            writer.bits(0, 1); // adaptive_ref_pic_marking_mode_flag
        }
        writer.signed(0); // slice_qp_delta
        writer.unsigned(1); // disable_deblocking_filter_idc
    }
}

/// 7.3.2.1: Constrained Baseline, level 4.0, no reordering of pictures, 30 pictures a second.
fn sequence_parameters(writer: &mut BitWriter, picture: &Mosaic) {
    writer.bits(66, 8); // profile_idc
    writer.bits(0b1100_0000, 8); // constraint_set0_flag, constraint_set1_flag
    writer.bits(40, 8); // level_idc
    writer.unsigned(0); // seq_parameter_set_id
    writer.unsigned(0); // log2_max_frame_num_minus4
    writer.unsigned(2); // pic_order_cnt_type: output order is decoding order
    writer.unsigned(1); // max_num_ref_frames
    writer.bits(0, 1); // gaps_in_frame_num_value_allowed_flag
    writer.unsigned(picture.columns as u32 - 1);
    writer.unsigned(picture.rows as u32 - 1);
    writer.bits(0b110, 3); // frame_mbs_only_flag, direct_8x8_inference_flag, frame_cropping_flag
    writer.bits(1, 1); // vui_parameters_present_flag
    writer.bits(0b0000, 4); // aspect ratio, overscan, video signal type, chroma location
    writer.bits(1, 1); // timing_info_present_flag
    writer.bits(1, 32); // num_units_in_tick
    writer.bits(60, 32); // time_scale: two fields a picture
    writer.bits(0b1000, 4); // fixed_frame_rate_flag; no HRD parameters, no picture structure
    writer.bits(0b11, 2); // bitstream_restriction_flag, motion_vectors_over_pic_boundaries_flag
    // max_bytes_per_pic_denom, max_bits_per_mb_denom, longest motion vectors, max_num_reorder_frames, max_dec_frame_buffering
    for value in [0, 0, 10, 10, 0, 1] {
        writer.unsigned(value);
    }
}

/// 7.3.2.2.
fn picture_parameters(writer: &mut BitWriter) {
    writer.unsigned(0); // pic_parameter_set_id
    writer.unsigned(0); // seq_parameter_set_id
    writer.bits(0b00, 2); // CAVLC, no field order
    writer.unsigned(0); // num_slice_groups_minus1
    writer.unsigned(0); // num_ref_idx_l0_default_active_minus1
    writer.unsigned(0); // num_ref_idx_l1_default_active_minus1
    writer.bits(0b000, 3); // no weighted prediction
    writer.signed(28 - 26); // pic_init_qp_minus26
    writer.signed(0); // pic_init_qs_minus26
    writer.signed(22 - 28); // chroma_qp_index_offset
    writer.bits(0b100, 3); // deblocking_filter_control_present_flag; intra prediction and slices unrestricted
}

/// 7.3.4 for CAVLC.
fn slice_data(writer: &mut BitWriter, picture: &Mosaic, last: Option<&Mosaic>) {
    let mut skipped = 0;
    for (index, square) in picture.squares.iter().enumerate() {
        if let Some(last) = last {
            if last.squares.get(index) == Some(square) {
                skipped += 1;
                continue;
            }
            writer.unsigned(skipped);
            skipped = 0;
        }
        macroblock(writer, picture, index, *square, last.is_some());
    }
    if skipped > 0 {
        writer.unsigned(skipped);
    }
}

/// 7.3.5: Intra_16x16, predicted from the left neighbour, from the upper one in the first column, from 128 at the origin.
fn macroblock(writer: &mut BitWriter, picture: &Mosaic, index: usize, square: [u8; 3], is_p: bool) {
    let (luma_mode, chroma_mode, from) = if !index.is_multiple_of(picture.columns) {
        (1, 1, picture.squares.get(index - 1)) // horizontal
    } else if index > 0 {
        (0, 2, picture.squares.get(index - picture.columns)) // vertical
    } else {
        (2, 0, None) // DC without neighbours
    };
    let from = from.copied().unwrap_or([128; 3]);
    let [luma, blue, red] =
        [0, 1, 2].map(|plane| i32::from(square[plane]) - i32::from(from[plane]));
    let has_chroma = u32::from(blue != 0 || red != 0);
    // Table 7-11: prediction mode, then 4 times the chroma pattern (1: DC only), no luma AC; table 7-13: plus 5 in P slices.
    writer.unsigned(1 + luma_mode + 4 * has_chroma + if is_p { 5 } else { 0 });
    writer.unsigned(chroma_mode);
    writer.signed(0); // mb_qp_delta
    luma_dc(writer, luma);
    if has_chroma == 1 {
        chroma_dc(writer, blue);
        chroma_dc(writer, red);
    }
}

/// 9.2 with nC = 0 (no neighbour has AC coefficients): one coefficient or none.
fn luma_dc(writer: &mut BitWriter, level: i32) {
    match level {
        0 => writer.bits(0b1, 1),
        -1 | 1 => writer.bits(0b01, 2),
        _ => writer.bits(0b00_0101, 6),
    }
    coefficient(writer, level);
}

/// 9.2 with nC = -1.
fn chroma_dc(writer: &mut BitWriter, level: i32) {
    match level {
        0 => writer.bits(0b01, 2),
        -1 | 1 => writer.bits(0b1, 1),
        _ => writer.bits(0b00_0111, 6),
    }
    coefficient(writer, level);
}

/// The sign of a trailing one or the level (9.2.2.1, suffixLength 0), then total_zeros 0.
fn coefficient(writer: &mut BitWriter, level: i32) {
    let negative = u32::from(level < 0);
    match level.unsigned_abs() {
        0 => return,
        1 => writer.bits(negative, 1),
        magnitude => {
            let code = 2 * magnitude - 4 + negative;
            match code {
                0..14 => writer.bits(1, code + 1),
                14..30 => {
                    writer.bits(1, 15);
                    writer.bits(code - 14, 4);
                }
                _ => {
                    writer.bits(1, 16);
                    writer.bits(code - 30, 12);
                }
            }
        }
    }
    writer.bits(1, 1);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::video::{NalKind, nal_units};

    #[test]
    fn key_frames_carry_parameter_sets_and_unchanged_pictures_cost_next_to_nothing() {
        let mut encoder = MosaicEncoder::new();
        let mut picture = Mosaic::new(60, 45);
        let kinds = |stream: &[u8]| -> Vec<_> {
            nal_units(stream)
                .map(|unit| NalKind::from_header(unit[0]).unwrap())
                .collect()
        };
        let first = encoder.encode(&picture, false);
        assert_eq!(
            kinds(&first),
            [NalKind::Sps, NalKind::Pps, NalKind::IdrSlice]
        );
        let same = encoder.encode(&picture, false);
        assert_eq!(kinds(&same), [NalKind::Slice]);
        assert!(same.len() < 20, "{}", same.len());
        picture.set(59, 44, [235, 128, 128]);
        assert!(encoder.encode(&picture, false).len() < 25);
        assert_eq!(kinds(&encoder.encode(&picture, true)).len(), 3);
        assert_eq!(kinds(&encoder.encode(&Mosaic::new(2, 2), false)).len(), 3);
    }

    #[test]
    fn sizes_and_places_out_of_range_do_nothing() {
        let mut picture = Mosaic::new(0, 100_000);
        assert_eq!((picture.columns(), picture.rows()), (1, 256));
        picture.set(1, 0, [1; 3]);
        picture.set(0, 256, [1; 3]);
        assert_eq!(
            (picture.get(0, 0), picture.get(1, 0), picture.get(0, 256)),
            (Some([16, 128, 128]), None, None)
        );
    }
}
