//! Writes the bits of a NAL unit: fixed-length and exp-Golomb codes (ITU-T H.264, 7.2 and 9.1), with emulation
//! prevention (7.4.1).

use alloc::vec::Vec;

/// Collects the bits of one NAL unit's payload.
#[derive(Debug, Clone, Default)]
pub(super) struct BitWriter {
    bytes: Vec<u8>,
    open: u64,
    count: u32,
}

impl BitWriter {
    /// The lowest `count` bits of `value`, at most 32, highest first.
    pub(super) fn bits(&mut self, value: u32, count: u32) {
        let mask = (1_u64 << count) - 1;
        self.open = self.open << count | u64::from(value) & mask;
        self.count += count;
        while self.count >= 8 {
            self.count -= 8;
            self.bytes.push((self.open >> self.count) as u8);
        }
    }

    /// ue(v): an unsigned exp-Golomb code.
    pub(super) fn unsigned(&mut self, value: u32) {
        let code = value.saturating_add(1);
        let length = 32 - code.leading_zeros();
        self.bits(0, length - 1);
        self.bits(code, length);
    }

    /// se(v): a signed exp-Golomb code.
    pub(super) fn signed(&mut self, value: i32) {
        let magnitude = value.unsigned_abs() << 1;
        self.unsigned(if value > 0 { magnitude - 1 } else { magnitude });
    }

    /// Appends start code, header and payload to a byte stream, and begins anew.
    pub(super) fn finish(&mut self, header: u8, stream: &mut Vec<u8>) {
        // Stop bit, then zeros up to the next byte.
        self.bits(1, 1);
        self.bits(0, (8 - self.count) % 8);
        stream.extend_from_slice(&[0, 0, 0, 1, header]);
        let mut zeros = 0;
        for byte in self.bytes.drain(..) {
            if zeros == 2 && byte <= 3 {
                stream.push(3);
                zeros = 0;
            }
            zeros = if byte == 0 { zeros + 1 } else { 0 };
            stream.push(byte);
        }
        (self.open, self.count) = (0, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_of_the_standards_tables() {
        // Table 9-2: 0 is 1, 1 is 010, 4 is 00101; 9.1.1: 1 is 010, -1 is 011, 2 is 00100.
        let mut writer = BitWriter::default();
        for value in [0, 1, 4] {
            writer.unsigned(value);
        }
        for value in [1, -1, 2] {
            writer.signed(value);
        }
        let mut stream = Vec::new();
        writer.finish(0x67, &mut stream);
        assert_eq!(
            stream,
            [0, 0, 0, 1, 0x67, 0b1010_0010, 0b1010_0110, 0b0100_1000]
        );
    }

    #[test]
    fn no_start_code_inside() {
        let mut writer = BitWriter::default();
        for byte in [0, 0, 0, 0, 1, 0, 0, 3] {
            writer.bits(byte, 8);
        }
        let mut stream = Vec::new();
        writer.finish(0x65, &mut stream);
        assert_eq!(stream[5..], [0, 0, 3, 0, 0, 3, 1, 0, 0, 3, 3, 0x80]);
    }
}
