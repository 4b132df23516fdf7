//! The two checksums of a frame: CRC-8 (polynomial 0x31 reflected, start 0x77) over the first three bytes, CRC-16
//! (polynomial 0x1021 reflected, start 0x3692) over everything before it.

/// The header's checksum.
#[must_use]
pub fn crc8(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0x77, |crc, &byte| {
        (0..8).fold(crc ^ byte, |c, _| {
            if c & 1 == 1 { (c >> 1) ^ 0x8C } else { c >> 1 }
        })
    })
}

/// The frame's checksum.
#[must_use]
pub fn crc16(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0x3692, |crc, &byte| {
        (0..8).fold(crc ^ u16::from(byte), |c, _| {
            if c & 1 == 1 {
                (c >> 1) ^ 0x8408
            } else {
                c >> 1
            }
        })
    })
}
