//! The number types of a PLY file, and their values as `f64`.

/// A PLY number type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// Byte order of a binary file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Endian {
    Little,
    Big,
}

impl Scalar {
    /// The type with this name, old ("float") or new ("float32").
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number in the first `size()` bytes; bytes that are missing count as zero.
    pub(super) fn decode(self, bytes: &[u8], endian: Endian) -> f64 {
        let mut raw = [0_u8; 8];
        let size = self.size();
        for (to, from) in raw.iter_mut().zip(bytes.iter().take(size)) {
            *to = *from;
        }
        if endian == Endian::Big {
            raw[..size].reverse();
        }
        let [a, b, c, d, ..] = raw;
        match self {
            Self::I8 => f64::from(i8::from_le_bytes([a])),
            Self::U8 => f64::from(a),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::F64 => f64::from_le_bytes(raw),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_give_the_same_number() {
        assert_eq!(Scalar::F32.decode(&1.5_f32.to_be_bytes(), Endian::Big), 1.5);
        assert_eq!(
            Scalar::F64.decode(&(-2.25_f64).to_le_bytes(), Endian::Little),
            -2.25
        );
        assert_eq!(
            Scalar::I16.decode(&(-7_i16).to_be_bytes(), Endian::Big),
            -7.0
        );
        assert_eq!(
            Scalar::U32.decode(&u32::MAX.to_be_bytes(), Endian::Big),
            4_294_967_295.0
        );
        assert_eq!(Scalar::I8.decode(&[0xff], Endian::Little), -1.0);
    }
}
